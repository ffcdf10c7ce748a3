/* The preconditioner of the reduced coupled problem: of the markers' mobility among themselves, by a dense table of a
   periodic box or by Chat, and of each pair of walls by itself. */
#include "coupling/saddle.h"

#define MOST_WASTE 5

/* N V + (Mob + h^2 Theta) Dm^T sigma/h^2 = r_V,  Dm V/h^2 = r_s. */
static PetscErrorCode SolveTable(Saddle s, PetscScalar V[], PetscScalar tension[]) {
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(s->tension, tension, s->n_tension));
  PetscCall(DenseBlocksSolve(s->blocks, V, s->tension, tension));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* E A^-1 E^T ~ (1/a0) E (I + G diag(L)^-1 G^T) E^T, no bending: sigma = a0 Chat^-1 (Dm r_V/h^2 - r_s), V = r_V. */
static PetscErrorCode SolveChat(Saddle s, PetscScalar V[], PetscScalar tension[]) {
  const Coupling c = s->coupling;
  const PetscInt M = s->n_tension;
  Vec rhs, sigma;
  PetscFunctionBeginUser;
  MembraneStretching(c->membrane, c->tau, V, s->tension);
  for (PetscInt k = 0; k < M; k++) s->tension[k] = s->fluid->a0 * (s->tension[k] / PetscSqr(c->grid->h) - tension[k]);
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, M, s->tension, &rhs));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, M, tension, &sigma));
  PetscCall(PCApply(s->ilu, rhs, sigma));
  PetscCall(VecDestroy(&rhs));
  PetscCall(VecDestroy(&sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddlePrecondition(PC pc, Vec r, Vec z) {
  Saddle s;
  PetscScalar *za;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &s));
  /* dense blocks far too old: new ones from here on */
  if (s->flexible && s->type == MOBILITY_TABLE && s->coupling && s->age > 0 &&
      s->applied == s->fresh_its + MOST_WASTE) {
    s->life = s->age; /* next time before this happens */
    PetscCall(SaddleRefresh(s));
    s->renewed = s->applied;
  }
  s->applied++;
  PetscCall(VecCopy(r, z));
  PetscCall(VecGetArray(z, &za));
  PetscCall(WallsPrecondition(s->walls, za + s->n_velocity + s->n_tension));
  if (s->coupling) { /* the residuals are scaled */
    for (PetscInt k = 0; k < s->n_velocity; k++) za[k] /= SaddleVelocityScale(s, k / 2);
    for (PetscInt k = 0; k < s->n_tension; k++) za[s->n_velocity + k] /= SaddleScale(s, k);
    PetscCall(WallsMarkerVelocity(s->walls, 1, za)); /* block triangular: the walls' flow moves the markers */
    if (s->type == MOBILITY_TABLE) PetscCall(SolveTable(s, za, za + s->n_velocity));
    if (s->type == MOBILITY_ILU) PetscCall(SolveChat(s, za, za + s->n_velocity));
    if (s->type == MOBILITY_NONE)
      for (PetscInt k = 0; k < s->n_tension; k++) za[s->n_velocity + k] *= -1;
  }
  PetscCall(VecRestoreArray(z, &za));
  PetscFunctionReturn(PETSC_SUCCESS);
}
