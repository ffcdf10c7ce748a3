#include "output/obstaclerow.h"
#include "scheme/drive.h"

#define TOTALS 4 /* columns of all obstacles together */
#define EACH 3   /* of one */

PetscInt ObstacleRowCount(PetscInt obstacles) {
  if (!obstacles) return 0;
  return TOTALS + (obstacles <= OBSTACLE_ROW_FEW ? EACH * obstacles : 0);
}

void ObstacleRowName(PetscInt k, char name[OBSTACLE_ROW_NAME]) {
  static const char *const totals[] = {"pressure_drop", "flux", "obstacle_force_x", "obstacle_force_y"};
  static const char *const names[] = {"force_x", "force_y", "torque"};
  if (k < TOTALS)
    (void)snprintf(name, OBSTACLE_ROW_NAME, "%s", totals[k]);
  else
    (void)snprintf(name, OBSTACLE_ROW_NAME, "obstacle_%s_%d", names[(k - TOTALS) % EACH],
                   (int)((k - TOTALS) / EACH + 1));
}

PetscErrorCode ObstacleRowTake(Scheme s, PetscReal values[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const PetscScalar *F;
  ObstacleLoad *load;
  Drive drive;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt curves = o->layout->bodies, count = ObstacleRowCount(curves);
  PetscCall(PetscMalloc1(curves, &load));
  PetscCall(VecGetArrayRead(s->state.solid, &F));
  PetscCall(ObstaclesLoads(o, F, load));
  PetscCall(VecRestoreArrayRead(s->state.solid, &F));
  PetscCall(PetscArrayzero(values, count));
  PetscCall(DriveMeasure(s, &drive));
  values[0] = drive.pressure_drop;
  values[1] = drive.flux;
  for (PetscInt b = 0; b < curves; b++) {
    for (int c = 0; c < 2; c++) values[2 + c] += load[b].force[c];
    if (count == TOTALS) continue;
    PetscReal *own = values + TOTALS + EACH * b;
    for (int c = 0; c < 2; c++) own[c] = load[b].force[c];
    own[2] = load[b].torque;
  }
  PetscCall(PetscFree(load));
  PetscFunctionReturn(PETSC_SUCCESS);
}
