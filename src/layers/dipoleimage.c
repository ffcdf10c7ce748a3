/* As imagetable.c: in mode theta along the wall the wall adds psi(j) = (A + B j) e^{-mu j}, with A and B that make the
   velocity zero there. With D the difference from one row to the next,

     STRAIN, SOURCE: along -D psi sin, across k psi cos;      SHEAR: along D psi cos, across k psi sin,

   and of the free lattice, J rows above the dipole (sin or cos as above; D g(J) = g(J + 1) - g(J)),

     STRAIN: along k F(J), across s D g2(J);     SOURCE: along k g1(J), across -D g1(J);
     SHEAR: along -D g1(J) + 2 s D g2(J), across k (2 s g2(J) - g1(J)).

   Expanded in theta these are the forms of imageform.h with n0 = 0: p is the exact fluid's image, and minus the orders
   above it is what is left of that. Of SHEAR the along form is -2 times that of STRAIN, the across one twice.
 */
#include "layers/dipoleimage.h"

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
PetscErrorCode DipoleImageFill(const OffsetTable lattice[2], DipoleImageTable *t) {
  PetscFunctionBeginUser;
  for (int part = 0; part < DIPOLE_COUNT; part++)
    for (int c = 0; c < 2; c++) {
      const int shear = part == DIPOLE_XY;
      const ImageBlock block = {DipolePsi, &lattice[c], part, c, .half = 1 - shear - c, .below = c - shear};
      PetscCall(ImageBlockFill(&block, t->value[part][c]));
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

void DipoleImageFormsMake(const ImageMoments kernel[2], ImageForms *f) {
  const ImageMoments m4 = ImageMomentsOf(KernelSpline4), m5 = ImageMomentsOf(KernelSpline5),
                     m6 = ImageMomentsOf(KernelSpline6);
  const ImageMoments moment[DIPOLE_COUNT][2] = {{m6, m4}, {m4, m6}, {m5, m5}};
  *f = (ImageForms){0};
  for (int part = 0; part < DIPOLE_COUNT; part++)
    for (int c = 0; c < 2; c++) {
      const PetscReal strain = part == DIPOLE_XX ? 1 : part == DIPOLE_YY ? -1 : c ? 2 : -2;
      ImageForm form = {{{0}}};
      ImageFormAdd(strain, &strain_form[c], over, &form);
      if (part != DIPOLE_XY) ImageFormAdd(0.5, &source_form[c], over, &form);
      ImageFormSmooth(ImageMomentsBoth(kernel[c], moment[part][0]), kernel[1 - c], moment[part][1], &form);
      ImageFormsPut(&form, DIPOLE_COUNT * c + part, f);
    }
}

static const ImageKind dipole = {0, 2 * DIPOLE_COUNT, {1, 1, 0, 0, 0, 1}};

void DipoleImageSourceMake(const ImageForms *f, const PetscReal N[2], PetscReal factor, PetscReal over_length,
                           DipoleImageSource *s) {
  const PetscReal part[DIPOLE_COUNT] = {2 * N[0] * N[0], 2 * N[1] * N[1], 2 * N[0] * N[1]};
  s->forms = f;
  for (int c = 0; c < 2; c++) {
    const Lanes(*own)[IMAGE_MONOMIALS] = f->c[0] + DIPOLE_COUNT * c;
    s->N[c] = factor * N[c];
    s->unit[c] = over_length * N[c];
    for (int k = 0; k < image_monomials[0]; k++) {
      const Lanes both = part[DIPOLE_XX] * own[DIPOLE_XX][k] + part[DIPOLE_YY] * own[DIPOLE_YY][k];
      s->flux[c][1 - c][k] = factor * over_length * both;
      s->flux[c][c][k] = factor * over_length * part[DIPOLE_XY] * own[DIPOLE_XY][k];
    }
  }
}

void DipoleImageFourExact(const DipoleImageSource *s, Lanes x, Lanes a, Lanes b, Lanes M[4]) {
  ImageTerms t;
  ImageTermsMake(0, x, a, b, &t);
  Lanes K[2][DIPOLE_COUNT];
  ImageSums(0, dipole, s->forms, &t, (Lanes *)K);
  DipoleContractFour(K, s->N, M);
}

void DipoleImageFour(const DipoleImageSource *s, Lanes x, Lanes a, Lanes b, Lanes M[4], Lanes L[2]) {
  ImageTerms t;
  Lanes K[2][DIPOLE_COUNT], term[2][IMAGE_MONOMIALS];
  ImageFarSums(dipole, s->forms, (const Lanes[]){x, a, b}, &t, (Lanes *)K);
  DipoleContractFour(K, s->N, M);
  for (int sine = 0; sine < 2; sine++) ImageProducts(0, 0, sine, &t, term[sine]);
  for (int c = 0; c < 2; c++)
    L[c] = ImageSumOf(0, s->flux[c][0], term[0]) + ImageSumOf(0, s->flux[c][1], term[1]) -
           (s->unit[0] * M[c] + s->unit[1] * M[2 + c]);
}

/* The first of four pairs. */
static void FirstOf(const Lanes four[], PetscReal K[2][DIPOLE_COUNT]) {
  for (int k = 0; k < 2 * DIPOLE_COUNT; k++) K[k / DIPOLE_COUNT][k % DIPOLE_COUNT] = four[k][0];
}

void DipoleImageExact(const ImageForms *f, const ImagePair *p, PetscReal K[2][DIPOLE_COUNT]) {
  ImageTerms t;
  ImageTermsMake(0, p->x + (Lanes){0}, p->a + (Lanes){0}, p->b + (Lanes){0}, &t);
  Lanes four[2 * DIPOLE_COUNT];
  ImageSums(0, dipole, f, &t, four);
  FirstOf(four, K);
}

void DipoleImageFar(const ImageForms *f, const ImagePair *p, PetscReal K[2][DIPOLE_COUNT]) {
  const Lanes x = p->x + (Lanes){0}, a = p->a + (Lanes){0}, b = p->b + (Lanes){0};
  ImageTerms t;
  Lanes four[2 * DIPOLE_COUNT];
  ImageFarSums(dipole, f, (const Lanes[]){x, a, b}, &t, four);
  FirstOf(four, K);
}
