/* With P the trigonometric interpolation from a curve's n markers to f n points, S between two curves becomes
       P_a^T S_fine P_b/(f_a f_b),
   symmetric under exchange of the curves by construction. Only near pairs need it: chi(r) S is exchanged, chi a smooth
   window. */
#include "coupling/nearclose.h"
#include "coupling/blas.h"

#define CLOSE 1.3      /* spacings: gaps below it need finer points */
#define FINE 2.5       /* fine points a gap */
#define MOST_FINE 64   /* times the markers */
#define PROBE 4        /* times the markers, for measuring the gap */
#define WINDOW 8       /* spacings: chi is zero beyond, and 1 up to a third of it */

/* Points of one curve at f times its markers, and those of them that count. */
typedef struct {
  PetscInt n, f, first; /* markers, factor, first marker of all */
  PetscReal *weight;    /* [f n] interpolation by index difference: P_qk = weight[(q - f k) mod f n] */
  PetscReal *x;         /* [f n][2] */
  PetscInt *used, count;
  PetscReal *P;         /* [n][count] columns one after another: rows of P that count */
} FineCurve;

/* Cardinal function of trigonometric interpolation. */
static PetscReal Cardinal(PetscInt n, PetscReal t) {
  const PetscReal s = PetscSinReal(0.5 * t);
  if (PetscAbsReal(s) < 1e-14) return 1;
  return PetscSinReal(0.5 * n * t) / (n * (n % 2 ? s : PetscTanReal(0.5 * t)));
}

static PetscErrorCode CreateCurve(NearField f, PetscInt v, const PetscReal shift[2], PetscInt factor, FineCurve *c) {
  const Layout l = f->membrane->layout;
  PetscFunctionBeginUser;
  c->n = LayoutCount(l, v);
  c->f = factor;
  c->first = l->start[v];
  c->count = 0;
  const PetscInt Q = c->n * factor;
  PetscCall(PetscMalloc3(Q, &c->weight, 2 * Q, &c->x, Q, &c->used));
  c->P = NULL;
  for (PetscInt q = 0; q < Q; q++) c->weight[q] = Cardinal(c->n, 2 * PETSC_PI * q / Q);
  for (PetscInt q = 0; q < Q; q++)
    for (int d = 0; d < 2; d++) {
      PetscReal sum = shift[d];
      for (PetscInt k = 0; k < c->n; k++)
        sum += c->weight[((q - factor * k) % Q + Q) % Q] * f->markers->X[2 * (c->first + k) + d];
      c->x[2 * q + d] = sum;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyCurve(FineCurve *c) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(c->weight, c->x, c->used));
  PetscCall(PetscFree(c->P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Distance2(const PetscReal a[2], const PetscReal b[2]) {
  return PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]);
}

/* Least distance of the points of two curves. */
static PetscReal Gap(const FineCurve *a, const FineCurve *b) {
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt p = 0; p < a->n * a->f; p++)
    for (PetscInt q = 0; q < b->n * b->f; q++) least = PetscMin(least, Distance2(a->x + 2 * p, b->x + 2 * q));
  return PetscSqrtReal(least);
}

/* The points of a with a point of b in the window, and their rows of P. */
static PetscErrorCode SelectPoints(FineCurve *a, const FineCurve *b, PetscReal window) {
  const PetscInt Q = a->n * a->f;
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < Q; p++)
    for (PetscInt q = 0; q < b->n * b->f; q++)
      if (Distance2(a->x + 2 * p, b->x + 2 * q) < window * window) {
        a->used[a->count++] = p;
        break;
      }
  PetscCall(PetscMalloc1(a->n * a->count, &a->P));
  for (PetscInt k = 0; k < a->n; k++)
    for (PetscInt p = 0; p < a->count; p++)
      a->P[k * a->count + p] = a->weight[((a->used[p] - a->f * k) % Q + Q) % Q] / a->f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* chi times the Stokeslet at the distance d: xx, yy, xy. */
static void Windowed(PetscReal nu, PetscReal window, const PetscReal x[2], const PetscReal y[2], PetscReal S[3]) {
  const PetscReal d[2] = {x[0] - y[0], x[1] - y[1]}, r2 = d[0] * d[0] + d[1] * d[1];
  const PetscReal t = PetscMin(1, PetscMax(0, (PetscSqrtReal(r2) / window - 1. / 3) * 1.5));
  const PetscReal factor = (1 - t * t * (3 - 2 * t)) / (4 * PETSC_PI * nu), logarithm = -0.5 * PetscLogReal(r2);
  S[0] = factor * (logarithm + d[0] * d[0] / r2);
  S[1] = factor * (logarithm + d[1] * d[1] / r2);
  S[2] = factor * d[0] * d[1] / r2;
}

/* block += sign times part [columns][rows] of component c (0 xx, 1 yy, 2 xy and yx). */
static void AddComponent(NearBlock *b, PetscInt rows, PetscInt columns, int c, PetscReal sign, const PetscReal part[]) {
  const PetscInt place = c == 1 ? 2 * rows + 1 : (c == 2 ? 2 * rows : 0);
  for (PetscInt j = 0; j < columns; j++)
    for (PetscInt i = 0; i < rows; i++) {
      PetscReal *at = b->C + 2 * j * 2 * rows + 2 * i;
      at[place] += sign * part[j * rows + i];
      if (c == 2) at[1] += sign * part[j * rows + i];
    }
}

/* block += sign P_a^T (chi S) P_b of the points in use. */
static PetscErrorCode AddProjected(NearField f, NearBlock *block, const FineCurve *a, const FineCurve *b, PetscReal window,
                                   PetscReal sign) {
  PetscReal *G[3], *half, *part;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(a->count * b->count, &G[0], a->count * b->count, &G[1], a->count * b->count, &G[2],
                         a->n * b->count, &half, a->n * b->n, &part));
  for (PetscInt q = 0; q < b->count; q++)
    for (PetscInt p = 0; p < a->count; p++) {
      PetscReal S[3];
      Windowed(f->nu, window, a->x + 2 * a->used[p], b->x + 2 * b->used[q], S);
      for (int c = 0; c < 3; c++) G[c][q * a->count + p] = S[c];
    }
  for (int c = 0; c < 3; c++) {
    PetscCall(DenseProduct(PETSC_TRUE, a->n, b->count, a->count, a->P, G[c], half));
    PetscCall(DenseProduct(PETSC_FALSE, a->n, b->n, b->count, half, b->P, part));
    AddComponent(block, a->n, b->n, c, sign, part);
  }
  PetscCall(PetscFree5(G[0], G[1], G[2], half, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The block of curves at `factor` times their markers, windowed, added with a sign. */
static PetscErrorCode AddAt(NearField f, NearBlock *block, PetscInt factor, PetscReal window, PetscReal sign) {
  const PetscReal none[2] = {0, 0};
  FineCurve a, b;
  PetscFunctionBeginUser;
  PetscCall(CreateCurve(f, block->row, none, factor, &a));
  PetscCall(CreateCurve(f, block->column, block->shift, factor, &b));
  PetscCall(SelectPoints(&a, &b, window));
  PetscCall(SelectPoints(&b, &a, window));
  PetscCall(AddProjected(f, block, &a, &b, window, sign));
  PetscCall(DestroyCurve(&a));
  PetscCall(DestroyCurve(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearBlockRefine(NearField f, NearBlock *block) {
  const PetscReal none[2] = {0, 0}, ds = PetscMax(f->membrane->ds[block->row], f->membrane->ds[block->column]);
  FineCurve a, b;
  PetscReal gap;
  PetscFunctionBeginUser;
  PetscCall(CreateCurve(f, block->row, none, 1, &a));
  PetscCall(CreateCurve(f, block->column, block->shift, 1, &b));
  gap = Gap(&a, &b); /* of markers: where it is wide, so is that of the curves */
  PetscCall(DestroyCurve(&a));
  PetscCall(DestroyCurve(&b));
  if (gap > (CLOSE + 1) * ds) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CreateCurve(f, block->row, none, PROBE, &a));
  PetscCall(CreateCurve(f, block->column, block->shift, PROBE, &b));
  gap = Gap(&a, &b);
  PetscCall(DestroyCurve(&a));
  PetscCall(DestroyCurve(&b));
  if (gap > CLOSE * ds) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt factor = (PetscInt)PetscMin(MOST_FINE, PetscCeilReal(FINE * ds / PetscMax(gap, FINE * ds / MOST_FINE)));
  PetscCall(AddAt(f, block, factor, WINDOW * ds, 1));
  PetscCall(AddAt(f, block, 1, WINDOW * ds, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}
