/* The lattice's answer of a dipole by faces that markers share, and in closed form, against the double sums of each
   pair; dipoles by rows of a grid. */
#include "facts.h"
#include "layers/dipolefaces.h"
#include "layers/layerpairs.h"
#include "markers/dipolerows.h"

#define MARKERS 11

/* An ellipse's half axes (cells); what is added to offsets; the dipole's normal. */
typedef struct {
  PetscReal half[2];
  PetscInt cells[2];
  PetscReal N[2];
} Case;

/* Stencils of cbs54 and of a dipole at places on the ellipse in a plane without box. */
static void Place(const Case *a, PetscInt k, PaddedStencil response[2], PaddedStencil dipole[DIPOLE_COUNT],
                  PetscReal X[2]) {
  const PetscReal angle = 2 * PETSC_PI * k / MARKERS;
  const Kernel *five = KernelFind("cbs54");
  struct _p_Grid grid = {.h = 1};
  Stencil s[DIPOLE_COUNT];
  X[0] = 3.1 + a->half[0] * PetscCosReal(angle);
  X[1] = -1.7 + a->half[1] * PetscSinReal(angle + 0.4);
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

/* Every pair of the ellipse's markers, each marker with itself too. */
static void Compare(const OffsetTable lattice[2], const Case *a) {
  const PetscReal scale = 2.5;
  PaddedStencil response[2 * MARKERS], dipole[MARKERS][DIPOLE_COUNT];
  PetscReal answer[4][MARKERS], *const free[4] = {answer[0], answer[1], answer[2], answer[3]};
  PetscReal worst = 0, most = 0, X[2];
  DipoleFaces faces;
  for (PetscInt k = 0; k < MARKERS; k++) Place(a, k, &response[2 * k], dipole[k], X);
  TestCall(DipoleFacesCreate(MARKERS, response, &faces));
  for (PetscInt j = 0; j < MARKERS; j++) {
    DipoleFacesAnswer(&faces, lattice, dipole[j], a->cells, a->N, scale, free);
    for (PetscInt i = 0; i < MARKERS; i++) {
      const Lanes N[2] = {scale * a->N[0] + (Lanes){0}, scale * a->N[1] + (Lanes){0}};
      PetscReal K[2][DIPOLE_COUNT];
      Lanes part[PAIR_PARTS], M[4];
      StencilDipoleSums(lattice, &response[2 * i], dipole[j], a->cells, K);
      for (int q = 0; q < 2 * DIPOLE_COUNT; q++) part[q] = K[q / DIPOLE_COUNT][q % DIPOLE_COUNT] + (Lanes){0};
      stresslet.contract(part, N, M);
      for (int q = 0; q < 4; q++) {
        TestWorse(&worst, answer[q][i] - M[q][0]);
        TestWorse(&most, M[q][0]);
      }
    }
  }
  TestAbout("dipoles read by markers of an ellipse %g x %g, %+d, %+d cells off", a->half[0], a->half[1],
            (int)a->cells[0], (int)a->cells[1]);
  CHECK(most > 0.01, "a field of %.2f", most);
  CheckBelow(worst, 1e-14, "it is the pairs' sums");
  TestCall(DipoleFacesDestroy(&faces));
}

/* Pairs of markers across an ellipse, 0.78 to 1.18 times this apart (cells), by both. */
static void CompareFar(const OffsetTable lattice[2], PetscReal diameter, PetscReal bound) {
  const Case a = {.half = {0.5 * diameter, 0.5 * diameter}};
  PaddedStencil response[2 * MARKERS], dipole[DIPOLE_COUNT * MARKERS];
  PetscReal X[2 * MARKERS], worst = 0, most = 0;
  struct _p_Grid grid = {.h = 1};
  struct _p_Markers markers = {.grid = &grid, .X = X};
  const LayerSetting set = {.markers = &markers, .nu = 1, .unit = 1};
  struct _p_LayerPairs pairs = {
      .kernel = &stresslet, .set = &set, .lattice = lattice, .from.stencil = dipole, .stencil = response};
  for (PetscInt k = 0; k < MARKERS; k++) Place(&a, k, response + 2 * k, dipole + DIPOLE_COUNT * k, X + 2 * k);
  for (PetscInt j = 0; j < MARKERS; j++)
    for (int half = 0; half < 2; half++) {
      const PetscInt i = (j + MARKERS / 2 + half) % MARKERS;
      const PetscReal d[2] = {X[2 * i] - X[2 * j], X[2 * i + 1] - X[2 * j + 1]};
      PetscReal sum[PAIR_PARTS], form[PAIR_PARTS];
      LayerPairLattice(&pairs, 100, i, j, d, sum);
      LayerPairLattice(&pairs, 0, i, j, d, form);
      for (int k = 0; k < stresslet.places.parts; k++) {
        TestWorse(&worst, form[k] - sum[k]);
        TestWorse(&most, sum[k]);
      }
    }
  CheckBelow(worst / most, bound, "pairs about %g cells apart have the closed form", diameter);
}

#define COLUMNS 16
#define ROWS 32

/* The rows of two dipoles at these heights, into `rows`. */
static void SetRows(Grid g, const PetscReal height[2], PetscBool own, DipoleRows rows) {
  const PetscReal T[2 * DIPOLE_COUNT] = {0.7, -0.4, 0.3, -0.2, 0.9, 0.5}, none[2] = {0, 0};
  Stencil spot[2 * DIPOLE_SPOTS];
  StencilRows list;
  TestCall(PetscArrayzero(spot, 2 * DIPOLE_SPOTS));
  TestCall(DipoleListCreate(g, &list));
  for (int k = 0; k < 2; k++) DipoleSpots(g, 1, (PetscReal[]){6.3 + 2 * k, height[k]}, spot + k * DIPOLE_SPOTS);
  TestCall(StencilRowsPlace(list, 2, spot));
  TestCall(DipoleRowsSet(rows, list, T, own, NULL, none));
  TestCall(StencilRowsDestroy(&list));
}

/* Dipoles that have moved: force and velocity of all rows are those of rows that had none before. */
static void CompareRows(const PetscReal before[2], const PetscReal now[2]) {
  struct _p_Grid grid = {.h = 1,
                         .n = {COLUMNS, ROWS},
                         .wall = {PETSC_FALSE, PETSC_TRUE},
                         .columns = {COLUMNS, COLUMNS, COLUMNS},
                         .rows = {ROWS, ROWS - 1, ROWS},
                         .size = 1};
  PetscReal worst = 0, most = 0;
  DipoleRows rows[2];
  for (int k = 0; k < 2; k++) TestCall(DipoleRowsCreate(&grid, 1, &rows[k]));
  SetRows(&grid, before, PETSC_TRUE, rows[0]);
  SetRows(&grid, (PetscReal[]){before[0] + 2, before[1] - 1}, PETSC_FALSE, rows[0]);
  for (int k = 0; k < 2; k++) SetRows(&grid, now, PETSC_TRUE, rows[k]);
  for (int f = FIELD_U; f <= FIELD_V; f++)
    for (PetscInt j = 0; j < grid.rows[f]; j++) {
      PetscScalar row[2][2 * COLUMNS] = {{0}};
      for (int k = 0; k < 2; k++) {
        DipoleRowsAddForce(rows[k], (Field)f, j, row[k]);
        if (f == FIELD_U) DipoleRowsAddVelocity(rows[k], j, row[k] + COLUMNS);
      }
      for (PetscInt i = 0; i < 2 * COLUMNS; i++) {
        TestWorse(&worst, row[0][i] - row[1][i]);
        TestWorse(&most, row[1][i]);
      }
    }
  TestAbout("rows");
  CHECK(worst == 0 && most > 0.1, "dipoles moved from rows %g and %g to %g and %g leave nothing behind: %.1e of %.2f",
        before[0], before[1], now[0], now[1], worst, most);
  for (int k = 0; k < 2; k++) TestCall(DipoleRowsDestroy(&rows[k]));
}

void Facts(void) {
  const PetscReal height[4][2] = {{6.4, 25.1}, {12.2, 17.6}, {15.3, 15.8}, {9.7, 28.9}};
  const PetscReal half[4][2] = {{5, 3}, {0.2, 0.3}, {1, 6}, {7, 0.6}};
  const PetscInt cells[3][2] = {{0, 0}, {4, -3}, {-1, 5}};
  const PetscReal N[2][2] = {{0.3, -0.8}, {-1, 0}};
  OffsetTable lattice[2];
  TestCall(LatticeDipoles(24 + OFFSET_LAGS, lattice));
  for (int q = 0; q < 24; q++) {
    const Case a = {.half = {half[q / 6][0], half[q / 6][1]},
                    .cells = {cells[q / 2 % 3][0], cells[q / 2 % 3][1]},
                    .N = {N[q % 2][0], N[q % 2][1]}};
    Compare(lattice, &a);
  }
  TestAbout("far");
  CompareFar(lattice, 16, 6e-5);
  CompareFar(lattice, 24, 1e-5);
  for (int c = 0; c < 2; c++) TestCall(OffsetTableDestroy(&lattice[c]));
  for (int k = 0; k < 4; k++) CompareRows(height[k], height[(k + 1) % 4]);
}
