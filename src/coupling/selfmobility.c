#include "coupling/selfmobility.h"
#include "coupling/blas.h"

/* a0 h^2/nu that stands for steady flow: small, and resolved by the quadrature of the symbols. */
#define STEADY 1e-4

/* Of a solution with R, and how often it is refined at most; two are usual. */
#define ROUND_OFF 1e-15
#define MAX_REFINEMENTS 20

typedef struct {
  PetscInt n;
  PetscReal *T[3], *N[3]; /* [n] circulants over ds by index difference: common to all angles, more along diagonals
                             (times sin 2 alpha left and right), more along grid lines (times cos 2 alpha) */
  PetscReal *X;           /* [n] the same of dX, times sin 4 alpha */
  PetscReal *K;           /* [n] circulant of ds D4, inverse where it is not zero; its mean stands for the zero */
  PetscReal *Theta;       /* [2n][2n] */
  PetscReal *force;       /* [2n][2n] Cholesky factor of Theta + (a0/c_b) (ds D4)^-1 on the forces of mean zero */
  PetscReal *work, *second, *given, *change; /* [2n] */
} Block;

struct _p_SelfMobility {
  Markers markers;
  Membrane membrane;
  SelfMobilityType type;
  PetscReal nu, a0;
  PetscReal c;        /* long waves' constant along grid lines, mean over sub-cell positions */
  Block *block;       /* [own vesicles] */
  PetscScalar *force; /* [2 own markers] work */
};

static Block *OwnBlock(SelfMobility s, PetscInt v) {
  return &s->block[v - s->membrane->layout->own];
}

/* Circulant of the even symbol[n]: its inverse transform. */
static void Circulant(PetscInt n, const PetscReal symbol[], PetscReal circulant[]) {
  for (PetscInt k = 0; k < n; k++) {
    circulant[k] = 0;
    for (PetscInt q = 0; q < n; q++) circulant[k] += symbol[q] * PetscCosReal(2 * PETSC_PI * ((k * q) % n) / n) / n;
  }
}

/* Circulants of a symbol over ds that goes from line[n] to diagonal[n] like sin^2 2 alpha: what both have and what
   either has more, none of them negative. */
static void ByAngle(PetscInt n, PetscReal ds, const PetscReal line[], const PetscReal diagonal[], PetscReal part[],
                    PetscReal *const circulant[3]) {
  for (int p = 0; p < 3; p++) {
    for (PetscInt q = 0; q < n; q++) {
      const PetscReal common = PetscMin(line[q], diagonal[q]);
      part[q] = (p == 0 ? common : (p == 1 ? diagonal[q] : line[q]) - common) / ds;
    }
    Circulant(n, part, circulant[p]);
  }
}

/* T and N of one vesicle. The symbols are those of steady flow (a0 far below nu/h^2) whatever the step: what a slowly
   varying force loses over all steps, not in one. With the step's own a0 the correction fades as dt falls
   (docs/accuracy.md). */
static PetscErrorCode MobilityCirculants(SelfMobility s, PetscInt v) {
  Block *b = OwnBlock(s, v);
  const Kernel *kernel = s->markers->kernel;
  const PetscInt n = b->n;
  const PetscReal h = s->markers->grid->h, a0 = STEADY * s->nu / PetscSqr(h), ds = s->membrane->ds[v];
  PetscReal *dT[3], *dN[3], *dX[3], *part, c[2], least = PETSC_MAX_REAL;
  PetscFunctionBeginUser;
  PetscCall(SmoothingConstants(kernel, c));
  s->c = c[0];
  if (s->type == SELF_LOCAL) {
    b->T[0][0] = PetscMin(c[0], c[1]) * h / (s->nu * ds);
    b->T[1][0] = PetscMax(c[1] - c[0], 0) * h / (s->nu * ds);
    b->T[2][0] = PetscMax(c[0] - c[1], 0) * h / (s->nu * ds);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(n, &part));
  for (int d = 0; d < 3; d++) { /* angles 0, pi/4, pi/8 */
    static const PetscReal angle[3] = {0, PETSC_PI / 4, PETSC_PI / 8};
    PetscCall(PetscMalloc3(n, &dT[d], n, &dN[d], n, &dX[d]));
    PetscCall(PlaneSymbols(kernel, h, a0, s->nu, angle[d], n, ds * n, dT[d], dN[d], dX[d]));
  }
  ByAngle(n, ds, dT[0], dT[1], part, b->T);
  ByAngle(n, ds, dN[0], dN[1], part, b->N);
  /* kept so small beside dT and dN that Theta stays non-negative: only next to wave 0 does it matter */
  for (PetscInt q = 0; q < n; q++) least = PetscMin(least, PetscMin(dT[0][q], dT[1][q]));
  for (PetscInt q = 0; q < n; q++) {
    const PetscReal most = 0.5 * PetscSqrtReal(least * PetscMin(dN[0][q], dN[1][q]));
    part[q] = PetscMax(-most, PetscMin(most, dX[2][q])) / ds;
  }
  Circulant(n, part, b->X);
  for (int d = 0; d < 3; d++) PetscCall(PetscFree3(dT[d], dN[d], dX[d]));
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K of one vesicle: the symbol of ds D4 from its action on one marker; the mean, which it takes to zero, gets the
   inverse of the longest wave. */
static void BendingCirculant(SelfMobility s, PetscInt v) {
  Block *b = OwnBlock(s, v);
  const PetscInt n = b->n;
  PetscReal *impulse = b->given, *column = b->change;
  (void)PetscArrayzero(impulse, 2 * n);
  (void)PetscArrayzero(column, 2 * n);
  impulse[0] = 1;
  MembraneVesicleBending(s->membrane, v, 1, impulse, column);
  for (PetscInt q = 0; q < n; q++) { /* n times the column's transform */
    impulse[q] = 0;
    for (PetscInt k = 0; k < n; k++) impulse[q] += column[2 * k] * PetscCosReal(2 * PETSC_PI * ((k * q) % n) / n);
  }
  for (PetscInt q = 1; q < n; q++) impulse[q] = 1 / impulse[q];
  impulse[0] = impulse[1];
  Circulant(n, impulse, b->K);
}

PetscErrorCode SelfMobilityCreate(Markers markers, Membrane m, PetscReal nu, SelfMobilityType type, SelfMobility *out) {
  const Layout l = m->layout;
  SelfMobility s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->markers = markers;
  s->membrane = m;
  s->type = type;
  s->nu = nu;
  PetscCall(PetscCalloc1(l->end - l->own, &s->block));
  PetscCall(PetscMalloc1(2 * l->n, &s->force));
  for (PetscInt v = l->own; v < l->end; v++) {
    Block *b = OwnBlock(s, v);
    const PetscInt n = b->n = LayoutCount(l, v);
    for (int p = 0; p < 3; p++) PetscCall(PetscCalloc2(n, &b->T[p], n, &b->N[p]));
    PetscCall(PetscCalloc4(n, &b->X, n, &b->K, 4 * n * n, &b->Theta, 4 * n * n, &b->force));
    PetscCall(PetscCalloc4(2 * n, &b->work, 2 * n, &b->second, 2 * n, &b->given, 2 * n, &b->change));
    PetscCall(MobilityCirculants(s, v));
    if (m->bending > 0) BendingCirculant(s, v);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SelfMobilityDestroy(SelfMobility *self) {
  SelfMobility s = *self;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = s->membrane->layout->own; v < s->membrane->layout->end; v++) {
    Block *b = OwnBlock(s, v);
    for (int p = 0; p < 3; p++) PetscCall(PetscFree2(b->T[p], b->N[p]));
    PetscCall(PetscFree4(b->X, b->K, b->Theta, b->force));
    PetscCall(PetscFree4(b->work, b->second, b->given, b->change));
  }
  PetscCall(PetscFree(s->block));
  PetscCall(PetscFree(s->force));
  PetscCall(PetscFree(*self));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const PetscReal *SelfMobilityBlock(SelfMobility s, PetscInt v) {
  return OwnBlock(s, v)->Theta;
}

/* Unit tangents: of the spectral edges, or by fourth-order differences (with chords the area would drift ten
   times faster). */
static void Tangents(SelfMobility s, PetscInt v, const PetscScalar x[], PetscReal t[]) {
  const Membrane m = s->membrane;
  const PetscInt n = LayoutCount(m->layout, v);
  if (m->derivative == DERIVATIVE_SPECTRAL) MembraneEdges(m, v, x, t);
  for (PetscInt k = 0; k < n; k++) {
    PetscReal *tk = t + 2 * k, length;
    if (m->derivative != DERIVATIVE_SPECTRAL)
      for (int c = 0; c < 2; c++)
        tk[c] = 8 * (x[2 * ((k + 1) % n) + c] - x[2 * ((k + n - 1) % n) + c]) -
                (x[2 * ((k + 2) % n) + c] - x[2 * ((k + n - 2) % n) + c]);
    length = PetscSqrtReal(tk[0] * tk[0] + tk[1] * tk[1]);
    tk[0] /= length;
    tk[1] /= length;
  }
}

/* Root of c where a marker is in its cells over the mean c. Where the membrane follows a grid line, all markers of a
   stretch are at one place across it; elsewhere the places change from marker to marker and this averages out. */
static PetscReal SubCell(SelfMobility s, PetscInt marker, const PetscReal t[2]) {
  PetscReal sum = 0;
  for (int comp = 0; comp < 2; comp++) { /* along x the membrane moves u and lies across y */
    const Stencil *at = &s->markers->stencil[2 * marker + comp];
    sum += PetscSqr(PetscSqr(t[comp])) * (SmoothingSum(at->n[1 - comp], at->weight[1 - comp]) / s->c - 1);
  }
  return PetscSqrtReal(1 + sum);
}

/* sin 4 alpha from sin 2 alpha and cos 2 alpha. */
static PetscReal SinFour(const PetscReal turn[2]) {
  return 2 * turn[0] * turn[1];
}

static void FillTheta(SelfMobility s, PetscInt v, const PetscReal t[], PetscReal turn[]) {
  Block *b = OwnBlock(s, v);
  const PetscInt n = b->n;
  PetscReal *root = b->change;
  for (PetscInt k = 0; k < n; k++) root[k] = SubCell(s, s->membrane->layout->start[v] + k, t + 2 * k);
  for (PetscInt k = 0; k < n; k++) { /* sin and cos of twice the angle */
    turn[2 * k] = 2 * t[2 * k] * t[2 * k + 1];
    turn[2 * k + 1] = PetscSqr(t[2 * k]) - PetscSqr(t[2 * k + 1]);
  }
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt l = 0; l < n; l++) {
      if (s->type == SELF_LOCAL && k != l) continue;
      const PetscInt d = k >= l ? k - l : k - l + n;
      const PetscReal *tk = t + 2 * k, *tl = t + 2 * l;
      const PetscReal diagonal = turn[2 * k] * turn[2 * l], line = turn[2 * k + 1] * turn[2 * l + 1];
      const PetscReal T = root[k] * root[l] * (b->T[0][d] + diagonal * b->T[1][d] + line * b->T[2][d]);
      const PetscReal N = b->N[0][d] + diagonal * b->N[1][d] + line * b->N[2][d];
      PetscReal *block = b->Theta + 2 * k * 2 * n + 2 * l;
      /* velocity along the tangent at k from a force along the normal at l, and the other way round */
      const PetscReal tn = SinFour(turn + 2 * k) * b->X[d], nt = SinFour(turn + 2 * l) * b->X[d];
      block[0] = T * tk[0] * tl[0] + N * tk[1] * tl[1] - tn * tk[0] * tl[1] - nt * tk[1] * tl[0];
      block[1] = T * tk[0] * tl[1] - N * tk[1] * tl[0] + tn * tk[0] * tl[0] - nt * tk[1] * tl[1];
      block[2 * n] = T * tk[1] * tl[0] - N * tk[0] * tl[1] - tn * tk[1] * tl[1] + nt * tk[0] * tl[0];
      block[2 * n + 1] = T * tk[1] * tl[1] + N * tk[0] * tl[0] + tn * tk[1] * tl[0] + nt * tk[0] * tl[1];
    }
}

/* Theta := P Theta P, P = I - n n^T/M for the normals n: no flux through the membrane. A symbol has none (dN is zero
   for wave 0), but going between two of them with the angle lets one in, and a stiff membrane's pressure drives it. */
static void TakeOffFlux(Block *b, const PetscReal t[], PetscReal normal[], PetscReal moved[]) {
  const PetscInt n = 2 * b->n;
  PetscReal mean = 0;
  for (PetscInt k = 0; k < n; k += 2) {
    normal[k] = t[k + 1] / PetscSqrtReal(b->n);
    normal[k + 1] = -t[k] / PetscSqrtReal(b->n);
  }
  for (PetscInt k = 0; k < n; k++) {
    moved[k] = 0;
    for (PetscInt l = 0; l < n; l++) moved[k] += b->Theta[k * n + l] * normal[l];
    mean += normal[k] * moved[k];
  }
  for (PetscInt k = 0; k < n; k++) moved[k] -= 0.5 * mean * normal[k];
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt l = 0; l < n; l++) b->Theta[k * n + l] -= moved[k] * normal[l] + normal[k] * moved[l];
}

/* x := x without its mean over the markers, step by step through pairs. */
static void TakeOffMean(PetscInt n, PetscInt stride, PetscReal x[]) {
  for (int c = 0; c < 2; c++) {
    PetscReal mean = 0;
    for (PetscInt k = 0; k < n; k++) mean += x[(2 * k + c) * stride] / n;
    for (PetscInt k = 0; k < n; k++) x[(2 * k + c) * stride] -= mean;
  }
}

/* R = (I + Theta K)^-1, K = (c_b/a0) ds D4, by way of the bending force w = K U, which has mean zero:
   (K^-1 + Theta) w = given there. Its matrix is symmetric and is made without a derivative. */
static PetscErrorCode FactorForce(SelfMobility s, PetscInt v, PetscBool *factored) {
  Block *b = OwnBlock(s, v);
  const PetscInt n = b->n;
  const PetscReal scale = s->a0 / s->membrane->bending;
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(b->force, b->Theta, 4 * n * n));
  for (PetscInt r = 0; r < 2 * n; r++) TakeOffMean(n, 1, b->force + r * 2 * n);
  for (PetscInt r = 0; r < 2 * n; r++) TakeOffMean(n, 2 * n, b->force + r);
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt l = 0; l < n; l++)
      for (int c = 0; c < 2; c++) b->force[(2 * k + c) * 2 * n + 2 * l + c] += scale * b->K[k >= l ? k - l : k - l + n];
  PetscCall(DenseFactorSymmetric(2 * n, b->force, factored));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SelfMobilityPlace(SelfMobility s, PetscReal a0, const PetscScalar X[], PetscBool *factored) {
  const Membrane m = s->membrane;
  PetscLogEvent event;
  PetscFunctionBeginUser;
  PetscCall(PetvesEvent("SelfMobility", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  s->a0 = a0;
  *factored = PETSC_TRUE;
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    Block *b = OwnBlock(s, v);
    PetscBool good = PETSC_TRUE;
    Tangents(s, v, X + 2 * LayoutOffset(m->layout, v), b->work);
    FillTheta(s, v, b->work, b->second);
    if (s->type == SELF_SYMBOL) TakeOffFlux(b, b->work, b->second, b->change);
    if (m->bending > 0) PetscCall(FactorForce(s, v, &good));
    if (!good) *factored = PETSC_FALSE;
  }
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Largest(PetscInt n, const PetscReal x[]) {
  PetscReal largest = 0;
  for (PetscInt k = 0; k < n; k++) largest = PetscMax(largest, PetscAbsReal(x[k]));
  return largest;
}

/* U := R U of one vesicle: U = given - Theta w with refinement, because K^-1 spans many decades. */
static PetscErrorCode SolveR(SelfMobility s, PetscInt v, PetscScalar U[]) {
  Block *b = OwnBlock(s, v);
  const Membrane m = s->membrane;
  const PetscInt n = 2 * b->n;
  PetscReal last = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(b->given, U, n));
  PetscCall(PetscArraycpy(b->change, U, n));
  PetscCall(PetscArrayzero(U, n));
  for (int round = 0; round < MAX_REFINEMENTS; round++) {
    PetscCall(PetscArraycpy(b->work, b->change, n));
    TakeOffMean(b->n, 1, b->work);
    PetscCall(DenseSolveSymmetric(n, b->force, b->work));
    PetscCall(DenseMultAdd(n, n, -1, b->Theta, b->work, b->change));
    for (PetscInt k = 0; k < n; k++) U[k] += b->change[k];
    const PetscReal change = Largest(n, b->change), allowed = ROUND_OFF * Largest(n, U);
    /* the next change would be smaller by as much again, or round-off is reached */
    if (change <= allowed || (round && (PetscSqr(change) <= allowed * last || change > 0.5 * last))) break;
    last = change;
    PetscCall(PetscArraycpy(b->change, b->given, n)); /* change := given - U - Theta K U */
    PetscCall(PetscArrayzero(b->work, n));
    MembraneVesicleBending(m, v, m->bending / s->a0, U, b->work);
    for (PetscInt k = 0; k < n; k++) b->change[k] -= U[k];
    PetscCall(DenseMultAdd(n, n, -1, b->Theta, b->work, b->change));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U := R (U - Theta F) of one vesicle. */
static PetscErrorCode Subtract(SelfMobility s, PetscInt v, PetscScalar U[], const PetscScalar F[]) {
  const Block *b = OwnBlock(s, v);
  PetscFunctionBeginUser;
  PetscCall(DenseMultAdd(2 * b->n, 2 * b->n, -1, b->Theta, F, U));
  if (s->membrane->bending > 0) PetscCall(SolveR(s, v, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SelfMobilityApply(SelfMobility s, const PetscReal tau[], const PetscScalar sigma[],
                                 const PetscScalar Xhat[], PetscScalar U[]) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  PetscScalar *F = s->force;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(F, 2 * l->n));
  if (sigma) MembraneStretchingTranspose(m, tau, 1, sigma, F);
  if (Xhat) MembraneBending(m, m->bending, Xhat, F);
  for (PetscInt v = l->own; v < l->end; v++)
    PetscCall(Subtract(s, v, U + 2 * LayoutOffset(l, v), F + 2 * LayoutOffset(l, v)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SelfMobilityMultTheta(SelfMobility s, PetscScalar F[]) {
  const Layout l = s->membrane->layout;
  PetscFunctionBeginUser;
  for (PetscInt v = l->own; v < l->end; v++) {
    Block *b = OwnBlock(s, v);
    PetscScalar *own = F + 2 * LayoutOffset(l, v);
    PetscCall(PetscArraycpy(b->work, own, 2 * b->n));
    PetscCall(PetscArrayzero(own, 2 * b->n));
    PetscCall(DenseMultAdd(2 * b->n, 2 * b->n, 1, b->Theta, b->work, own));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
