/* The stresslet: jumps of the velocity, the double layer (pairkernel.h), on the lattice tensor dipoles
   (markers/dipoles.h). As in imagetable.c, in mode theta along a wall the wall adds psi(j) = (A + B j) e^{-mu j}, with
   A and B that make the velocity zero there. With D the difference from one row to the next,

     STRAIN, SOURCE: along -D psi sin, across k psi cos;      SHEAR: along D psi cos, across k psi sin,

   and of the free lattice, J rows above the dipole (sin or cos as above; D g(J) = g(J + 1) - g(J)),

     STRAIN: along k F(J), across s D g2(J);     SOURCE: along k g1(J), across -D g1(J);
     SHEAR: along -D g1(J) + 2 s D g2(J), across k (2 s g2(J) - g1(J)).

   Expanded in theta these are the forms of imageform.h with n0 = 0: p is the exact fluid's image, and minus the orders
   above it is what is left of that. Of SHEAR the along form is -2 times that of STRAIN, the across one twice.
 */
#include "layers/latticegreen.h"
#include "layers/pairchunk.h"

static void StressletPressure(Lanes x, Lanes y, const Lanes N[2], Lanes P[2]) {
  const Lanes over = 1 / (x * x + y * y), through = 2 * over * (x * N[0] + y * N[1]);
  P[0] = (through * x - N[0]) * over / PETSC_PI;
  P[1] = (through * y - N[1]) * over / PETSC_PI;
}

/* D of a curve's markers with themselves, where the curvature kappa takes the place of 2 r.n/r^2:
       D = -(kappa/2 pi) t t w,
   from the label's derivatives: [n][3], xx, yy, xy. */
static PetscErrorCode StressletDiagonal(const LayerSetting *set, const CurveKind *kind, Spectral spectral, PetscInt n,
                                        const PetscReal X[], const PetscReal own[], PetscReal D[]) {
  PetscReal *first, *TT;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * n, &first, 2 * n, &TT));
  SpectralDerivative(spectral, 1, 1, X, first);
  SpectralDerivative(spectral, 2, 1, X, TT);
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal *T = first + 2 * k, t2 = T[0] * T[0] + T[1] * T[1];
    const PetscReal q = -(T[0] * TT[2 * k + 1] - T[1] * TT[2 * k]) / (2 * PETSC_PI * t2 * t2);
    D[3 * k] = q * T[0] * T[0];
    D[3 * k + 1] = q * T[1] * T[1];
    D[3 * k + 2] = q * T[0] * T[1];
  }
  PetscCall(PetscFree2(first, TT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of tensors T = (2 J_x N_x, 2 J_y N_y, J_x N_y + J_y N_x). */
PAIR_INLINE void StressletParts(const LayerSetting *set, Lanes x, Lanes y, Lanes part[]) {
  const Lanes one = 1 - (Lanes){0}, none = {0};
  Lanes K[2][3];
  PairFree(&stresslet, set, x, y, (const Lanes[2]){one, none}, K[0]);
  PairFree(&stresslet, set, x, y, (const Lanes[2]){none, one}, K[1]);
  for (int c = 0; c < 2; c++) {
    part[DIPOLE_COUNT * c + DIPOLE_XX] = 0.5 * K[0][c ? 2 : 0];
    part[DIPOLE_COUNT * c + DIPOLE_YY] = 0.5 * K[1][c ? 1 : 2];
    part[DIPOLE_COUNT * c + DIPOLE_XY] = K[c][2];
  }
}

PAIR_INLINE void StressletContract(const Lanes part[], const Lanes N[2], Lanes K[4]) {
  const Lanes *u = part, *v = part + DIPOLE_COUNT;
  K[0] = 2 * N[0] * u[DIPOLE_XX] + N[1] * u[DIPOLE_XY];
  K[1] = 2 * N[1] * v[DIPOLE_YY] + N[0] * v[DIPOLE_XY];
  K[2] = 2 * N[1] * u[DIPOLE_YY] + N[0] * u[DIPOLE_XY];
  K[3] = 2 * N[0] * v[DIPOLE_XX] + N[1] * v[DIPOLE_XY];
}

static void StressletSums(LayerPairs f, PetscInt i, PetscInt j, const PetscInt cells[2], PetscReal L[]) {
  const PetscReal over = 1 / f->set->markers->grid->h;
  PetscReal K[2][DIPOLE_COUNT];
  StencilDipoleSums(f->lattice, &f->stencil[2 * i], &f->from.stencil[DIPOLE_COUNT * j], cells, K);
  for (int q = 0; q < 2 * DIPOLE_COUNT; q++) L[q] = over * K[q / DIPOLE_COUNT][q % DIPOLE_COUNT];
}

/* What the lattice takes from unit tensor parts of four distant pairs, in cells: 1/(48 pi r^3) and 1/(64 pi r^5) times
   waves of the angle, smoothing by the kernels and dispersion by the lattice. */
PAIR_INLINE void StressletFar(LayerPairs f, PetscInt i, PetscInt j, PetscBool back, Lanes x, Lanes y, Lanes C[]) {
  const Lanes r2 = x * x + y * y, over = 1 / r2;
  const Lanes scale = over * over * over / (48 * PETSC_PI * f->set->markers->grid->h);
  const Lanes c2 = (x * x - y * y) * over, s2 = 2 * x * y * over; /* times scale: of 3 phi, 5 phi and 7 phi, over r^3 */
  const Lanes c3 = scale * x * (x * x - 3 * y * y), s3 = scale * y * (3 * x * x - y * y);
  const Lanes c5 = c3 * c2 - s3 * s2, s5 = s3 * c2 + c3 * s2, c7 = c5 * c2 - s5 * s2, s7 = s5 * c2 + c5 * s2;
  const Lanes next = 0.75 * over, C5 = next * c5, S5 = next * s5, C7 = next * c7, S7 = next * s7;
  const Lanes C9 = C7 * c2 - S7 * s2, S9 = S7 * c2 + C7 * s2, C11 = C9 * c2 - S9 * s2, S11 = S9 * c2 + C9 * s2;
  Lanes *u = C, *v = C + DIPOLE_COUNT;
  u[DIPOLE_XX] = (13 * c3 - 9 * c5 - 6 * c7) + (65 * C5 + 95 * C7 - 45 * C9 - 35 * C11);
  u[DIPOLE_YY] = (-17 * c3 - 3 * c5 + 6 * c7) + (23 * C5 - 115 * C7 - 15 * C9 + 35 * C11);
  u[DIPOLE_XY] = (34 * s3 - 6 * s5 - 12 * s7) + (46 * S5 + 230 * S7 - 30 * S9 - 70 * S11);
  v[DIPOLE_XX] = (17 * s3 - 3 * s5 - 6 * s7) + (23 * S5 + 115 * S7 - 15 * S9 - 35 * S11);
  v[DIPOLE_YY] = (-13 * s3 - 9 * s5 + 6 * s7) + (65 * S5 - 95 * S7 - 45 * S9 + 35 * S11);
  v[DIPOLE_XY] = (-34 * c3 - 6 * c5 + 12 * c7) + (46 * C5 - 230 * C7 - 30 * C9 + 70 * C11);
}

static PetscReal G1(const ImageMode *m, int j) {
  return m->F[j] + m->s * m->g2[j];
}

/* psi of a part in a row of cells or nodes: xx = STRAIN + SOURCE/2, yy = -STRAIN + SOURCE/2, xy = SHEAR. */
static void DipolePsi(const ImageMode *m, int part, int j, PetscReal psi[IMAGE_LINES]) {
  const int before = j ? j - 1 : 1;
  const PetscReal strain = part == DIPOLE_XX ? m->k : -m->k;
  if (part == DIPOLE_XY)
    ImagePsi(m, G1(m, j) - 2 * m->s * m->g2[j],
             G1(m, j + 1) - G1(m, before) + 2 * m->s * (m->g2[before] - m->g2[j + 1]), psi);
  else
    ImagePsi(m, strain * (m->g2[j + 1] - m->g2[j]) + 0.5 * (G1(m, j) - G1(m, j + 1)) / m->k,
             -strain * (m->F[j + 1] + m->F[j]) - 0.5 * m->k * (G1(m, j + 1) + G1(m, j)), psi);
}

/* In the lattice's table the across component lies above the along one of the same row, a node above the cell. */
static PetscErrorCode StressletImageFill(const OffsetTable lattice[2], ImageTable *t) {
  PetscFunctionBeginUser;
  for (int part = 0; part < DIPOLE_COUNT; part++)
    for (int c = 0; c < 2; c++) {
      const int shear = part == DIPOLE_XY;
      const ImageBlock block = {DipolePsi, &lattice[c], part, c, .half = 1 - shear - c, .below = c - shear};
      PetscCall(ImageBlockFill(&block, t->value[DIPOLE_COUNT * c + part]));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const PetscReal over[IMAGE_ORDERS] = {1, 24, 5760, 2903040};
static const ImageNumbers strain_form[2] = {
    {{{-1, 1, 1, -2},
      {9, -21, -21, 38, 2, 2, -4, -4},
      {-1575, 3303, 3303, -6022, -460, -460, 860, 860, 20, 20, -40, -80, -40},
      {536949, -1042929, -1042929, 1866006, 164574, 164574, -300840, -300840, -10780, -10780, 20440, 40320, 20440, 280,
       280, -560, -1680, -1680, -560}}},
    {{{0, 1, -1, -2},
      {-6, -19, 7, 34, 2, -2, -4, -4},
      {660, 2943, -663, -5342, -440, 200, 820, 780, 20, -20, -40, -80, -40},
      {-132426, -924471, 123363, 1652778, 155754, -39834, -284040, -268080, -10500, 5460, 19880, 38640, 18760, 280,
       -280, -560, -1680, -1680, -560}}}};
static const ImageNumbers source_form[2] = {
    {{{-2, 4},
      {30, -56, -4, 8, 8},
      {-4470, 7932, 720, -1360, -1320, -40, 160, 80, 80},
      {1338750, -2332584, -236916, 426456, 408816, 17640, -65520, -33600, -32480, -560, 3360, 3360, 1120, 1120}}},
    {{{2, 4},
      {-6, -48, 4, 8, 8},
      {390, 6972, -240, -1200, -1240, 40, 160, 80, 80},
      {-53046, -2060352, 35316, 376056, 383616, -7560, -62160, -30240, -31360, 560, 3360, 3360, 1120, 1120}}}};

static void StressletImageMake(const Kernel *kernel, ImageKernel *image) {
  const ImageMoments m4 = ImageMomentsOf(KernelSpline4), m5 = ImageMomentsOf(KernelSpline5),
                     m6 = ImageMomentsOf(KernelSpline6);
  const ImageMoments moment[DIPOLE_COUNT][2] = {{m6, m4}, {m4, m6}, {m5, m5}};
  *image = (ImageKernel){.moment = {ImageMomentsOf(kernel->along), ImageMomentsOf(kernel->across)}};
  for (int part = 0; part < DIPOLE_COUNT; part++)
    for (int c = 0; c < 2; c++) {
      const PetscReal strain = part == DIPOLE_XX ? 1 : part == DIPOLE_YY ? -1 : c ? 2 : -2;
      ImageForm form = {{{0}}};
      ImageFormAdd(strain, &strain_form[c], over, &form);
      if (part != DIPOLE_XY) ImageFormAdd(0.5, &source_form[c], over, &form);
      ImageFormSmooth(ImageMomentsBoth(image->moment[c], moment[part][0]), image->moment[1 - c], moment[part][1],
                      &form);
      ImageFormsPut(&form, DIPOLE_COUNT * c + part, &image->forms);
    }
}

static const ImageKind dipole = {0, 2 * DIPOLE_COUNT, {1, 1, 0, 0, 0, 1}};

PAIR_INLINE void StressletImageExact(const ImageKernel *image, Lanes x, Lanes a, Lanes b, Lanes part[]) {
  ImageTerms t;
  ImageTermsMake(0, x, a, b, &t);
  ImageSums(0, dipole, &image->forms, &t, part);
}

PAIR_INLINE void StressletImageFar(const ImageKernel *image, Lanes x, Lanes a, Lanes b, const PetscReal none[2],
                                   Lanes part[]) {
  ImageTerms t;
  ImageFarSums(dipole, &image->forms, (const Lanes[]){x, a, b}, &t, part);
}

static void StressletFill(LayerPairs f, PairChunk *c) {
  PairChunkFill(&stresslet, f, c);
}

const PairKernel stresslet = {
    .name = "stresslet",
    .sources = DIPOLE_COUNT,
    .length = -1,
    .reach = {16, 16, 30}, /* the closed form is then right to 2e-5 of D, in a box part to 2e-7 */
    .velocity = StressletFour,
    .pressure = StressletPressure,
    .parts = StressletParts,
    .contract = StressletContract,
    .diagonal = StressletDiagonal,
    .sums = StressletSums,
    .far = StressletFar,
    .fill = StressletFill,
    .places = {2 * DIPOLE_COUNT,
               {{4, 3, 5, 1, 0, 2}, {0, 1, 2, 3, 4, 5}},
               {[2] = PETSC_TRUE, [3] = PETSC_TRUE, [4] = PETSC_TRUE},
               .response = {0, 0, 0, 1, 1, 1},
               .source = {0, 1, 2, 0, 1, 2}},
    .image_make = StressletImageMake,
    .image_fill = StressletImageFill,
    .image_exact = StressletImageExact,
    .image_far = StressletImageFar,
};
