#include "space/throat.h"
#include "numerics/blas.h"

#define ON_MOUTH 40  /* spaces between rings on a mouth at least */
#define ON_DEPTH 12  /* spaces between rings on the depth R - R_t at least, as lengths */
#define ON_RADIUS 32 /* and on R_t: wider spaces let fluid through the wall, the more, the longer the throat is */
#define FAR 8.       /* radii beyond which flows without flux are smaller than rounding errors */
#define FEET 32      /* points of the wall to either side that its distance is measured from */
#define NEAREST 0.6  /* of a space: rings nearer to the tube are left out */
#define MOST_SPACES ((PetscInt)(NEAREST * TUBE_MOST_LENGTHS)) /* that the nodes of the tube resolve */

struct _p_Throat {
  ThroatSetting setting;
  Tube tube;         /* borrowed */
  PetscInt spaces;   /* number of equal spaces that the rings are in */
  PetscReal highest; /* wave number, and rows of T, that L was made for */
  PetscInt waves;
  PetscInt n;        /* rings */
  PetscReal *X;      /* [2][n]: x, r */
  PetscReal *arc;    /* [n] length of the wall that a ring stands for */
  PetscReal *slope;  /* [n] dR/dx */
  PetscReal *T;      /* [2n][waves] S T of the rings */
  PetscReal *L;      /* [2n][2n] */
  PetscReal *answer; /* [2n] -L^-1 u_1 */
};

/* Complete elliptic integrals of the parameter 1 - m1, by the arithmetic and geometric mean. */
static void EllipticIntegrals(PetscReal m1, PetscReal *K, PetscReal *E) {
  PetscReal a = 1, b = PetscSqrtReal(m1), sum = (1 - m1) / 2, power = 0.5;
  while (a - b > 1e-9 * a) {
    const PetscReal c = (a - b) / 2, mean = (a + b) / 2;
    b = PetscSqrtReal(a * b);
    a = mean;
    power *= 2;
    sum += power * c * c;
  }
  *K = PETSC_PI / (a + b);
  *E = *K * (1 - sum);
}

/* Velocity at a ring of radius r by a ring of radius s and force 1, d before it along x, of viscosity 1 in unbounded
   fluid: G[velocity][force], components x and r. I_mn are integrals of cos^n over the distance to the power m. */
static void RingStokeslet(PetscReal d, PetscReal r, PetscReal s, PetscReal G[2][2]) {
  const PetscReal scale = 1 / (16 * PETSC_PI * PETSC_PI), A = d * d + r * r + s * s, B = 2 * r * s,
                  least = d * d + PetscSqr(r - s), q = PetscSqrtReal(A + B);
  PetscReal K, E;
  EllipticIntegrals(least / (A + B), &K, &E);
  const PetscReal I10 = 4 * K / q, I30 = 4 * E / (q * least), I11 = (A * I10 - 4 * q * E) / B,
                  I31 = (A * I30 - I10) / B, I32 = (A * I31 - I11) / B;
  G[0][0] = scale * (I10 + d * d * I30);
  G[0][1] = scale * d * (r * I31 - s * I30);
  G[1][0] = scale * d * (r * I30 - s * I31);
  G[1][1] = scale * (I11 + (r * r + s * s) * I31 - r * s * (I30 + I32));
}

/* The mean velocity of a ring by its own force, which is spread over the length arc of a wall of this slope. */
static void RingItself(PetscReal r, PetscReal arc, PetscReal slope, PetscReal G[2][2]) {
  const PetscReal scale = 1 / (8 * PETSC_PI * PETSC_PI * r), near = PetscLogReal(16 * PETSC_PI * r / arc),
                  along = 1 / (1 + slope * slope);
  G[0][0] = scale * (near + along);
  G[0][1] = G[1][0] = scale * along * slope;
  G[1][1] = scale * (near - 3 + along * slope * slope);
}

PetscErrorCode ThroatCreate(const ThroatSetting *setting, Tube tube, Throat *out) {
  Throat t;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  *out = t;
  t->setting = *setting;
  t->tube = tube;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ThroatDestroy(Throat *throat) {
  PetscFunctionBeginUser;
  if (!*throat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3((*throat)->X, (*throat)->arc, (*throat)->slope));
  PetscCall(PetscFree3((*throat)->T, (*throat)->L, (*throat)->answer));
  PetscCall(PetscFree(*throat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* R(x), and dR/dx where slope is not NULL. */
static PetscReal ThroatRadius(Throat t, PetscReal x, PetscReal *slope) {
  const ThroatSetting *s = &t->setting;
  const PetscReal R = t->tube->setting.radius, from = x - s->center, out = PetscAbsReal(from) - s->length / 2,
                  turn = PETSC_PI * PetscClipInterval(out / s->mouth, 0, 1), half = (R - s->radius) / 2;
  if (slope) *slope = (from < 0 ? -1 : 1) * half * PETSC_PI / s->mouth * PetscSinReal(turn);
  return R - half * (1 + PetscCosReal(turn));
}

/* Half of the throat's length along x. */
static PetscReal ThroatReach(Throat t) {
  return t->setting.mouth + t->setting.length / 2;
}

/* The least distance of a point from points of the wall, which are no farther along x than the wall at the same x is
   across; negative outside. */
static PetscReal ThroatDistance(Throat t, PetscReal x, PetscReal r) {
  const PetscReal across = ThroatRadius(t, x, NULL) - r;
  PetscReal least = across;
  for (int k = -FEET; k <= FEET && across > 0; k++) {
    const PetscReal along = across * k / FEET, R = ThroatRadius(t, x + along, NULL);
    least = PetscMin(least, PetscSqrtReal(PetscSqr(along) + PetscSqr(R - r)));
  }
  return least;
}

void ThroatMeasure(Throat t, Surface s, TubeExtent *extent) {
  const PetscReal *x = s->D[HARMONIC], *r = x + s->n;
  PetscReal before = PETSC_MAX_REAL, here = ThroatDistance(t, x[0], r[0]);
  for (PetscInt i = 0; i < s->n; i++) {
    const PetscReal after = i + 1 < s->n ? ThroatDistance(t, x[i + 1], r[i + 1]) : PETSC_MAX_REAL;
    extent->film = PetscMin(extent->film, TubeLeastBetween(before, here, after));
    before = here;
    here = after;
  }
}

PetscReal ThroatLeastFilm(Throat t) {
  return 2 * ThroatReach(t) / MOST_SPACES;
}

/* Whether a body between low and high is too far away to act on the rings but by the mean flow. */
static PetscBool ThroatIsFar(Throat t, PetscReal low, PetscReal high) {
  const PetscReal reach = ThroatReach(t) + FAR * t->tube->setting.radius, x = t->setting.center;
  return (PetscBool)(low > x + reach || high < x - reach);
}

/* Rings in the middles of equal spaces along x. */
static PetscErrorCode ThroatMakeRings(Throat t, PetscInt spaces) {
  const PetscReal reach = ThroatReach(t), h = 2 * reach / (PetscReal)spaces, R = t->tube->setting.radius;
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(t->X, t->arc, t->slope));
  PetscCall(PetscMalloc3(2 * spaces, &t->X, spaces, &t->arc, spaces, &t->slope));
  t->spaces = spaces;
  t->n = 0;
  for (PetscInt i = 0; i < spaces; i++) {
    const PetscReal x = t->setting.center - reach + ((PetscReal)i + 0.5) * h, r = ThroatRadius(t, x, &t->slope[t->n]);
    if (R - r < NEAREST * h) continue;
    t->X[t->n] = x;
    t->X[spaces + t->n] = r;
    t->arc[t->n] = h * PetscSqrtReal(1 + PetscSqr(t->slope[t->n]));
    t->n++;
  }
  PetscCall(PetscArraymove(t->X + t->n, t->X + spaces, t->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K[2n][2m]: velocities at m rings Y[2][m], of viscosity 1 in unbounded fluid, by forces on n rings X[2][n]; itself:
   they are the throat's rings. */
static void ThroatStokeslets(Throat t, PetscInt n, const PetscReal X[], PetscBool itself, PetscReal K[]) {
  const PetscInt m = t->n;
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < m; i++) {
      PetscReal G[2][2];
      if (itself && i == j)
        RingItself(t->X[m + i], t->arc[i], t->slope[i], G);
      else
        RingStokeslet(t->X[i] - X[j], t->X[m + i], X[n + j], G);
      for (int f = 0; f < 2; f++)
        for (int u = 0; u < 2; u++) K[(f * n + j) * 2 * m + u * m + i] = G[u][f] / t->tube->nu;
    }
}

/* x[2n][columns], `apart` numbers from one column to the next, := L^-1 x. */
static PetscErrorCode ThroatSolve(Throat t, PetscInt columns, PetscReal x[], PetscInt apart) {
  const PetscReal one = 1;
  PetscBLASInt n, m, lda;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(2 * t->n, &n));
  PetscCall(PetscBLASIntCast(columns, &m));
  PetscCall(PetscBLASIntCast(apart, &lda));
  PetscCallBLAS("BLAStrsm", BLAStrsm_("L", "L", "N", "N", &n, &m, &one, t->L, &n, x, &lda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* T, L and answer of the rings in the tube. */
static PetscErrorCode ThroatMakeFactor(Throat t) {
  const PetscInt n = t->n, waves = t->tube->waves;
  PetscBLASInt size, info;
  PetscReal *own;
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(t->T, t->L, t->answer));
  PetscCall(PetscMalloc3(2 * n * waves, &t->T, 4 * n * n, &t->L, 2 * n, &t->answer));
  PetscCall(PetscMalloc1(2 * n * waves, &own));
  TubeRings(t->tube, n, t->X, NULL, own);
  TubeSignRows(t->tube, waves, 2 * n, 1, own, t->T);
  ThroatStokeslets(t, n, t->X, PETSC_TRUE, t->L);
  PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){t->T, waves, 2 * n, waves},
                               (DenseView){own, waves, 2 * n, waves}, 1, t->L, 2 * n));
  for (PetscInt k = 0; k < 2 * n; k++) t->answer[k] = -own[(k + 1) * waves - 1];
  PetscCall(PetscFree(own));
  PetscCall(PetscBLASIntCast(2 * n, &size));
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &size, t->L, &size, &info));
  PetscCheck(info == 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the mobility of a throat's rings is not positive definite");
  PetscCall(ThroatSolve(t, 1, t->answer, 2 * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ThroatPlace(Throat t, PetscInt p, const TubeExtent *extent) {
  const PetscReal length = 2 * ThroatReach(t), depth = t->tube->setting.radius - t->setting.radius,
                  space = PetscMin(t->setting.mouth / ON_MOUTH,
                                   PetscMin(depth / ON_DEPTH, t->setting.radius / ON_RADIUS));
  TubeExtent with_throat = *extent;
  PetscInt spaces = (PetscInt)PetscCeilReal(length / space);
  PetscFunctionBeginUser;
  while (length > extent->film * (PetscReal)spaces) spaces *= 2;
  spaces = PetscMin(spaces, MOST_SPACES);
  const PetscBool renew = (PetscBool)(spaces != t->spaces);
  if (renew) PetscCall(ThroatMakeRings(t, spaces));
  TubeExtend(t->tube, 2 * t->n, NEAREST * length / (PetscReal)spaces, length);
  with_throat.high = PetscMax(extent->high, extent->low + length + 2 * FAR * t->tube->setting.radius);
  PetscCall(TubePlace(t->tube, p, &with_throat));
  if (!renew && t->highest == t->tube->highest && t->waves == t->tube->waves) PetscFunctionReturn(PETSC_SUCCESS);
  t->highest = t->tube->highest;
  t->waves = t->tube->waves;
  PetscCall(ThroatMakeFactor(t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ThroatFactor(Throat t, const PetscReal c[], PetscReal T[], PetscReal flow[]) {
  const PetscInt rows = TubeRowCount(t->tube), more = 2 * t->n;
  const SphereTable *table = &t->tube->rings;
  const PetscInt n = table->grid.n, size = table->component[0].columns + table->component[1].columns;
  PetscReal *X, *K, *own = T + t->waves;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * n, &X, 2 * n * more, &K));
  PetscCall(SphereFieldValues(table, HARMONIC, c, X));
  const PetscBool far = ThroatIsFar(t, X[n - 1], X[0]);
  const PetscInt first = far ? t->waves - 1 : 0; /* of the tube's rows that matter: the last one is of the mean flow */
  if (far)
    PetscCall(PetscArrayzero(K, 2 * n * more));
  else
    ThroatStokeslets(t, n, X, PETSC_FALSE, K);
  PetscCall(TubeProject(t->tube, more, K, own, rows));
  PetscCall(PetscFree2(X, K));
  PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){t->T + first, t->waves - first, more, t->waves},
                               (DenseView){T + first, t->waves - first, size, rows}, 1, own, rows));
  PetscCall(ThroatSolve(t, size, own, rows));
  PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){own, more, size, rows}, (DenseView){t->answer, more, 1, more}, 0,
                               flow, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal ThroatResistance(Throat t) {
  PetscReal square = 0;
  for (PetscInt k = 0; k < 2 * t->n; k++) square += PetscSqr(t->answer[k]);
  return square;
}
