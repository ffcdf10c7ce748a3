/* The Stokeslet: forces, the single layer (pairkernel.h). Of images in a wall Blake's is the exact fluid's,

       -S(R) + 2 b^2 D - 2 b SD,      D_ij = s_j (delta_ij/R^2 - 2 R_i R_j/R^4),
       SD_ij = R_n D_ij + s_j (delta_jn R_i - delta_in R_j)/R^2,      s = (1, -1),

   R from the source's mirror image. In the half-space lattice (imagetable.c) a source t in row j' has, with
   F = g1 - s g2,

       A = -(g2(j' + 1) - g2(j')),   B = [-(F(j' + 1) + F(j'))/2 + A sinh mu]/cosh mu,

   and a source n in row j' gives n the part -s psi(j) with

       A = g2(j'),   B = [-(g2(j' + 1) - g2(j' - 1))/2 + A sinh mu]/cosh mu.

   The image of the free constant has the opposite sign, and 1/(4 theta) as the free lattice. These modes expanded in
   theta are the forms (imageform.h, n0 = -1): p is Blake's image, so what is left of it is minus the orders above. */
#include "layers/latticegreen.h"
#include "layers/pairchunk.h"
#include <petscdt.h>

static void StokesletPressure(Lanes x, Lanes y, const Lanes N[2], Lanes P[2]) {
  const Lanes over = (0.5 / PETSC_PI) / (x * x + y * y);
  P[0] = x * over;
  P[1] = y * over;
}

#define ZETA 0.0304484570583 /* -zeta'(-2) */

/* Kress' weights of ln(4 sin^2(t/2)) less that logarithm, which is left out at 0. The trapezoidal rule takes the rest,
   ln(r^2) - ln(4 sin^2(t/2)), which is smooth (docs/nearfield.md, Pairs of markers). */
static void ClosedLogarithm(PetscInt n, PetscReal own[]) {
  for (PetscInt d = 0; d < n; d++) {
    own[d] = 0;
    for (PetscInt m = 1; m <= (n - 1) / 2; m++) own[d] -= 2 * PetscCosReal(2 * PETSC_PI * ((m * d) % n) / n) / m;
    if (n % 2 == 0) own[d] -= (d % 2 ? -2.0 : 2.0) / n;
    if (d) own[d] -= PetscLogReal(4 * PetscSqr(PetscSinReal(PETSC_PI * d / n)));
  }
}

/* The quadrature of an open curve: the trapezoidal rule with three corrected weights, ln(2 pi/ds) - 2 ZETA on the
   diagonal, ZETA beside it. There are no corrections at the ends, where the force fades. */
static void OpenLogarithm(PetscInt n, PetscReal own[]) {
  (void)PetscArrayzero(own, n);
  own[0] = 4 * ZETA;
  own[1] = -2 * ZETA;
}

/* As parts of S, -ln(r^2)/(8 pi). */
static void StokesletLogarithm(CurveType type, PetscInt n, PetscReal own[]) {
  (type == CURVE_OPEN ? OpenLogarithm : ClosedLogarithm)(n, own);
  for (PetscInt k = 0; k < n; k++) own[k] *= -1 / (8 * PETSC_PI);
}

/* The derivative takes the place of the difference: by the parameter 2 pi k/n, on an open curve by 2 pi k. */
static PetscErrorCode StokesletDiagonal(const LayerSetting *set, const CurveKind *kind, Spectral spectral, PetscInt n,
                                        const PetscReal X[], const PetscReal own[], PetscReal S[]) {
  const PetscReal slope = (kind->type == CURVE_OPEN ? 1 : n) / (2 * PETSC_PI);
  PetscReal *T;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, &T));
  PetscCall(CurveTangents(kind, spectral, n, X, T));
  for (PetscInt k = 0; k < n; k++)
    StokesletOne(set, (PetscReal[]){slope * T[2 * k], slope * T[2 * k + 1]}, own[0], S + 3 * k);
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PAIR_INLINE void StokesletParts(const LayerSetting *set, Lanes x, Lanes y, Lanes part[]) {
  Lanes S[3];
  PairFree(&stokeslet, set, x, y, (const Lanes[2]){{0}, {0}}, S);
  for (int q = 0; q < 4; q++) part[q] = S[PetscMin(q, 2)];
}

PAIR_INLINE void StokesletContract(const Lanes part[], const Lanes N[2], Lanes K[4]) {
  for (int q = 0; q < 4; q++) K[q] = part[q];
}

/* The closed form of distant pairs, and the quadrature of the own bodies. */
static PetscErrorCode StokesletCreate(LayerPairs f) {
  const Layout l = f->set->markers->layout;
  PetscFunctionBeginUser;
  NearFarMake(f->set->markers->kernel, &f->far);
  for (int c = 0; c < 4; c++) PetscCall(PetscCalloc1(l->M + LANES, &f->fourth[c / 2][c % 2]));
  PetscCall(PetscCalloc1(l->bodies, &f->logarithm));
  for (PetscInt v = l->own; v < l->end && f->set->bodies; v++) {
    PetscCall(PetscMalloc1(LayoutCount(l, v), &f->logarithm[v]));
    StokesletLogarithm(f->set->bodies->kind[v].type, LayoutCount(l, v), f->logarithm[v]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void StokesletPlace(LayerPairs f) {
  for (PetscInt k = 0; k < f->set->markers->layout->M; k++)
    for (int c = 0; c < 4; c++)
      f->fourth[c / 2][c % 2][k] = f->stencil[2 * k + c / 2].fourth[c % 2] - f->far.fourth[c / 2 != c % 2];
}

static void StokesletSums(LayerPairs f, PetscInt i, PetscInt j, const PetscInt cells[2], PetscReal L[]) {
  StencilFourSums(f->lattice, &f->stencil[2 * i], &f->stencil[2 * j], cells, L);
  for (int c = 0; c < 4; c++) L[c] = (L[c] - (c < 2 ? f->image->logarithm : 0)) / f->set->nu;
}

/* With the fourth moments by which the stencils that meet in xx, yy, xy, yx are above the mean. */
PAIR_INLINE void StokesletFar(LayerPairs f, PetscInt i, PetscInt j, PetscBool back, Lanes x, Lanes y, Lanes C[]) {
  static const int respond[4] = {0, 1, 0, 1}, source[4] = {0, 1, 1, 0};
  Lanes fourth[4][2];
  for (int q = 0; q < 4; q++)
    for (int dir = 0; dir < 2; dir++) {
      const int row = back ? source[q] : respond[q], column = back ? respond[q] : source[q];
      fourth[q][dir] = f->fourth[row][dir][i] + LanesAt(f->fourth[column][dir] + j);
    }
  NearFarPairs(&f->far, 1 / f->set->nu, x, y, fourth, C);
}

/* psi of a force in row j: t (OFFSET_UU and OFFSET_VU) or n, whose parts are those of -k psi. */
static void StokesletPsi(const ImageMode *m, int source, int j, PetscReal psi[IMAGE_LINES]) {
  const PetscReal before = m->g2[j > 0 ? j - 1 : 1];
  if (source == OFFSET_VV)
    ImagePsi(m, -m->k * m->g2[j], -m->k * (m->g2[j + 1] - before), psi);
  else
    ImagePsi(m, m->g2[j] - m->g2[j + 1], m->F[j + 1] + m->F[j], psi);
}

/* The quadrature's part that is the same everywhere goes with the constants. t from n is n from t, exchanged. */
static PetscErrorCode StokesletImageFill(const OffsetTable *lattice, ImageTable *t) {
  PetscReal theta[IMAGE_NODES], weight[IMAGE_NODES], level = -LatticeConstant();
  PetscFunctionBeginUser;
  PetscCall(PetscDTGaussQuadrature(IMAGE_NODES, 0, PETSC_PI, theta, weight));
  for (int q = 0; q < IMAGE_NODES; q++) level += weight[q] / (4 * PETSC_PI * theta[q]);
  const ImageBlock block[OFFSET_COUNT] = {
      [OFFSET_UU] = {StokesletPsi, lattice, OFFSET_UU, .level = level},
      [OFFSET_VV] = {StokesletPsi, lattice, OFFSET_VV, .component = 1, .level = 1 / (4 * PETSC_PI) + level},
      [OFFSET_VU] = {StokesletPsi, lattice, OFFSET_VU, .component = 1, .half = -1, .below = 1}};
  for (int b = 0; b < OFFSET_COUNT; b++) PetscCall(ImageBlockFill(&block[b], t->value[b]));
  for (int row = 0; row < IMAGE_ROWS; row++)
    for (int source = 0; source < IMAGE_ROWS; source++)
      for (int i = 0; i < IMAGE_WIDTH; i++)
        t->value[IMAGE_TN][row][source][i] = t->value[IMAGE_NT][source][row][IMAGE_WIDTH - 1 - i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const PetscReal over[IMAGE_ORDERS] = {1, 12, 1440, 362880};
static const ImageNumbers lattice[3] = {
    {{{-1, 1, 1, -2},
      {4, -10, -10, 18, 1, 1, -2, -2},
      {-373, 775, 775, -1414, -110, -110, 205, 205, 5, 5, -10, -20, -10},
      {63138, -122070, -122070, 218118, 19401, 19401, -35421, -35421, -1295, -1295, 2450, 4830, 2450, 35, 35, -70, -210,
       -210, -70}}},
    {{{-1, -1, -1, -2},
      {-2, 2, 2, 14, -1, -1, -2, -2},
      {107, -125, -125, -1114, 40, 40, 175, 175, -5, -5, -10, -20, -10},
      {-12084, 11868, 11868, 171174, -4071, -4071, -29751, -29751, 595, 595, 2170, 4410, 2170, -35, -35, -70, -210,
       -210, -70}}},
    {{{0, -1, 1, 2},
      {3, 9, -3, -16, -1, 1, 2, 2},
      {-150, -690, 150, 1254, 105, -45, -195, -185, -5, 5, 10, 20, 10},
      {14931, 108171, -13797, -193176, -18351, 4491, 33426, 31536, 1260, -630, -2380, -4620, -2240, -35, 35, 70, 210,
       210, 70}}},
};

/* Components along the wall have the moments along it that they have along themselves, and across it those across
   themselves; normal ones the other way round, and these have no other moments next to the wall. */
static void StokesletImageMake(const Kernel *kernel, ImageKernel *image) {
  static const int mirror[IMAGE_MONOMIALS] = {0, 2, 1, 3, 5, 4, 7, 6, 9, 8, 12, 11, 10, 14, 13, 18, 17, 16, 15};
  static const PetscBool tangential[2][IMAGE_PARTS] = {{[IMAGE_TT] = PETSC_TRUE, [IMAGE_TN] = PETSC_TRUE},
                                                       {[IMAGE_TT] = PETSC_TRUE, [IMAGE_NT] = PETSC_TRUE}};
  const ImageMoments t = ImageMomentsOf(kernel->along), n = ImageMomentsOf(kernel->across);
  ImageForm form[IMAGE_PARTS] = {{{{0}}}};
  *image = (ImageKernel){.moment = {t, n}};
  for (int part = 0; part < IMAGE_TN; part++) ImageFormAdd(1, &lattice[part], over, &form[part]);
  for (int m = 0; m < IMAGE_ORDERS; m++) /* t from n is n from t with a and b exchanged, and x turned */
    for (int k = 0; k < image_monomials[m]; k++) form[IMAGE_TN].c[m][k] = -form[IMAGE_NT].c[m][mirror[k]];
  for (int part = 0; part < IMAGE_PARTS; part++) {
    const PetscBool to = tangential[0][part], from = tangential[1][part];
    for (int end = 0; end < 2; end++) {
      const ImageForm bend = ImageFormBend(&form[part], end);
      if (tangential[end][part]) ImageFormsPut(&bend, part, &image->bend[end]);
    }
    ImageFormSmooth(ImageMomentsBoth(to ? t : n, from ? t : n), to ? n : t, from ? n : t, &form[part]);
    ImageFormsPut(&form[part], part, &image->forms);
  }
}

PAIR_INLINE void StokesletImageExact(const ImageKernel *none, Lanes x, Lanes a, Lanes b, Lanes image[]) {
  static const int place[2][2] = {{IMAGE_TT, IMAGE_TN}, {IMAGE_NT, IMAGE_NN}};
  const Lanes R[2] = {x, a + b}, r2 = R[0] * R[0] + R[1] * R[1];
  Lanes S[3];
  StokesletFour(R[0], R[1], R, S);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      const PetscReal s = j ? -1 : 1;
      const Lanes D = s * ((i == j) / r2 - 2 * R[i] * R[j] / (r2 * r2));
      const Lanes SD = R[1] * D + s * (j * R[i] - i * R[j]) / r2;
      image[place[i][j]] = (b * b * D - b * SD) / (2 * PETSC_PI) - S[i == j ? i : 2];
    }
}

static const ImageKind force = {-1, IMAGE_PARTS, {[IMAGE_NT] = 1, [IMAGE_TN] = 1}};

PAIR_INLINE void StokesletImageFar(const ImageKernel *image, Lanes x, Lanes a, Lanes b, const PetscReal more[2],
                                   Lanes part[]) {
  ImageTerms t;
  Lanes bend[IMAGE_PARTS];
  ImageFarSums(force, &image->forms, (const Lanes[]){x, a, b}, &t, part);
  for (int end = 0; end < 2 && more; end++) {
    if (more[end] == 0) continue;
    ImageSums(1, force, &image->bend[end], &t, bend);
    for (int q = 0; q < IMAGE_PARTS; q++) part[q] += more[end] * bend[q];
  }
}

static void StokesletFill(LayerPairs f, PairChunk *c) {
  PairChunkFill(&stokeslet, f, c);
}

const PairKernel stokeslet = {
    .name = "stokeslet",
    .sources = 2,
    .viscosity = -1,
    .level = 1 / (4 * PETSC_PI),
    .symmetric = PETSC_TRUE,
    .reach = {[NEAR_ONE] = 12, [NEAR_TWO] = 10, [NEAR_BOX] = 12},
    .velocity = StokesletFour,
    .pressure = StokesletPressure,
    .parts = StokesletParts,
    .contract = StokesletContract,
    .logarithm = StokesletLogarithm,
    .diagonal = StokesletDiagonal,
    .create = StokesletCreate,
    .place = StokesletPlace,
    .sums = StokesletSums,
    .far = StokesletFar,
    .fill = StokesletFill,
    .places = {IMAGE_PARTS,
               {{1, 0, 2, 3}, {0, 1, 3, 2}},
               {[IMAGE_NT] = PETSC_TRUE, [IMAGE_TN] = PETSC_TRUE},
               .response = {[IMAGE_NN] = 1, [IMAGE_NT] = 1},
               .source = {[IMAGE_NN] = 1, [IMAGE_TN] = 1}},
    .image_make = StokesletImageMake,
    .image_fill = StokesletImageFill,
    .image_exact = StokesletImageExact,
    .image_far = StokesletImageFar,
};
