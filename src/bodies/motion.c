#include "bodies/motion.h"

PetscErrorCode InstantCopy(Instant from, Instant *copy) {
  PetscFunctionBeginUser;
  copy->t = from.t;
  copy->end = from.end;
  if (!from.place) PetscCall(VecDestroy(&copy->place));
  if (from.place && !copy->place) PetscCall(VecDuplicate(from.place, &copy->place));
  if (from.place) PetscCall(VecCopy(from.place, copy->place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

BodyPose MotionPose(const BodyMotion *m, Instant at) {
  const PetscInt first = 3 * (m->free - 1), all[] = {first, first + 1, first + 2};
  PetscReal y[3];
  const PetscReal t = at.t, s = m->frequency > 0 ? PetscSinReal(m->frequency * t) / m->frequency : t;
  if (m->free && at.place) {
    (void)VecGetValues(at.place, 3, all, y);
    return (BodyPose){{y[0], y[1]}, y[2]};
  }
  if (!m->carried) return (BodyPose){{m->center[0], m->center[1]}, 0};
  return (BodyPose){{m->center[0] + m->velocity[0] * s, m->center[1] + m->velocity[1] * s}, m->rotation * s};
}

void MotionCarry(const BodyMotion *m, Instant at, PetscInt n, const PetscReal rest[], PetscReal X[]) {
  const BodyPose p = MotionPose(m, at);
  const PetscReal c = m->turned ? PetscCosReal(p.angle) : 1, s = m->turned ? PetscSinReal(p.angle) : 0;
  for (PetscInt k = 0; k < 2 * n; k += 2) {
    const PetscReal x = rest[k] - m->center[0], y = rest[k + 1] - m->center[1];
    X[k] = m->carried ? p.center[0] + c * x - s * y : rest[k];
    X[k + 1] = m->carried ? p.center[1] + s * x + c * y : rest[k + 1];
  }
}

void MotionVelocity(const BodyMotion *m, Instant at, const PetscReal X[2], PetscReal U[2]) {
  const BodyPose p = MotionPose(m, at);
  const PetscReal swing = PetscCosReal(m->frequency * at.t);
  U[0] = swing * (m->velocity[0] - m->rotation * (X[1] - p.center[1]));
  U[1] = swing * (m->velocity[1] + m->rotation * (X[0] - p.center[0]));
}

void MotionTurn(const BodyMotion *m, Instant from, Instant to, PetscInt n, PetscReal F[]) {
  const PetscReal angle = MotionPose(m, to).angle - MotionPose(m, from).angle;
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle);
  for (PetscInt k = 0; k < 2 * n && m->turned; k += 2) {
    const PetscReal x = F[k], y = F[k + 1];
    F[k] = c * x - s * y;
    F[k + 1] = s * x + c * y;
  }
}

PetscReal MotionStride(const BodyMotion *m, Instant from, Instant to, PetscReal reach) {
  const BodyPose a = MotionPose(m, from), b = MotionPose(m, to);
  const PetscReal way = PetscHypotReal(b.center[0] - a.center[0], b.center[1] - a.center[1]);
  return way + (m->turned ? PetscAbsReal(b.angle - a.angle) * reach : 0);
}

void MotionSum(const PetscReal center[2], PetscInt n, const PetscReal X[], const PetscReal F[], PetscReal sum[3]) {
  for (PetscInt k = 0; k < 2 * n; k += 2) {
    sum[0] += F[k];
    sum[1] += F[k + 1];
    sum[2] += (X[k] - center[0]) * F[k + 1] - (X[k + 1] - center[1]) * F[k];
  }
}
