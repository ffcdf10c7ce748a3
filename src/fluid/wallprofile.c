#include "fluid/wallprofile.h"

/* Solve T x = b by elimination. T is tridiagonal with -e beside the diagonal d, and `end` as its first and last
   diagonal entry. x may be b. */
static void SolveTridiagonal(PetscInt n, PetscReal d, PetscReal e, PetscReal end, const PetscReal b[], PetscReal work[],
                             PetscReal x[]) {
  PetscReal pivot = end;
  x[0] = b[0] / pivot;
  for (PetscInt j = 1; j < n; j++) {
    work[j] = -e / pivot;
    pivot = (j == n - 1 ? end : d) + e * work[j];
    x[j] = (b[j] + e * x[j - 1]) / pivot;
  }
  for (PetscInt j = n - 2; j >= 0; j--) x[j] -= work[j + 1] * x[j + 1];
}

/* w = (alpha + nu lambda - nu d_yy)^-1 e_0 with Dirichlet walls half a cell off, where the missing neighbour is minus
   the entry; psi = (d_yy - lambda)^-1 w with Neumann walls, where it is the entry itself. */
void WallProfile(Fluid f, PetscInt n, PetscReal lambda, PetscReal work[], PetscReal w[], PetscReal psi[]) {
  const PetscReal h2 = PetscSqr(f->grid->h), e = f->nu / h2, d = f->alpha + f->nu * lambda + 2 * e;
  for (PetscInt j = 0; j < n; j++) w[j] = 0;
  w[0] = 1;
  SolveTridiagonal(n, d, e, d + e, w, work, w);
  for (PetscInt j = 0; j < n; j++) psi[j] = -w[j];
  SolveTridiagonal(n, lambda + 2 / h2, 1 / h2, lambda + 1 / h2, psi, work, psi);
}
