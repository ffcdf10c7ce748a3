#include "output/spacerecord.h"
#include "sphere/shape.h"

typedef enum { KIND_RUN, KIND_TOTAL, KIND_WORST, KIND_MEAN, KIND_FIRST, KIND_LEAST, KIND_LARGEST } SpaceColumnKind;

#define SPACE_NAME(id, name, kind) name,
#define SPACE_KIND(id, name, kind) KIND_##kind,
const char *const SpaceColumns[SPACE_COUNT] = {SPACE_COLUMNS(SPACE_NAME)};
static const SpaceColumnKind kinds[SPACE_COUNT] = {SPACE_COLUMNS(SPACE_KIND)};

#define ENTRY 32 /* characters of a name or a number, at most */

/* Columns of single vesicles behind those of all. */
static PetscInt SpaceRecordOwn(const SpaceRecord *r) {
  return r->space->share.vesicles > 1 && r->space->share.vesicles <= SPACE_FEW ? r->space->share.vesicles : 0;
}

PetscErrorCode SpaceRecordCreate(Space s, SpaceRecord *r) {
  size_t used = 0;
  PetscFunctionBeginUser;
  *r = (SpaceRecord){.space = s};
  r->room = (size_t)(SPACE_COUNT * ENTRY * (1 + SpaceRecordOwn(r)));
  PetscCall(PetscCalloc1(s->share.vesicles * SPACE_COUNT, &r->each));
  PetscCall(PetscCalloc2(r->room, &r->header, r->room, &r->text));
  for (PetscInt v = 0; v <= SpaceRecordOwn(r); v++)
    for (int c = 0; c < SPACE_COUNT; c++) {
      char suffix[16] = "";
      if (v && kinds[c] == KIND_RUN) continue;
      if (v) (void)snprintf(suffix, sizeof(suffix), "_%d", (int)v);
      used += (size_t)snprintf(r->header + used, r->room - used, "%s%s%s", used ? "," : "", SpaceColumns[c], suffix);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceRecordDestroy(SpaceRecord *r) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(r->each));
  PetscCall(PetscFree2(r->header, r->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Velocity of the middle, rate of rotation about it in the x-y plane, largest normal speed, range of the tension. */
static PetscErrorCode SpaceRecordMotion(Surface at, const ShapeMoments *m, const PetscReal U[], const PetscReal sigma[],
                                        PetscReal row[]) {
  const PetscInt n = at->n, count = at->sphere->count;
  PetscReal *u, *tension, turned = 0, inertia = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * n, &u, n, &tension));
  PetscCall(SphereTableValues(&at->sphere->fine, HARMONIC, count, 3, U, u));
  PetscCall(SphereTableValues(&at->sphere->fine, HARMONIC, count, 1, sigma, tension));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal dA = at->sphere->fine.grid.weight[i] * at->J[i];
    PetscReal r[3], normal = 0;
    for (int d = 0; d < 3; d++) {
      r[d] = at->D[HARMONIC][d * n + i] - m->center[d];
      normal += u[d * n + i] * at->normal[d * n + i];
    }
    for (int d = 0; d < 3; d++) row[SPACE_VELOCITY_X + d] += dA * normal * r[d] / at->volume;
    turned += dA * (r[0] * u[n + i] - r[1] * u[i]);
    inertia += dA * (r[0] * r[0] + r[1] * r[1]);
    row[SPACE_NORMAL_SPEED] = PetscMax(row[SPACE_NORMAL_SPEED], PetscAbsReal(normal));
    row[SPACE_TENSION_MIN] = i ? PetscMin(row[SPACE_TENSION_MIN], tension[i]) : tension[i];
    row[SPACE_TENSION_MAX] = i ? PetscMax(row[SPACE_TENSION_MAX], tension[i]) : tension[i];
  }
  row[SPACE_ROTATION] = turned / inertia;
  PetscCall(PetscFree2(u, tension));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The own columns of an own vesicle. */
static PetscErrorCode SpaceRecordVesicle(Space s, PetscInt v, PetscReal row[]) {
  const Vesicle3 vesicle = s->vesicle[v];
  const Surface at = vesicle->about;
  const PetscReal *X = s->state.X + v * s->size;
  ShapeMoments m;
  PetscFunctionBeginUser;
  PetscCall(SurfacePlace(at, X, PETSC_FALSE));
  PetscCall(ShapeMeasure(at, &m));
  row[SPACE_BENDING] = vesicle->setting.bending * at->energy;
  row[SPACE_AREA] = at->area;
  row[SPACE_VOLUME] = at->volume;
  row[SPACE_AREA_ERROR] = at->area / vesicle->area - 1;
  row[SPACE_VOLUME_ERROR] = at->volume / vesicle->volume - 1;
  for (int d = 0; d < 3; d++) {
    row[SPACE_CENTER_X + d] = m.center[d];
    row[SPACE_AXIS_SHORT + d] = m.axis[d];
  }
  const PetscReal *axis = m.direction[2], side = axis[0] < 0 ? -1 : 1;
  row[SPACE_INCLINATION] = PetscAtan2Real(side * axis[1], side * axis[0]);
  row[SPACE_ELEVATION] = PetscAsinReal(PetscClipInterval(side * axis[2], -1, 1));
  row[SPACE_TAIL] = ShapeTail(s->sphere->p, X);
  PetscCall(SpaceRecordMotion(at, &m, s->state.U + v * s->size, s->state.sigma + v * s->count, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A column of all vesicles. */
static PetscReal SpaceRecordCombine(const SpaceRecord *r, int c) {
  PetscReal value = r->each[c];
  for (PetscInt v = 1; v < r->space->share.vesicles; v++) {
    const PetscReal x = r->each[v * SPACE_COUNT + c];
    if (kinds[c] == KIND_TOTAL || kinds[c] == KIND_MEAN) value += x;
    if (kinds[c] == KIND_WORST && PetscAbsReal(x) > PetscAbsReal(value)) value = x;
    if (kinds[c] == KIND_LEAST) value = PetscMin(value, x);
    if (kinds[c] == KIND_LARGEST) value = PetscMax(value, x);
  }
  return kinds[c] == KIND_MEAN ? value / (PetscReal)r->space->share.vesicles : value;
}

PetscErrorCode SpaceRecordMeasure(SpaceRecord *r) {
  const Space s = r->space;
  PetscMPIInt all;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(r->each, s->share.vesicles * SPACE_COUNT));
  for (PetscInt v = 0; v < s->share.own; v++)
    PetscCall(SpaceRecordVesicle(s, v, r->each + (s->share.first + v) * SPACE_COUNT));
  PetscCall(PetscMPIIntCast(s->share.vesicles * SPACE_COUNT, &all));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->each, all, MPIU_REAL, MPI_SUM, s->share.comm));
  for (int c = 0; c < SPACE_COUNT; c++)
    if (kinds[c] != KIND_RUN) r->last[c] = SpaceRecordCombine(r, c);
  r->last[SPACE_STEP] = s->state.step;
  r->last[SPACE_TIME] = s->state.t;
  r->last[SPACE_DT] = s->report.dt;
  if (s->cross) PetscCall(CrossLayerPlace(s->cross, s->state.X));
  r->last[SPACE_GAP] = s->cross ? s->cross->gap : NAN;
  r->last[SPACE_ITS] = s->report.its;
  r->last[SPACE_WALL] = s->report.seconds;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceRecordTake(SpaceRecord *r) {
  size_t used = 0;
  PetscFunctionBeginUser;
  PetscCall(SpaceRecordMeasure(r));
  r->its += r->space->report.its;
  for (PetscInt v = 0; v <= SpaceRecordOwn(r); v++)
    for (int c = 0; c < SPACE_COUNT; c++) {
      const PetscReal x = v ? r->each[(v - 1) * SPACE_COUNT + c] : r->last[c];
      if (v && kinds[c] == KIND_RUN) continue;
      used += (size_t)snprintf(r->text + used, r->room - used, "%s", used ? "," : "");
      if (!PetscIsNanReal(x)) used += (size_t)snprintf(r->text + used, r->room - used, "%.17g", (double)x);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
