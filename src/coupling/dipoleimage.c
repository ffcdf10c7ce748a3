/* As imagetable.c: in mode theta along the wall the wall adds psi(j) = (A + B j) e^{-mu j}, with A and B that make the
   velocity zero there. With D the difference from one row to the next,

     STRAIN, SOURCE: along -D psi sin, across k psi cos;      SHEAR: along D psi cos, across k psi sin,

   and of the free lattice, J rows above the dipole (sin or cos as above; D g(J) = g(J + 1) - g(J)),

     STRAIN: along k F(J), across s D g2(J);     SOURCE: along k g1(J), across -D g1(J);
     SHEAR: along -D g1(J) + 2 s D g2(J), across k (2 s g2(J) - g1(J)).

   For small k and mu that is e^{-k(a+b)}/4 times polynomials in ka and kb, a and b the distances from the wall: `lead`,
   which is the exact fluid's image, and k^2 `dispersion`, to which kernels add k^2 [-m p + ma/2 (p - 2 p_a) + mb/2 (p -
   2 p_b)], m their moments along the wall, ma and mb across. So the image is
       1/(4 pi) SUM c_pq a^p b^q n!/z^{n+1},   n = p + q (+ 2),   z = a + b - i x,
   and minus that sum of the k^2 terms is what is left of the exact one, the real part for cos, the imaginary for sin.
 */
#include "coupling/dipoleimage.h"
#include "coupling/lattice.h"

#define DEGREES 6 /* n in n!/z^{n+1}, */
#define DEGREES_EXACT 3

static PetscReal G1(const ImageMode *m, int j) {
  return m->F[j] + m->s * m->g2[j];
}

/* psi of a part in a row of cells or nodes: xx = STRAIN + SOURCE/2, yy = -STRAIN + SOURCE/2, xy = SHEAR. */
static void Psi(const ImageMode *m, DipolePart part, int j, PetscReal psi[IMAGE_LINES]) {
  const int before = j ? j - 1 : 1;
  const PetscReal strain = part == DIPOLE_XX ? m->k : -m->k;
  if (part == DIPOLE_XY)
    ImagePsi(m, G1(m, j) - 2 * m->s * m->g2[j],
             G1(m, j + 1) - G1(m, before) + 2 * m->s * (m->g2[before] - m->g2[j + 1]), psi);
  else
    ImagePsi(m, strain * (m->g2[j + 1] - m->g2[j]) + 0.5 * (G1(m, j) - G1(m, j + 1)) / m->k,
             -strain * (m->F[j + 1] + m->F[j]) - 0.5 * m->k * (G1(m, j + 1) + G1(m, j)), psi);
}

/* Add one node of the quadrature to offsets from 0 or 1 on. */
static void AddNode(PetscReal theta, PetscReal weight, DipoleImageTable *t) {
  const ImageMode m = ImageModeMake(theta);
  PetscReal cosine[IMAGE_SHIFT + 1], right[IMAGE_SHIFT + 1], left[IMAGE_SHIFT + 1], psi[IMAGE_LINES];
  for (int i = 0; i <= IMAGE_SHIFT; i++) {
    cosine[i] = weight / PETSC_PI * PetscCosReal(i * theta);
    right[i] = weight / PETSC_PI * PetscSinReal((i + 0.5) * theta);
    left[i] = weight / PETSC_PI * PetscSinReal((i - 0.5) * theta);
  }
  for (int part = 0; part < DIPOLE_COUNT; part++)
    for (int source = 0; source < IMAGE_ROWS; source++) {
      const PetscBool shear = part == DIPOLE_XY ? PETSC_TRUE : PETSC_FALSE;
      const PetscReal *wave[2] = {shear ? cosine : right, shear ? left : cosine};
      Psi(&m, (DipolePart)part, source, psi);
      for (int row = 0; row < IMAGE_ROWS; row++) {
        const PetscReal size[2] = {(shear ? 1 : -1) * (psi[row + 1] - psi[row]), m.k * psi[row]};
        for (int c = 0; c < 2; c++) {
          PetscReal *line = t->value[part][c][row][source] + IMAGE_SHIFT;
          for (int i = 0; i <= IMAGE_SHIFT; i++) line[i] += size[c] * wave[c][i];
        }
      }
    }
}

/* Offsets below zero by symmetry, and the free lattice's part: in its table the across component lies above the along
   one of the same row, a node above the cell. */
static void Complete(const OffsetTable lattice[2], DipolePart part, int c, PetscInt row, PetscInt source,
                     DipoleImageTable *t) {
  PetscReal *line = t->value[part][c][row][source] + IMAGE_SHIFT;
  const PetscInt rows = row - source - c + (part == DIPOLE_XY);
  const PetscBool even = (part == DIPOLE_XY) != c ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt i = 1; i <= IMAGE_SHIFT; i++) {
    if (even)
      line[-i] = line[i];
    else if (c)
      line[1 - i] = -line[i];
    else
      line[-i] = -line[i - 1];
  }
  const OffsetTable *free = &lattice[c];
  const PetscReal *value = free->value[part] + (rows + free->size[1]) * (2 * free->size[0] + 1) + free->size[0];
  for (PetscInt i = -IMAGE_SHIFT; i <= IMAGE_SHIFT; i++) line[i] += value[i];
}

PetscErrorCode DipoleImageFill(const OffsetTable lattice[2], DipoleImageTable *t) {
  PetscReal *theta, *weight;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(IMAGE_NODES, &theta, IMAGE_NODES, &weight));
  GaussLegendre(IMAGE_NODES, theta, weight);
  PetscCall(PetscMemzero(t, sizeof(*t)));
  for (int q = 0; q < IMAGE_NODES; q++) AddNode(theta[q], weight[q], t);
  for (int part = 0; part < DIPOLE_COUNT; part++)
    for (int c = 0; c < 2; c++)
      for (int row = 0; row < IMAGE_ROWS; row++)
        for (int source = 0; source < IMAGE_ROWS; source++) Complete(lattice, (DipolePart)part, c, row, source, t);
  PetscCall(PetscFree2(theta, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { FORM_EXACT, FORM_FAR };

/* Monomials 1, a, b, ab, aa, bb, aab, abb; `lead` has the first LEAD alone. Of SHEAR the along polynomial is -2 times
   that of STRAIN, the across one twice. */
enum { ONE, A, B, AB, AA, BB, AAB, ABB, LEAD = AA };
static const int degree[IMAGE_MONOMIALS] = {0, 1, 1, 2, 2, 2, 3, 3};
static const PetscReal lead[2][2][IMAGE_MONOMIALS] = {{{-1, 1, 1, -2}, {0, 1, -1, -2}}, {{-2, 4}, {2, 4}}};
static const PetscReal dispersion[2][2][IMAGE_MONOMIALS] = {
    {{9. / 24, -21. / 24, -21. / 24, 38. / 24, 2. / 24, 2. / 24, -4. / 24, -4. / 24},
     {-6. / 24, -19. / 24, 7. / 24, 34. / 24, 2. / 24, -2. / 24, -4. / 24, -4. / 24}},
    {{30. / 24, -56. / 24, -4. / 24, 8. / 24, 8. / 24}, {-6. / 24, -48. / 24, 4. / 24, 8. / 24, 8. / 24}}};

/* Add scale times the polynomials of STRAIN or SOURCE with kernels of second moments m along the wall in all, ma of the
   response and mb of the dipole across. */
static void AddForms(PetscReal scale, int kind, int c, PetscReal m, PetscReal ma, PetscReal mb,
                     PetscReal exact[IMAGE_MONOMIALS], PetscReal far[IMAGE_MONOMIALS]) {
  const PetscReal *p = lead[kind][c];
  for (int k = 0; k < IMAGE_MONOMIALS; k++) {
    exact[k] += scale * p[k];
    far[k] -= scale * (dispersion[kind][c][k] + 0.5 * (ma + mb - m) * p[k]);
  }
  far[ONE] += scale * (ma * p[A] + mb * p[B]);
  far[A] += scale * mb * p[AB];
  far[B] += scale * ma * p[AB];
}

void DipoleImageFormsMake(PetscReal along, PetscReal across, DipoleImageForms *f) {
  static const PetscReal moment[DIPOLE_COUNT][2] = {{6. / 12, 4. / 12}, {4. / 12, 6. / 12}, {5. / 12, 5. / 12}};
  *f = (DipoleImageForms){0};
  for (int part = 0; part < DIPOLE_COUNT; part++)
    for (int c = 0; c < 2; c++) {
      const PetscReal m = moment[part][0] + (c ? across : along), ma = c ? along : across, mb = moment[part][1];
      const PetscReal strain = part == DIPOLE_XX ? 1 : part == DIPOLE_YY ? -1 : c ? 2 : -2;
      AddForms(strain, 0, c, m, ma, mb, f->exact[part][c], f->far[part][c]);
      if (part != DIPOLE_XY) AddForms(0.5, 1, c, m, ma, mb, f->exact[part][c], f->far[part][c]);
      for (int k = 0; k < IMAGE_MONOMIALS; k++) {
        f->four[FORM_EXACT][part][c][k] = f->exact[part][c][k] + (Lanes){0};
        f->four[FORM_FAR][part][c][k] = f->far[part][c][k] + (Lanes){0};
      }
    }
}

/* Of four pairs: monomials, and n!/z^{n+1}/(4 pi), its real and its imaginary part. */
typedef struct {
  Lanes monomial[IMAGE_MONOMIALS], power[DEGREES][2];
} Terms;

static inline Terms MakeTerms(const int degrees, Lanes x, Lanes a, Lanes b) {
  const Lanes H = a + b, over = 1 / (H * H + x * x), u = H * over, v = x * over, ab = a * b;
  Terms t = {.monomial = {1 + (Lanes){0}, a, b, ab, a * a, b * b, a * ab, ab * b}};
  Lanes w[2] = {u / (4 * PETSC_PI), v / (4 * PETSC_PI)};
  for (int n = 0; n < degrees; n++) {
    t.power[n][0] = w[0];
    t.power[n][1] = w[1];
    const Lanes next = (n + 1) * (w[0] * u - w[1] * v);
    w[1] = (n + 1) * (w[0] * v + w[1] * u);
    w[0] = next;
  }
  return t;
}

/* Monomials times powers, with n from `least` on. */
static inline void MakeProducts(const int monomials, const int least, const Terms *t, Lanes term[2][IMAGE_MONOMIALS]) {
  for (int sine = 0; sine < 2; sine++)
    for (int k = 0; k < monomials; k++) term[sine][k] = t->monomial[k] * t->power[least + degree[k]][sine];
}

static inline Lanes Sum(const int monomials, const Lanes c[], const Lanes term[]) {
  Lanes sum = c[0] * term[0];
  for (int k = 1; k < monomials; k++) sum += c[k] * term[k];
  return sum;
}

/* The sums of the first of the monomials. */
static inline void Sums(const int monomials, const int least, const Lanes c[DIPOLE_COUNT][2][IMAGE_MONOMIALS],
                        const Terms *t, Lanes K[2][DIPOLE_COUNT]) {
  Lanes term[2][IMAGE_MONOMIALS];
  MakeProducts(monomials, least, t, term);
  for (int sine = 0; sine < 2; sine++)
    for (int part = 0; part < DIPOLE_COUNT; part++) {
      const int comp = part == DIPOLE_XY ? sine : 1 - sine;
      K[comp][part] = Sum(monomials, c[part][comp], term[sine]);
    }
}

void DipoleImageSourceMake(const DipoleImageForms *f, const PetscReal N[2], PetscReal factor, PetscReal over,
                           DipoleImageSource *s) {
  const PetscReal part[DIPOLE_COUNT] = {2 * N[0] * N[0], 2 * N[1] * N[1], 2 * N[0] * N[1]};
  s->forms = f;
  for (int c = 0; c < 2; c++) {
    s->N[c] = factor * N[c];
    s->unit[c] = over * N[c];
    for (int k = 0; k < LEAD; k++) {
      const Lanes both = part[DIPOLE_XX] * f->four[FORM_EXACT][DIPOLE_XX][c][k] +
                         part[DIPOLE_YY] * f->four[FORM_EXACT][DIPOLE_YY][c][k];
      s->flux[c][1 - c][k] = factor * over * both;
      s->flux[c][c][k] = factor * over * part[DIPOLE_XY] * f->four[FORM_EXACT][DIPOLE_XY][c][k];
    }
  }
}

void DipoleImageFourExact(const DipoleImageSource *s, Lanes x, Lanes a, Lanes b, Lanes M[4]) {
  const Terms t = MakeTerms(DEGREES_EXACT, x, a, b);
  Lanes K[2][DIPOLE_COUNT];
  Sums(LEAD, 0, s->forms->four[FORM_EXACT], &t, K);
  DipoleContractFour(K, s->N, M);
}

void DipoleImageFour(const DipoleImageSource *s, Lanes x, Lanes a, Lanes b, Lanes M[4], Lanes L[2]) {
  const Terms t = MakeTerms(DEGREES, x, a, b);
  Lanes K[2][DIPOLE_COUNT], term[2][IMAGE_MONOMIALS];
  Sums(IMAGE_MONOMIALS, 2, s->forms->four[FORM_FAR], &t, K);
  DipoleContractFour(K, s->N, M);
  MakeProducts(LEAD, 0, &t, term);
  for (int c = 0; c < 2; c++)
    L[c] = Sum(LEAD, s->flux[c][0], term[0]) + Sum(LEAD, s->flux[c][1], term[1]) -
           (s->unit[0] * M[c] + s->unit[1] * M[2 + c]);
}

/* One pair's numbers of a form. */
static void One(const int monomials, const int least, int form, const DipoleImageForms *f, const ImagePair *p,
                PetscReal K[2][DIPOLE_COUNT]) {
  const Terms t = MakeTerms(DEGREES, p->x + (Lanes){0}, p->a + (Lanes){0}, p->b + (Lanes){0});
  Lanes four[2][DIPOLE_COUNT];
  Sums(monomials, least, f->four[form], &t, four);
  for (int c = 0; c < 2; c++)
    for (int part = 0; part < DIPOLE_COUNT; part++) K[c][part] = four[c][part][0];
}

void DipoleImageExact(const DipoleImageForms *f, const ImagePair *p, PetscReal K[2][DIPOLE_COUNT]) {
  One(LEAD, 0, FORM_EXACT, f, p, K);
}

void DipoleImageFar(const DipoleImageForms *f, const ImagePair *p, PetscReal K[2][DIPOLE_COUNT]) {
  One(IMAGE_MONOMIALS, 2, FORM_FAR, f, p, K);
}

void DipoleImageFarFour(const DipoleImageForms *f, Lanes x, Lanes a, Lanes b, Lanes K[2][DIPOLE_COUNT]) {
  const Terms t = MakeTerms(DEGREES, x, a, b);
  Sums(IMAGE_MONOMIALS, 2, f->four[FORM_FAR], &t, K);
}
