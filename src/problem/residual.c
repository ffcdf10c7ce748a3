#include "problem/residual.h"
#include "mobility/contrast.h"
#include "markers/streamresponse.h"

/* F = Dm^T sigma + (1/a0) K V of all forces (bodies/force.h), minus h^2 times the force on the markers, and
   that of obstacles. */
static PetscErrorCode ReducedForce(Reduced s, const PetscScalar x[], Vec F) {
  const Coupling c = s->unknowns->coupling;
  const Membrane m = c->membrane;
  PetscScalar *f;
  PetscFunctionBeginUser;
  PetscCall(VecSet(F, 0));
  PetscCall(VecGetArray(F, &f));
  PetscCall(ForcesRate(c->forces, 1 / c->fluid->a0, x, f));
  MembraneStretchingTranspose(m, c->tau, 1, x + UnknownsTension(s->unknowns), f);
  PetscCall(PetscArraycpy(f + s->unknowns->velocity, x + s->unknowns->velocity, s->unknowns->solid));
  PetscCall(VecRestoreArray(F, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The motion that x gives the markers, or (whole) all of it with what is known, in s->motion. */
static PetscErrorCode ReducedMotion(Reduced s, const PetscScalar x[], PetscBool whole) {
  const PetscScalar *known = NULL;
  PetscScalar *G;
  PetscFunctionBeginUser;
  if (!s->motion) PetscFunctionReturn(PETSC_SUCCESS);
  if (whole) PetscCall(VecGetArrayRead(s->problem->moved, &known));
  PetscCall(VecGetArray(s->motion, &G));
  ContrastMotion(s->unknowns->coupling, x, known, G);
  PetscCall(VecRestoreArray(s->motion, &G));
  if (whole) PetscCall(VecRestoreArrayRead(s->problem->moved, &known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r += -E^T F/h^2 and the motion's dipoles; leaves F and the motion. */
static PetscErrorCode ReducedAddForces(Reduced s, const PetscScalar x[], PetscBool whole, Forcing *r) {
  const Coupling c = s->unknowns->coupling;
  PetscFunctionBeginUser;
  if (CouplingHasBodies(c)) {
    PetscCall(ReducedForce(s, x, s->F));
    PetscCall(ForcingSpread(r, c->markers, -1 / PetscSqr(c->fluid->grid->h), s->F));
  }
  PetscCall(ReducedMotion(s, x, whole));
  if (s->motion) PetscCall(ContrastSpread(c, s->motion, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y -= what is known: an own part of a right-hand side. */
static PetscErrorCode Subtract(Vec known, PetscInt n, PetscScalar y[]) {
  const PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(known, &a));
  for (PetscInt k = 0; k < n; k++) y[k] -= a[k];
  PetscCall(VecRestoreArrayRead(known, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The residual y of x in the equations of residual.h, scaled, where s->U has E u (1) and s->F has F (2) of x. With
   problem NULL: what is linear in x, for a product with the operator. Collective. */
static PetscErrorCode ReducedResidual(Reduced s, const CoupledProblem *problem, const PetscScalar x[],
                                      PetscScalar y[]) {
  const Coupling c = s->unknowns->coupling;
  const Unknowns u = s->unknowns;
  const PetscInt n = u->velocity, tension = UnknownsTension(u);
  const Vec known = problem ? problem->F : NULL;
  const PetscScalar *U;
  PetscFunctionBeginUser;
  if (!CouplingHasBodies(c)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(y, tension));
  /* (3) V + (v/a0) dV/dt; with viscosity contrast the motion's double layer stands in its place */
  if (s->motion)
    PetscCall(ContrastAdd(c, 1, s->motion, y));
  else {
    PetscCall(PetscArraycpy(y, x, n));
    MembraneTread(c->membrane, c->treading, 1 / c->fluid->a0, x, y);
  }
  /* (3), (5) - E u + C F - k */
  PetscCall(VecGetArrayRead(s->U, &U));
  for (PetscInt k = 0; k < tension; k++) y[k] -= U[k];
  PetscCall(VecRestoreArrayRead(s->U, &U));
  if (known) PetscCall(VecWAXPY(s->all, 1, s->F, known));
  PetscCall(CouplingNearField(c, 1, known ? s->all : s->F, y));
  if (problem) PetscCall(Subtract(problem->k, tension, y));
  /* (5) beta N N^T F */
  if (c->bodies->obstacles) ObstaclesPressure(c->bodies->obstacles, x + n, y + n);
  /* (4) Dm V/h^2 - g */
  MembraneStretching(c->membrane, c->tau, x, y + tension);
  for (PetscInt k = 0; k < u->tension; k++) y[tension + k] /= PetscSqr(c->fluid->grid->h);
  if (problem) PetscCall(Subtract(problem->g, u->tension, y + tension));
  if (c->area) AreaRowReplace(c->area, problem ? PETSC_TRUE : PETSC_FALSE, x, y); /* in (3) */
  UnknownsScale(u, PETSC_FALSE, y);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In a box that is periodic both ways, and in a channel without flux, the solve leaves w without a mean, which dipoles
   have. */
static PetscErrorCode ReducedAddMean(Reduced s, const PetscReal mean[2], Vec w) {
  const Grid g = s->unknowns->coupling->fluid->grid;
  const PetscReal *profile = StokesProfile(s->stokes);
  PetscScalar *a;
  PetscFunctionBeginUser;
  if (!s->unknowns->coupling->contrast || g->wall[0] || (g->wall[1] && !profile)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(w, &a));
  for (int f = FIELD_U; f <= (g->wall[1] ? FIELD_U : FIELD_V); f++)
    for (PetscInt j = 0; j < g->rows[f]; j++)
      for (PetscInt i = 0; i < g->n[0]; i++)
        a[GridRowStart(g, (Field)f, j) + i] += mean[f] * (profile ? profile[g->first + j] : 1);
  PetscCall(VecRestoreArray(w, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedFields(Reduced s, const Forcing *r, Vec w, Vec p) {
  PetscFunctionBeginUser;
  if (!s->stokes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StokesSolve(s->stokes, r->values, r->source, w, p));
  PetscCall(ReducedAddMean(s, r->mean, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U = E u becomes what the markers have of it. */
static PetscErrorCode ReducedTakePart(Reduced s) {
  const Coupling c = s->unknowns->coupling;
  PetscFunctionBeginUser;
  if (c->lag > 0) PetscCall(VecScale(s->U, CouplingGridPart(c, c->fluid->alpha)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The dipoles of the motion as rows, own: with their force. */
static PetscErrorCode ReducedSetDipoles(Reduced s, PetscBool own) {
  const PetscScalar *G;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(s->motion, &G));
  PetscCall(DoubleLayerRows(s->unknowns->coupling->contrast, G, own, StokesProfile(s->stokes), s->dipoles));
  PetscCall(VecRestoreArrayRead(s->motion, &G));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U of the forces of x alone, row by row; zero in unbounded fluid. */
static PetscErrorCode ReducedRespond(Reduced s, const PetscScalar x[]) {
  const Coupling c = s->unknowns->coupling;
  PetscFunctionBeginUser;
  PetscCall(ReducedForce(s, x, s->F));
  PetscCall(ReducedMotion(s, x, PETSC_FALSE));
  if (!s->stream) {
    PetscCall(VecSet(s->U, 0));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (s->motion) PetscCall(ReducedSetDipoles(s, PETSC_TRUE));
  PetscCall(MarkersRespond(c->markers, s->stream, s->motion ? s->dipoles : NULL, -1 / PetscSqr(c->fluid->grid->h), s->F,
                           s->U));
  PetscCall(ReducedTakePart(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReducedMult(Mat A, Vec x, Vec y) {
  Reduced s;
  const PetscScalar *xa;
  PetscScalar *ya;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(VecGetArrayRead(x, &xa));
  if (CouplingHasBodies(s->unknowns->coupling)) PetscCall(ReducedRespond(s, xa));
  PetscCall(VecGetArray(y, &ya));
  PetscCall(ReducedResidual(s, NULL, xa, ya));
  PetscCall(VecRestoreArray(y, &ya));
  PetscCall(VecRestoreArrayRead(x, &xa));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U of problem->f, which has the dipoles' forces, row by row. */
static PetscErrorCode ReducedFollowByRows(Reduced s) {
  const CoupledProblem *q = s->problem;
  const Coupling c = s->unknowns->coupling;
  PetscFunctionBeginUser;
  if (s->motion) PetscCall(ReducedSetDipoles(s, PETSC_FALSE));
  PetscCall(MarkersFollow(c->markers, s->stream, s->motion ? s->dipoles : NULL, q->f, NULL, s->U,
                          q->w ? NULL : &s->measures));
  PetscCall(ReducedTakePart(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The flow and its U: of problem->f and of the states before (first), or with the forces F that have been added to f.
   What is measured is a sum then, too, but for the divergence, which it bounds. */
static PetscErrorCode ReducedFollowFlow(Reduced s, PetscBool first) {
  const CoupledProblem *q = s->problem;
  const Coupling c = s->unknowns->coupling;
  StreamMeasures more;
  PetscFunctionBeginUser;
  if (first)
    PetscCall(MarkersFollow(c->markers, s->stream, NULL, q->f, q->past, s->sum, &s->measures));
  else {
    const PetscReal alpha = -1 / PetscSqr(c->fluid->grid->h);
    PetscCall(MarkersAddFlow(c->markers, s->stream, alpha, s->F, s->U, q->past->made, &more));
    PetscCall(ReducedTakePart(s));
    PetscCall(VecAXPY(s->sum, 1, s->U));
    s->measures.divergence += more.divergence;
    s->measures.slip += more.slip;
    s->measures.pressure += more.pressure;
  }
  PetscCall(VecCopy(s->sum, s->U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U of problem->f, and w and p unless they are not wanted or (first) not yet and U can be had without. */
static PetscErrorCode ReducedFollow(Reduced s, PetscBool first) {
  const CoupledProblem *q = s->problem;
  const Coupling c = s->unknowns->coupling;
  const PetscBool bodies = CouplingHasBodies(c);
  PetscFunctionBeginUser;
  if ((first || !q->w) && s->stream) {
    if (bodies) PetscCall(q->past ? ReducedFollowFlow(s, first) : ReducedFollowByRows(s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ReducedFields(s, q->f, q->w, q->p));
  if (bodies) PetscCall(MarkersInterpolate(c->markers, q->w, s->U));
  PetscCall(ReducedTakePart(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The forces of `added`, which is x itself (first) or a change of it, go into problem->f; minus the scaled residuals
   at x. */
static PetscErrorCode ReducedResidualAt(Reduced s, PetscBool first, Vec added, Vec x, Vec residual) {
  const CoupledProblem *q = s->problem;
  const PetscScalar *xa;
  PetscScalar *ra;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(added, &xa));
  PetscCall(ReducedAddForces(s, xa, first, q->f));
  PetscCall(VecRestoreArrayRead(added, &xa));
  PetscCall(VecGetArrayRead(x, &xa));
  if (q->past) PetscCall(ReducedFollow(s, first)); /* while F is that of `added` */
  if (!first && CouplingHasBodies(s->unknowns->coupling)) {
    PetscCall(ReducedForce(s, xa, s->F));
    PetscCall(ReducedMotion(s, xa, PETSC_TRUE));
  }
  if (!q->past) PetscCall(ReducedFollow(s, first));
  PetscCall(VecGetArray(residual, &ra));
  PetscCall(ReducedResidual(s, q, xa, ra));
  PetscCall(VecRestoreArray(residual, &ra));
  PetscCall(VecRestoreArrayRead(x, &xa));
  PetscCall(VecScale(residual, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedBegin(Reduced s, const CoupledProblem *problem, Vec x, Vec residual) {
  PetscFunctionBeginUser;
  s->problem = problem;
  s->measures = (StreamMeasures){0};
  PetscCall(ReducedResidualAt(s, PETSC_TRUE, x, x, residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedUpdate(Reduced s, Vec added, Vec x, Vec residual) {
  PetscFunctionBeginUser;
  PetscCall(ReducedResidualAt(s, PETSC_FALSE, added, x, residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ReducedNeedsNoPressure(Reduced s) {
  const Coupling c = s->unknowns->coupling;
  return s->stream && CouplingHasBodies(c) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ReducedPressure(Reduced s, const Forcing *f, Vec w, Vec p) {
  PetscFunctionBeginUser;
  PetscCall(StokesPressure(s->stokes, f->values, w, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedCreate(Unknowns u, Reduced *out) {
  const Coupling c = u->coupling;
  const PetscInt n = UnknownsTension(u) + u->tension;
  Reduced s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->unknowns = u;
  if (!c->fluid->grid->free) PetscCall(StokesCreate(c->fluid, &s->stokes));
  if (s->stokes) s->stream = StokesStream(s->stokes);
  PetscCall(LayoutCreateVec(c->bodies->layout, 2, &s->F));
  PetscCall(VecDuplicate(s->F, &s->U));
  PetscCall(VecDuplicate(s->F, &s->all));
  if (!c->fluid->steady) PetscCall(VecDuplicate(s->F, &s->sum));
  if (c->contrast) {
    PetscCall(VecDuplicate(s->F, &s->motion));
    if (s->stream) PetscCall(DipoleRowsCreate(c->fluid->grid, c->fluid->nu, &s->dipoles));
  }
  PetscCall(MatCreateShell(c->fluid->grid->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, s, &s->A));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT, (void (*)(void))ReducedMult));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedDestroy(Reduced *reduced) {
  Reduced s = *reduced;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDestroy(&s->F));
  PetscCall(VecDestroy(&s->U));
  PetscCall(VecDestroy(&s->all));
  PetscCall(VecDestroy(&s->sum));
  PetscCall(VecDestroy(&s->motion));
  PetscCall(DipoleRowsDestroy(&s->dipoles));
  PetscCall(MatDestroy(&s->A));
  PetscCall(StokesDestroy(&s->stokes));
  PetscCall(PetscFree(*reduced));
  PetscFunctionReturn(PETSC_SUCCESS);
}
