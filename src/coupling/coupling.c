#include "coupling/coupling.h"
#include "base/agree.h"

PetscErrorCode CouplingPlace(Coupling c, PetscReal a0, Vec X, char message[PETVES_MAX_MESSAGE]) {
  const PetscScalar *x;
  PetscBool factored = PETSC_TRUE, failed;
  PetscFunctionBeginUser;
  message[0] = 0;
  PetscCall(FluidSetTimeCoefficient(c->fluid, a0));
  if (!CouplingHasMembrane(c)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MarkersCheck(c->markers, X, message));
  if (*message) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MarkersPlace(c->markers, X));
  PetscCall(VecGetArrayRead(X, &x));
  MembraneTangents(c->membrane, x, c->tau);
  if (c->self) PetscCall(SelfMobilityPlace(c->self, a0, x, &factored));
  PetscCall(VecRestoreArrayRead(X, &x));
  if (!c->self) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AgreeFlag(c->fluid->grid->comm, factored ? PETSC_FALSE : PETSC_TRUE, &failed));
  if (failed)
    PetscCall(PetscStrncpy(message, "the membranes' self-mobility with their bending is not positive definite",
                           PETVES_MAX_MESSAGE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingSpreadTension(Coupling c, PetscReal alpha, Vec sigma, Vec w) {
  const PetscScalar *s;
  PetscScalar *F;
  PetscFunctionBeginUser;
  PetscCall(VecSet(c->force, 0));
  PetscCall(VecGetArrayRead(sigma, &s));
  PetscCall(VecGetArray(c->force, &F));
  MembraneStretchingTranspose(c->membrane, c->tau, 1 / PetscSqr(c->fluid->grid->h), s, F);
  PetscCall(VecRestoreArray(c->force, &F));
  PetscCall(VecRestoreArrayRead(sigma, &s));
  PetscCall(MarkersSpread(c->markers, alpha, c->force, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F = (c_b ds/h^2) D4 X */
static PetscErrorCode BendingForce(Coupling c, Vec X, Vec F) {
  const PetscScalar *x;
  PetscScalar *f;
  PetscFunctionBeginUser;
  PetscCall(VecSet(F, 0));
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArray(F, &f));
  MembraneBending(c->membrane, c->membrane->bending / PetscSqr(c->fluid->grid->h), x, f);
  PetscCall(VecRestoreArray(F, &f));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingSpreadBending(Coupling c, PetscReal alpha, Vec X, Vec w) {
  PetscFunctionBeginUser;
  PetscCall(BendingForce(c, X, c->force));
  PetscCall(MarkersSpread(c->markers, alpha, c->force, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingStretching(Coupling c, Vec U, Vec d) {
  const PetscScalar *u;
  PetscScalar *stretching;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(U, &u));
  PetscCall(VecGetArray(d, &stretching));
  MembraneStretching(c->membrane, c->tau, u, stretching);
  PetscCall(VecRestoreArray(d, &stretching));
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscCall(VecScale(d, 1 / PetscSqr(c->fluid->grid->h)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingSelfMobility(Coupling c, Vec sigma, Vec Xhat, Vec U) {
  const PetscScalar *s = NULL, *x = NULL;
  PetscScalar *u;
  PetscFunctionBeginUser;
  if (!c->self) PetscFunctionReturn(PETSC_SUCCESS);
  if (sigma) PetscCall(VecGetArrayRead(sigma, &s));
  if (Xhat) PetscCall(VecGetArrayRead(Xhat, &x));
  PetscCall(VecGetArray(U, &u));
  PetscCall(SelfMobilityApply(c->self, c->tau, s, x, u));
  PetscCall(VecRestoreArray(U, &u));
  if (Xhat) PetscCall(VecRestoreArrayRead(Xhat, &x));
  if (sigma) PetscCall(VecRestoreArrayRead(sigma, &s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingVelocity(Coupling c, Vec w, Vec sigma, Vec U) {
  PetscFunctionBeginUser;
  PetscCall(MarkersInterpolate(c->markers, w, U));
  PetscCall(CouplingSelfMobility(c, sigma, NULL, U));
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

PetscErrorCode CouplingCreate(Fluid fluid, Membrane m, const char kernel[], SelfMobilityType self, Coupling *out) {
  Coupling c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->fluid = fluid;
  c->membrane = m;
  PetscCall(MarkersCreate(fluid->grid, m->layout, kernel, &c->markers));
  PetscCall(PetscMalloc1(2 * m->layout->n, &c->tau));
  PetscCall(LayoutCreateVec(m->layout, 2, &c->force));
  PetscCall(VecDuplicate(c->force, &c->velocity));
  PetscCall(CreateShell(c, 1, Mult_S, MultTranspose_S, &c->S));
  PetscCall(CreateShell(c, 2, Mult_B, MultTranspose_B, &c->B));
  if (self != SELF_NONE && CouplingHasMembrane(c))
    PetscCall(SelfMobilityCreate(c->markers, m, fluid->nu, self, &c->self));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingDestroy(Coupling *coupling) {
  Coupling c = *coupling;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SelfMobilityDestroy(&c->self));
  PetscCall(MarkersDestroy(&c->markers));
  PetscCall(PetscFree(c->tau));
  PetscCall(VecDestroy(&c->force));
  PetscCall(VecDestroy(&c->velocity));
  PetscCall(MatDestroy(&c->S));
  PetscCall(MatDestroy(&c->B));
  PetscCall(PetscFree(*coupling));
  PetscFunctionReturn(PETSC_SUCCESS);
}
