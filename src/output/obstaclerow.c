#include "output/obstaclerow.h"
#include "scheme/pressuredrop.h"

#define TOTALS 4 /* columns of all obstacles together */

/* Columns of one. */
static PetscInt Each(const SceneObstacles *o) {
  return o->moving ? 6 : 3;
}

PetscInt ObstacleRowCount(const SceneObstacles *o) {
  const PetscInt obstacles = o->outline.vesicles;
  if (!obstacles) return 0;
  return TOTALS + (obstacles <= OBSTACLE_ROW_FEW ? Each(o) * obstacles : 0);
}

void ObstacleRowName(const SceneObstacles *o, PetscInt k, char name[OBSTACLE_ROW_NAME]) {
  static const char *const totals[] = {"pressure_drop", "flux", "obstacle_force_x", "obstacle_force_y"};
  static const char *const names[] = {"force_x", "force_y", "torque", "center_x", "center_y", "angle"};
  if (k < TOTALS)
    (void)snprintf(name, OBSTACLE_ROW_NAME, "%s", totals[k]);
  else
    (void)snprintf(name, OBSTACLE_ROW_NAME, "obstacle_%s_%d", names[(k - TOTALS) % Each(o)],
                   (int)((k - TOTALS) / Each(o) + 1));
}

/* Of one obstacle. */
static void TakeOne(Scheme s, PetscInt b, const ObstacleLoad *load, PetscReal values[]) {
  const ObstaclePose pose = ObstaclesPose(s->coupling->bodies->obstacles, b, s->state.t);
  values[2] = load->torque;
  for (int c = 0; c < 2; c++) values[c] = load->force[c];
  if (!s->scene->obstacles.moving) return;
  values[5] = pose.angle;
  for (int c = 0; c < 2; c++) values[3 + c] = pose.center[c];
}

/* to += scale times a force at a place and its torque, about c: the nearest images count. */
static void AddLoad(Grid g, PetscReal scale, const ObstacleLoad *from, const PetscReal place[2], const PetscReal c[2],
                    ObstacleLoad *to) {
  PetscReal d[2];
  for (int k = 0; k < 2; k++) {
    const PetscReal period = g->hi[k] - g->lo[k];
    d[k] = place[k] - c[k];
    if (!g->wall[k]) d[k] -= period * PetscFloorReal(d[k] / period + 0.5);
    to->force[k] += scale * from->force[k];
  }
  to->torque += scale * (from->torque + d[0] * from->force[1] - d[1] * from->force[0]);
}

/* The force of each vesicle on the fluid that is not zero in all, gravity's and contact's, and its torque about the
   centroid, the place; load[vesicles], place[2 vesicles]. */
static PetscErrorCode VesicleLoads(Scheme s, ObstacleLoad load[], PetscReal place[]) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  const PetscScalar *X;
  PetscScalar *F;
  PetscReal energy;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * l->n, &F));
  PetscCall(VecGetArrayRead(s->state.X, &X));
  MembraneGravity(m, 1, X, F);
  if (s->coupling->repulsion) PetscCall(RepulsionAt(s->coupling->repulsion, s->state.t, 1, X, F, &energy));
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = LayoutOffset(l, v);
    Measures measures;
    MembraneMeasure(m, v, X + 2 * at, &measures);
    for (int c = 0; c < 2; c++) place[2 * v + c] = measures.center[c];
    for (PetscInt k = 2 * at; k < 2 * (at + LayoutCount(l, v)); k += 2) {
      for (int c = 0; c < 2; c++) load[v].force[c] += F[k + c];
      load[v].torque += (X[k] - measures.center[0]) * F[k + 1] - (X[k + 1] - measures.center[1]) * F[k];
    }
  }
  PetscCall(VecRestoreArrayRead(s->state.X, &X));
  PetscCall(PetscFree(F));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, load, (PetscMPIInt)(3 * l->bodies), MPIU_REAL, MPI_SUM, l->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, place, (PetscMPIInt)(2 * l->bodies), MPIU_REAL, MPI_SUM, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a container the fluid inside counts, F has that outside too. Without inertia the momentum of the fluid inside
   balances: the load is minus those of the posts and plus those of the vesicles in it. With inertia it is not known of
   a container that moves. */
static PetscErrorCode WettedSide(Scheme s, ObstacleLoad load[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const SceneObstacles *own = &s->scene->obstacles;
  const PetscInt vesicles = s->membrane->layout->bodies, curves = o->layout->bodies;
  ObstacleLoad *inner;
  PetscReal *place;
  PetscFunctionBeginUser;
  if (!s->state.step) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(vesicles + curves, &inner, 2 * (vesicles + curves), &place));
  PetscCall(VesicleLoads(s, inner, place));
  for (PetscInt b = 0; b < curves; b++) {
    const ObstaclePose pose = ObstaclesPose(o, b, s->state.t);
    for (int c = 0; c < 2; c++) place[2 * (vesicles + b) + c] = pose.center[c];
    inner[vesicles + b] = load[b];
  }
  for (PetscInt b = 0; b < curves; b++) {
    const ObstacleMotion *m = &o->motion[b];
    const PetscBool moves = m->velocity[0] != 0 || m->velocity[1] != 0 || m->rotation != 0 ? PETSC_TRUE : PETSC_FALSE;
    if (!o->container[b] || (!s->fluid->steady && !moves)) continue;
    load[b] = s->fluid->steady ? (ObstacleLoad){{0, 0}, 0} : (ObstacleLoad){{NAN, NAN}, NAN};
    for (PetscInt k = 0; k < vesicles + curves; k++)
      if (own->holder[k] == b)
        AddLoad(s->fluid->grid, k < vesicles ? 1 : -1, &inner[k], place + 2 * k, place + 2 * (vesicles + b), &load[b]);
  }
  PetscCall(PetscFree2(inner, place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleRowTake(Scheme s, PetscReal values[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const PetscScalar *F;
  ObstacleLoad *load;
  Drive drive;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt curves = o->layout->bodies, count = ObstacleRowCount(&s->scene->obstacles);
  PetscCall(PetscMalloc1(curves, &load));
  PetscCall(VecGetArrayRead(s->state.solid, &F));
  PetscCall(ObstaclesLoads(o, s->state.t, F, load));
  PetscCall(VecRestoreArrayRead(s->state.solid, &F));
  PetscCall(WettedSide(s, load));
  PetscCall(PetscArrayzero(values, count));
  PetscCall(DriveMeasure(s, &drive));
  values[0] = drive.pressure_drop;
  values[1] = drive.flux;
  for (PetscInt b = 0; b < curves; b++) {
    for (int c = 0; c < 2; c++) values[2 + c] += load[b].force[c];
    if (count > TOTALS) TakeOne(s, b, &load[b], values + TOTALS + Each(&s->scene->obstacles) * b);
  }
  PetscCall(PetscFree(load));
  PetscFunctionReturn(PETSC_SUCCESS);
}
