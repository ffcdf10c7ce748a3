#include "scene/flow3.h"
#include "base/agree.h"
#include "scene/properties.h"

#define STEP 1e-3      /* of the differences, over R */
#define TOLERATED 1e-3 /* divergence over the largest gradient */
#define LATER 0.618    /* of the end time: where formulas are looked at too */

/* A caller's flow, whose points and velocities have their coordinates side by side. */
static PetscErrorCode Flow3Custom(const Flow *f, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[]) {
  PetscReal *at, *found;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * n, &at, 3 * n, &found));
  for (PetscInt k = 0; k < 3 * n; k++) at[k] = X[k % 3 * n + k / 3];
  const PetscBool failed = (PetscBool)(f->function(t, n, at, found, f->ctx) != 0);
  for (PetscInt k = 0; k < 3 * n; k++) u[k % 3 * n + k / 3] = failed ? NAN : found[k];
  PetscCall(PetscFree2(at, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Flow3Velocities(const Flow *f, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[]) {
  const PetscReal L2 = f->half_width * f->half_width;
  PetscFunctionBeginUser;
  if (FlowIsCustom(f)) {
    PetscCall(Flow3Custom(f, t, n, X, u));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal x = X[i] - f->center[0], y = X[n + i] - f->center[1], z = X[2 * n + i];
    PetscReal at[3] = {0, 0, 0};
    if (f->type == FLOW_SHEAR) at[0] = f->rate * y;
    if (f->type == FLOW_POISEUILLE) at[0] = f->peak * (1 - y * y / L2);
    if (f->type == FLOW_TUBE) at[0] = f->peak * (1 - (y * y + z * z) / L2);
    if (f->type == FLOW_EXTENSION || f->type == FLOW_AXIAL) {
      at[0] = f->rate * x;
      at[1] = -f->rate * y * (f->type == FLOW_AXIAL ? 0.5 : 1);
      at[2] = f->type == FLOW_AXIAL ? -0.5 * f->rate * z : 0;
    }
    for (int d = 0; d < 3; d++) u[d * n + i] = f->type == FLOW_UNIFORM ? f->velocity.v[d] : at[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The divergence and the largest gradient at x, by differences over 2h. */
static PetscErrorCode Flow3Slopes(const Flow *f, PetscReal t, const PetscReal x[3], PetscReal h, PetscReal *divergence,
                                  PetscReal *largest) {
  PetscReal X[18], u[18];
  PetscFunctionBeginUser;
  for (int k = 0; k < 6; k++) /* ahead along x, y, z, then behind */
    for (int d = 0; d < 3; d++) X[6 * d + k] = x[d] + (d != k % 3 ? 0 : k < 3 ? h : -h);
  PetscCall(Flow3Velocities(f, t, 6, X, u));
  *divergence = 0;
  for (int k = 0; k < 3; k++)
    for (int d = 0; d < 3; d++) {
      const PetscReal slope = (u[6 * d + k] - u[6 * d + k + 3]) / (2 * h);
      *largest = slope == slope ? PetscMax(*largest, PetscAbsReal(slope)) : slope;
      if (d == k) *divergence += slope;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Flow3Check(MPI_Comm comm, const Flow *flow, PetscInt count, const RealList *center, PetscReal R,
                          PetscReal end, PetscReal *rate) {
  const PetscInt times = flow->type == FLOW_FORMULA ? 2 : 1, corners = 8;
  char message[PETVES_MAX_MESSAGE] = "";
  PetscReal largest = 0;
  PetscFunctionBeginUser;
  if (!FlowIsCustom(flow)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < times * count * corners && !*message; k++) {
    const PetscReal t = k < count * corners ? 0 : LATER * end;
    PetscReal x[3], divergence = 0;
    for (int d = 0; d < 3; d++) x[d] = ListEntry(center, 3, k / corners % count, d) + R * (k >> d & 1 ? 0.55 : -0.45);
    PetscCall(Flow3Slopes(flow, t, x, STEP * R, &divergence, &largest));
    if (!(PetscAbsReal(divergence) <= TOLERATED * largest + 1e-12))
      PetscCall(PetscSNPrintf(message, sizeof(message),
                              "-flow_type %s: u_inf has the divergence %.3g at (%.3g, %.3g, %.3g), time %.3g; allowed: "
                              "none, and finite numbers",
                              flow->type == FLOW_CUSTOM ? "custom" : "formula", (double)divergence, (double)x[0],
                              (double)x[1], (double)x[2], (double)t));
  }
  PetscCall(AgreeMessage(comm, message));
  PetvesCheck(!*message, comm, "%s", message);
  *rate = largest;
  PetscFunctionReturn(PETSC_SUCCESS);
}
