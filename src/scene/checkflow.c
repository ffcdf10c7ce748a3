/* A flow of the caller's: it must have no divergence, since the fluid's velocity has none. */
#include "base/agree.h"
#include "scene/resolve.h"

#define POINTS 7       /* in x, and in y, in the box */
#define STEP 1e-3      /* of the differences, in cells: their error is a millionth of the flow's change over a cell */
#define TOLERATED 1e-3 /* divergence over the largest gradient: flows from tables of numbers have some */
#define ROUNDOFF 1e-11 /* of a velocity, which differences show too */

typedef struct {
  PetscReal divergence, x, y; /* the largest, and where */
  PetscReal gradient, speed;  /* largest values */
} Largest;

/* Differences about one point from the velocities to its right, left, top and bottom. */
static void Compare(const PetscReal u[8], PetscReal x, PetscReal y, PetscReal apart, Largest *most) {
  const PetscReal ux = (u[0] - u[2]) / apart, vx = (u[1] - u[3]) / apart;
  const PetscReal uy = (u[4] - u[6]) / apart, vy = (u[5] - u[7]) / apart;
  const PetscReal gradient = PetscMax(PetscMax(PetscAbsReal(ux), PetscAbsReal(uy)),
                                      PetscMax(PetscAbsReal(vx), PetscAbsReal(vy)));
  for (int k = 0; k < 8; k++) most->speed = PetscMax(most->speed, PetscAbsReal(u[k]));
  most->gradient = PetscMax(most->gradient, gradient);
  if (PetscAbsReal(ux + vy) <= PetscAbsReal(most->divergence)) return;
  most->divergence = ux + vy;
  most->x = x;
  most->y = y;
}

PetscErrorCode SceneCheckDivergence(Scene scene) {
  const PetscReal *box = scene->fluid.box, step = STEP * FluidSpecCellSize(&scene->fluid);
  char message[PETVES_MAX_MESSAGE] = "";
  Largest most = {0};
  PetscFunctionBeginUser;
  if (scene->flow.type != FLOW_CUSTOM) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < POINTS * POINTS && !*message; k++) {
    const PetscReal x = box[0] + (box[1] - box[0]) * ((PetscReal)(k % POINTS) + 0.5) / POINTS;
    const PetscReal y = box[2] + (box[3] - box[2]) * ((PetscReal)(k / POINTS) + 0.5) / POINTS;
    const PetscReal at[8] = {x + step, y, x - step, y, x, y + step, x, y - step};
    PetscReal u[8];
    PetscCall(FlowVelocities(&scene->flow, 0, 4, at, u, message));
    if (!*message) Compare(u, x, y, 2 * step, &most);
  }
  if (!*message && PetscAbsReal(most.divergence) > TOLERATED * most.gradient + ROUNDOFF * most.speed / step)
    PetscCall(PetscSNPrintf(message, sizeof(message),
                            "-flow_type custom: u_inf has the divergence %.3g at (%.3g, %.3g), time 0; allowed: none, "
                            "here up to %.1g, a thousandth of its largest gradient",
                            (double)most.divergence, (double)most.x, (double)most.y,
                            (double)(TOLERATED * most.gradient)));
  PetscCall(AgreeMessage(scene->comm, message));
  PetvesCheck(!*message, scene->comm, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}
