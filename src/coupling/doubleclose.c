/* As nearclose.c: chi(r) D is exchanged, chi a smooth window. */
#include "coupling/doubleclose.h"
#include "coupling/finecurve.h"
#include "coupling/nearclose.h"

void DoubleCloseNormals(const FineCurve *c, const PetscReal normal[], PetscReal N[]) {
  const PetscInt Q = c->n * c->f;
  for (PetscInt q = 0; q < c->count; q++)
    for (int d = 0; d < 2; d++) {
      PetscReal sum = 0;
      for (PetscInt k = 0; k < c->n; k++) sum += c->weight[((c->used[q] - c->f * k) % Q + Q) % Q] * normal[2 * k + d];
      N[2 * q + d] = sum;
    }
}

/* chi D on the points in use, projected: parts xx, yy, xy, [n_b][n_a] each. */
static PetscErrorCode Project(const FineCurve *a, const FineCurve *b, const PetscReal N[], PetscReal window,
                              PetscReal *const part[3]) {
  PetscReal *K[3];
  PetscFunctionBeginUser;
  for (int c = 0; c < 3; c++) PetscCall(PetscMalloc1(a->count * b->count, &K[c]));
  for (PetscInt q = 0; q < b->count; q++)
    for (PetscInt p = 0; p < a->count; p++) {
      const PetscReal *x = a->x + 2 * a->used[p], *y = b->x + 2 * b->used[q], r[2] = {y[0] - x[0], y[1] - x[1]};
      const PetscReal r2 = r[0] * r[0] + r[1] * r[1], chi = FineWindow(PetscSqrtReal(r2), window);
      const PetscReal D = -chi * (r[0] * N[2 * q] + r[1] * N[2 * q + 1]) / (PETSC_PI * r2 * r2);
      K[0][q * a->count + p] = D * r[0] * r[0];
      K[1][q * a->count + p] = D * r[1] * r[1];
      K[2][q * a->count + p] = D * r[0] * r[1];
    }
  for (int c = 0; c < 3; c++) {
    PetscCall(FineCurveProject(a, b, K[c], part[c]));
    PetscCall(PetscFree(K[c]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Curves at `factor` times their markers, added with a sign. */
static PetscErrorCode AddAt(DoubleLayer s, const DoubleBlock *block, const PetscReal shift[2], PetscInt factor,
                            PetscReal window, PetscReal sign, PetscReal value[]) {
  const PetscReal none[2] = {0, 0};
  PetscReal *part[3], *N;
  FineCurve a, b;
  PetscFunctionBeginUser;
  PetscCall(FineCurveCreate(s->near, block->row, none, factor, &a));
  PetscCall(FineCurveCreate(s->near, block->column, shift, factor, &b));
  PetscCall(FineCurvePair(&a, &b, window));
  PetscCall(PetscMalloc4(a.n * b.n, &part[0], a.n * b.n, &part[1], a.n * b.n, &part[2], 2 * b.count, &N));
  DoubleCloseNormals(&b, s->normal + 2 * s->near->bodies->layout->start[block->column], N);
  PetscCall(Project(&a, &b, N, window, part));
  for (PetscInt j = 0; j < b.n; j++)
    for (PetscInt i = 0; i < a.n; i++) {
      PetscReal *at = value + 2 * j * 2 * a.n + 2 * i;
      at[0] += sign * part[0][j * a.n + i];
      at[2 * a.n + 1] += sign * part[1][j * a.n + i];
      at[1] += sign * part[2][j * a.n + i];
      at[2 * a.n] += sign * part[2][j * a.n + i];
    }
  PetscCall(PetscFree4(part[0], part[1], part[2], N));
  PetscCall(FineCurveDestroy(&a));
  PetscCall(FineCurveDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether a close image of the near field is in this block, and by which shift of its column. */
static PetscBool Belongs(DoubleLayer s, const DoubleBlock *b, const NearClose *c, PetscReal shift[2]) {
  const NearBlock *of = &s->near->block[c->block];
  for (int turned = 0; turned < 2; turned++) {
    PetscBool same = b->row == (turned ? of->column : of->row) && b->column == (turned ? of->row : of->column);
    for (int d = 0; d < 2; d++) {
      shift[d] = turned ? -c->shift[d] : c->shift[d];
      if (b->shift[d] != shift[d] && !s->near->box) same = PETSC_FALSE; /* with a box part all images share a block */
    }
    if (same) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode DoubleCloseAdd(DoubleLayer s, const DoubleBlock *b, PetscReal value[]) {
  const NearField f = s->near;
  PetscReal shift[2], window;
  PetscInt factor;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < f->closes; k++) {
    if (!Belongs(s, b, &f->close[k], shift)) continue;
    NearCloseFineness(f, &f->close[k], &factor, &window);
    PetscCall(AddAt(s, b, shift, factor, window, 1, value));
    PetscCall(AddAt(s, b, shift, 1, window, -1, value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
