#include "problem/coupling.h"
#include "bodies/bending.h"
#include "bodies/freebodies.h"
#include "bodies/seepage.h"

PetscErrorCode CouplingCopyVesicles(Coupling c, Vec from, Vec to) {
  PetscScalar *a, *b;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayPair(from, to, &a, &b));
  PetscCall(PetscArraycpy(b, a, 2 * c->membrane->layout->n));
  PetscCall(VecRestoreArrayPair(from, to, &a, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The obstacles' part of X. */
static PetscErrorCode PlaceObstacles(Coupling c, Instant at) {
  const Obstacles o = c->bodies->obstacles;
  PetscScalar *X;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ObstaclesPlace(o, at));
  PetscCall(VecGetArray(c->X, &X));
  PetscCall(PetscArraycpy(X + BodiesFirstObstacle(c->bodies), o->X + 2 * o->layout->first, 2 * o->layout->n));
  PetscCall(VecRestoreArray(c->X, &X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingPlaceMarkers(Coupling c, Vec X) {
  PetscFunctionBeginUser;
  PetscCall(CouplingCopyVesicles(c, X, c->X));
  PetscCall(MarkersPlace(c->markers, c->X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingInterpolate(Coupling c, Vec w, Vec U) {
  PetscFunctionBeginUser;
  PetscCall(MarkersInterpolate(c->markers, w, c->velocity));
  PetscCall(CouplingCopyVesicles(c, c->velocity, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingPlace(Coupling c, PetscReal a0, Instant at, Vec X, const PetscReal treading[],
                             char message[PETVES_MAX_MESSAGE]) {
  const PetscScalar *x;
  PetscFunctionBeginUser;
  message[0] = 0;
  for (PetscInt v = 0; v < c->membrane->layout->bodies; v++) c->treading[v] = treading ? treading[v] : 0;
  if (CouplingHasBodies(c)) {
    PetscCall(MarkersCheck(c->markers, c->membrane->layout, X, message));
    if (*message) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(PlaceObstacles(c, at));
    PetscCall(CouplingCopyVesicles(c, X, c->X));
  }
  PetscCall(MobilityPlace(c->mobility, a0, c->X));
  if (!CouplingHasBodies(c)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(X, &x));
  LawPlace(c->law, a0, x);
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscCall(ForcesPlace(c->forces, at, c->markers->X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingSpreadTension(Coupling c, PetscReal alpha, Vec sigma, Vec w) {
  PetscScalar *s, *F;
  PetscFunctionBeginUser;
  PetscCall(VecSet(c->force, 0));
  PetscCall(VecGetArrayPair(sigma, c->force, &s, &F));
  LawForce(c->law, 1 / PetscSqr(c->fluid->grid->h), s, F);
  PetscCall(VecRestoreArrayPair(sigma, c->force, &s, &F));
  PetscCall(MarkersSpread(c->markers, alpha, c->force, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F = (c_b ds/h^2) D4 X */
static PetscErrorCode BendingForce(Coupling c, Vec X, Vec F) {
  PetscScalar *x, *f;
  PetscFunctionBeginUser;
  PetscCall(VecSet(F, 0));
  PetscCall(VecGetArrayPair(X, F, &x, &f));
  MembraneBending(c->membrane, c->membrane->bending / PetscSqr(c->fluid->grid->h), x, f);
  PetscCall(VecRestoreArrayPair(X, F, &x, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingSpreadBending(Coupling c, PetscReal alpha, Vec X, Vec w) {
  PetscFunctionBeginUser;
  PetscCall(BendingForce(c, X, c->force));
  PetscCall(MarkersSpread(c->markers, alpha, c->force, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingMarkers(Coupling c, Vec Y, Vec place, Vec all) {
  PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(VecCopy(c->X, all));
  PetscCall(CouplingCopyVesicles(c, Y, all));
  if (!place) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(all, &x));
  FreeBodiesShift(c->bodies->obstacles, place, x + BodiesFirstObstacle(c->bodies));
  PetscCall(VecRestoreArray(all, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingStepForce(Coupling c, Vec Y, Vec X, Vec sigma, Vec F, PetscReal push[]) {
  const PetscInt first = BodiesFirstObstacle(c->bodies);
  const PetscScalar *y, *s;
  PetscScalar *x, *f;
  PetscFunctionBeginUser;
  PetscCall(VecSet(F, 0));
  PetscCall(VecGetArrayRead(Y, &y));
  PetscCall(VecGetArrayPair(X, F, &x, &f));
  PetscCall(ForcesRate(c->forces, 1, y, f));
  PetscCall(ForcesKnown(c->forces, 1, x, f));
  if (push) FreeBodiesSum(c->bodies->obstacles, f + first, push);
  PetscCall(PetscArrayzero(f + first, BodiesObstacleNumbers(c->bodies)));
  if (sigma) {
    PetscCall(VecGetArrayRead(sigma, &s));
    LawForce(c->law, 1, s, f);
    PetscCall(VecRestoreArrayRead(sigma, &s));
  }
  PetscCall(VecRestoreArrayPair(X, F, &x, &f));
  PetscCall(VecRestoreArrayRead(Y, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingTread(Coupling c, PetscReal alpha, Vec X, Vec U) {
  PetscScalar *x, *u;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayPair(X, U, &x, &u));
  MembraneTread(c->membrane, c->treading, alpha, x, u);
  PetscCall(VecRestoreArrayPair(X, U, &x, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingSeep(Coupling c, PetscReal alpha, Vec X, Vec F, Vec U) {
  const PetscScalar *f = NULL;
  PetscScalar *x, *u;
  PetscFunctionBeginUser;
  if (F) PetscCall(VecGetArrayRead(F, &f));
  PetscCall(VecGetArrayPair(X, U, &x, &u));
  SeepageAdd(c->membrane, alpha, PETSC_TRUE, x, f, u);
  PetscCall(VecRestoreArrayPair(X, U, &x, &u));
  if (F) PetscCall(VecRestoreArrayRead(F, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingStretching(Coupling c, Vec U, Vec d) {
  PetscScalar *u, *stretching;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayPair(U, d, &u, &stretching));
  LawRows(c->law, u, NULL, stretching);
  PetscCall(VecRestoreArrayPair(U, d, &u, &stretching));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The shells S and B, and their transposes S^T w = Dm E w/h^2, B^T w = (c_b ds/h^2) D4 E w. */
static PetscErrorCode Mult_S(Mat S, Vec sigma, Vec w) {
  Coupling c;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(S, &c));
  PetscCall(VecSet(w, 0));
  PetscCall(CouplingSpreadTension(c, 1, sigma, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MultTranspose_S(Mat S, Vec w, Vec d) {
  Coupling c;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(S, &c));
  PetscCall(MarkersInterpolate(c->markers, w, c->velocity));
  PetscCall(CouplingStretching(c, c->velocity, d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Mult_B(Mat B, Vec X, Vec w) {
  Coupling c;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(B, &c));
  PetscCall(VecSet(w, 0));
  PetscCall(CouplingSpreadBending(c, 1, X, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MultTranspose_B(Mat B, Vec w, Vec X) {
  Coupling c;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(B, &c));
  PetscCall(MarkersInterpolate(c->markers, w, c->velocity));
  PetscCall(BendingForce(c, c->velocity, X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef PetscErrorCode (*ShellMult)(Mat, Vec, Vec);

/* A shell from vectors with `each` numbers a marker to velocities. */
static PetscErrorCode CreateShell(Coupling c, int each, ShellMult mult, ShellMult transpose, Mat *A) {
  const Grid g = c->fluid->grid;
  const Layout l = c->membrane->layout;
  const PetscInt slab = GridLocalU(g) + g->columns[FIELD_V] * g->rows[FIELD_V];
  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(g->comm, slab, each * l->n, PETSC_DETERMINE, each * l->M, c, A));
  PetscCall(MatShellSetOperation(*A, MATOP_MULT, (void (*)(void))mult));
  PetscCall(MatShellSetOperation(*A, MATOP_MULT_TRANSPOSE, (void (*)(void))transpose));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingCreate(Fluid fluid, Membrane m, Obstacles obstacles, const CouplingSetting *setting,
                              Coupling *out) {
  Coupling c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->fluid = fluid;
  c->membrane = m;
  PetscCall(BodiesCreate(m, obstacles, &c->bodies));
  PetscCall(MobilityCreate(fluid, c->bodies, &setting->mobility, &c->mobility));
  c->markers = c->mobility->markers;
  PetscCall(LawCreate(m, fluid->grid->h, m->layout->own, m->layout->end, &c->law));
  PetscCall(PetscCalloc1(m->layout->bodies, &c->treading));
  PetscCall(LayoutCreateVec(c->bodies->layout, 2, &c->force));
  PetscCall(VecDuplicate(c->force, &c->X));
  PetscCall(PlaceObstacles(c, (Instant){0}));
  PetscCall(VecDuplicate(c->force, &c->velocity));
  PetscCall(CreateShell(c, 1, Mult_S, MultTranspose_S, &c->S));
  PetscCall(CreateShell(c, 2, Mult_B, MultTranspose_B, &c->B));
  PetscCall(ForcesCreate(c->bodies, fluid->grid, setting->scene, &c->forces));
  if (setting->area_target) PetscCall(LawAimAreas(c->law, setting->mobility.ratio));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingForces(Coupling c, Instant at, Vec sigma, Vec X, Vec F) {
  const Membrane m = c->membrane;
  const PetscScalar *x, *s;
  PetscScalar *f;
  MembraneLaw law;
  PetscFunctionBeginUser;
  PetscCall(LawCreate(m, c->fluid->grid->h, m->layout->own, m->layout->end, &law));
  PetscCall(VecSet(F, 0));
  PetscCall(VecGetArray(F, &f));
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArrayRead(sigma, &s));
  LawPlace(law, 1, x);
  LawForce(law, -1, s, f);
  PetscCall(ForcesLaw(c->forces, FORCE_WITHIN, FORCE_OUTSIDE, at, x, f));
  PetscCall(VecRestoreArrayRead(sigma, &s));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscCall(VecRestoreArray(F, &f));
  PetscCall(LawDestroy(&law));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingDestroy(Coupling *coupling) {
  Coupling c = *coupling;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForcesDestroy(&c->forces));
  PetscCall(MobilityDestroy(&c->mobility));
  PetscCall(BodiesDestroy(&c->bodies));
  PetscCall(LawDestroy(&c->law));
  PetscCall(PetscFree(c->treading));
  PetscCall(VecDestroy(&c->X));
  PetscCall(VecDestroy(&c->force));
  PetscCall(VecDestroy(&c->velocity));
  PetscCall(MatDestroy(&c->S));
  PetscCall(MatDestroy(&c->B));
  PetscCall(PetscFree(*coupling));
  PetscFunctionReturn(PETSC_SUCCESS);
}
