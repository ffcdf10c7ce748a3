/* The lattice's answer of a dipole by faces that markers share, against the double sums of each pair. */
#include "world.h"
#include "coupling/dipolefaces.h"

#define MARKERS 11

/* Stencils of cbs54 and of a dipole at places on an ellipse in a plane without box. */
static void Place(PetscInt k, PaddedStencil response[2], PaddedStencil dipole[DIPOLE_COUNT]) {
  const PetscReal angle = 2 * PETSC_PI * k / MARKERS;
  const PetscReal X[2] = {3.1 + 5 * PetscCosReal(angle), -1.7 + 3 * PetscSinReal(angle + 0.4)};
  const Kernel *five = KernelFind("cbs54");
  struct _p_Grid grid = {.h = 1};
  Stencil s[DIPOLE_COUNT];
  DipoleStencilsUnwrapped(&grid, X, s);
  for (int part = 0; part < DIPOLE_COUNT; part++) StencilPad(&s[part], &dipole[part]);
  for (int c = 0; c < 2; c++) {
    for (int dir = 0; dir < 2; dir++) {
      const KernelWeights weights = c == dir ? five->along : five->across;
      s[c].n[dir] = weights(X[dir] - (c == dir ? 1 : 0.5), &s[c].first[dir], s[c].weight[dir]);
    }
    StencilPad(&s[c], &response[c]);
  }
}

static PetscErrorCode Facts(void) {
  const PetscInt cells[2] = {4, -3};
  const PetscReal N[2] = {0.3, -0.8}, scale = 2.5;
  PaddedStencil response[2 * MARKERS], dipole[MARKERS][DIPOLE_COUNT];
  PetscReal answer[4][MARKERS], *const free[4] = {answer[0], answer[1], answer[2], answer[3]}, worst = 0, most = 0;
  OffsetTable lattice[2];
  DipoleFaces faces;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < MARKERS; k++) Place(k, &response[2 * k], dipole[k]);
  PetscCall(LatticeDipoles(16 + OFFSET_LAGS, lattice));
  PetscCall(DipoleFacesCreate(MARKERS, response, &faces));
  for (PetscInt j = 0; j < MARKERS; j++) {
    DipoleFacesAnswer(&faces, lattice, dipole[j], cells, N, scale, free);
    for (PetscInt i = 0; i < MARKERS; i++) {
      PetscReal K[2][DIPOLE_COUNT], M[4];
      StencilDipoleSums(lattice, &response[2 * i], dipole[j], cells, K);
      DipoleContract((const PetscReal(*)[DIPOLE_COUNT])K, N, scale, M);
      for (int q = 0; q < 4; q++) {
        worst = PetscMax(worst, PetscAbsReal(answer[q][i] - M[q]));
        most = PetscMax(most, PetscAbsReal(M[q]));
      }
    }
  }
  CHECK(most > 0.01 && worst < 1e-14, "a dipole's field read by markers is the pairs' sums: off by %.0e of %.2f", worst,
        most);
  PetscCall(DipoleFacesDestroy(&faces));
  for (int c = 0; c < 2; c++) PetscCall(OffsetTableDestroy(&lattice[c]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Facts);
}
