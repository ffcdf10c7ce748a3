#include "output/obstaclerow.h"
#include "scheme/drive.h"

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
