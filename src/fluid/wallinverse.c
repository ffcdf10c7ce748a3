/* The inverse of d -> d + slip(d) for wall forces d, mode by mode along the walls.

   One pair of walls: a force wave of eigenvalue -lambda on one wall leaves the slip kappa G psi, kappa = -2 nu/h^2, on
   both. With the potential's profile psi[0] .. psi[n-1] across the box (WallProfile) that is, in units of the force,
   -kappa lambda psi[0] on its own wall and -kappa lambda psi[n-1] on the facing one. So the modes of the two walls obey
       (1 - kappa lambda psi[0]) d_own - kappa lambda psi[n-1] d_other = r_own,
   and the same with the walls exchanged: a 2 x 2 system a mode. */
#include "fluid/wallprofile.h"
#include "fluid/walls.h"

/* All of pair dir that depends on alpha: the inverse 2 x 2 matrices, divided by the size of FFTW's transforms there and
   back. */
static void SetUpPair(Walls w, int dir) {
  const Grid g = w->fluid->grid;
  const PetscReal h2 = PetscSqr(g->h), kappa = -2 * w->fluid->nu / h2;
  const PetscInt m = w->pair[dir].length, n = g->n[dir], cells = g->n[1 - dir];
  const PetscReal size = g->wall[1 - dir] ? 2.0 * cells : m;
  WallPair *p = &w->pair[dir];
  PetscReal *force = w->work[0], *psi = w->work[1];
  for (PetscInt k = 0; k < m; k++) {
    const PetscReal argument = g->wall[1 - dir] ? PETSC_PI * (k + 1) / (2.0 * cells)
                                                : PETSC_PI * PetscMin(k, m - k) / m; /* R2HC's order */
    const PetscReal lambda = 4 / h2 * PetscSqr(PetscSinReal(argument));
    if (lambda == 0) { /* a uniform force has no slip */
      p->own[k] = 1 / size;
      p->other[k] = 0;
      continue;
    }
    WallProfile(w->fluid, n, lambda, w->work[2], force, psi);
    const PetscReal own = 1 - kappa * lambda * psi[0], other = -kappa * lambda * psi[n - 1];
    const PetscReal determinant = PetscSqr(own) - PetscSqr(other);
    p->own[k] = own / determinant / size;
    p->other[k] = -other / determinant / size;
  }
}

/* One pair's part of d: from residuals to the forces that cancel them. */
static void Invert(WallPair *p, PetscScalar d[]) {
  double *one = p->line[0], *two = p->line[1];
  for (int side = 0; side < 2; side++) {
    for (PetscInt i = 0; i < p->length; i++) p->line[side][i] = d[p->start + side * p->length + i];
    fftw_execute_r2r(p->forward, p->line[side], p->line[side]);
  }
  for (PetscInt k = 0; k < p->length; k++) {
    const PetscReal a = one[k], b = two[k];
    one[k] = p->own[k] * a + p->other[k] * b;
    two[k] = p->other[k] * a + p->own[k] * b;
  }
  for (int side = 0; side < 2; side++) {
    fftw_execute_r2r(p->backward, p->line[side], p->line[side]);
    for (PetscInt i = 0; i < p->length; i++) d[p->start + side * p->length + i] = p->line[side][i];
  }
}

PetscErrorCode WallsInvert(Walls w, PetscScalar d[]) {
  PetscFunctionBeginUser;
  if (!w->n) PetscFunctionReturn(PETSC_SUCCESS);
  for (int dir = 0; dir < 2; dir++)
    if (w->pair[dir].length && w->alpha != w->fluid->alpha) SetUpPair(w, dir);
  w->alpha = w->fluid->alpha;
  for (int dir = 0; dir < 2; dir++)
    if (w->pair[dir].length) Invert(&w->pair[dir], d);
  PetscFunctionReturn(PETSC_SUCCESS);
}
