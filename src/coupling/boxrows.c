/* What a marker has of a box table. */
#include "coupling/boxtable.h"
#include "coupling/panels.h"

PetscReal BoxTableFade(const BoxTable *t, Grid g, const PetscReal X[2]) {
  const PetscReal last = t->H > g->h * (1 + 1e-9) ? t->H
                                                  : 0.5 * g->h; /* the table of the run's own grid ends at its limit */
  PetscReal fade = 1;
  for (int d = 0; d < 2; d++) {
    const PetscReal *x = &X[d], end = t->axis[d].low - g->lo[d] - (last < t->H ? last : 0);
    if (!g->wall[d]) continue;
    fade *= BoxSmoothStep(PetscMin(*x - g->lo[d], g->hi[d] - *x), end, end + last);
  }
  return fade;
}

/* Markers whose rows are made together, in whole groups of columns: a marker's row has the same bits in any company. */
#define TOGETHER 32
#define GROUP 4
typedef struct {
  PetscInt n;
  PetscReal x[TOGETHER][BOX_FUNCTIONS], y[TOGETHER][BOX_FUNCTIONS]; /* their functions, x times fade */
  PetscReal *weight, *sum;                                          /* [n][functions of a block], [n][its modes] */
} Batch;

/* Block q's part of component c of the rows, which are `apart` numbers from one marker to the next. */
static void FillBlock(const BoxBlock *q, int c, Batch *b, PetscInt apart, PetscReal rows[]) {
  const PetscInt functions = q->n[0] * q->n[1], columns[2] = {functions, PanelsRows(q->modes)};
  for (PetscInt k = 0; k < b->n; k++)
    for (PetscInt i = 0; i < q->n[0]; i++)
      for (PetscInt j = 0; j < q->n[1]; j++)
        b->weight[(k * q->n[0] + i) * q->n[1] + j] = b->x[k][q->first[c][0] + i] * b->y[k][q->first[c][1] + j];
  PanelsProduct(q->modes, functions, q->Q + c * PanelsSize(q->modes, functions), functions,
                (b->n + GROUP - 1) / GROUP * GROUP, columns, b->weight, b->sum);
  for (PetscInt k = 0; k < b->n; k++)
    (void)PetscArraycpy(rows + k * apart + q->start, b->sum + k * columns[1], q->modes);
}

PetscErrorCode BoxTableRows(const BoxTable *t, PetscInt n, const PetscReal X[], const PetscReal fade[], int first,
                            int count, PetscReal rows[]) {
  PetscInt functions = 0, modes = 0;
  Batch b;
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < t->blocks; q++) {
    functions = PetscMax(functions, t->block[q].n[0] * t->block[q].n[1]);
    modes = PetscMax(modes, PanelsRows(t->block[q].modes));
  }
  PetscCall(PetscCalloc2(TOGETHER * functions, &b.weight, TOGETHER * modes, &b.sum));
  for (PetscInt begin = 0; begin < n; begin += TOGETHER) {
    b.n = PetscMin(TOGETHER, n - begin);
    for (PetscInt k = 0; k < b.n; k++) {
      BoxTableFunctions(t, 0, X[2 * (begin + k)], b.x[k]);
      BoxTableFunctions(t, 1, X[2 * (begin + k) + 1], b.y[k]);
      for (PetscInt i = 0; i < t->functions[0]; i++) b.x[k][i] *= fade[begin + k];
    }
    for (PetscInt q = 0; q < t->blocks; q++)
      for (int c = 0; c < count; c++)
        FillBlock(&t->block[q], first + c, &b, count * t->rank, rows + (begin * count + c) * t->rank);
  }
  PetscCall(PetscFree2(b.weight, b.sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal BoxSum(PetscInt r, const PetscReal l[], const PetscReal x[]) {
  PetscReal sum[4] = {0}, rest = 0;
  PetscInt m = 0;
  for (; m + 4 <= r; m += 4)
    for (int q = 0; q < 4; q++) sum[q] += l[m + q] * x[m + q];
  for (; m < r; m++) rest += l[m] * x[m];
  return sum[0] + sum[1] + sum[2] + sum[3] + rest;
}
