#include "mobility/neardistant.h"
#include "layers/nearrows.h"
#include "numerics/blas.h"

#define DEGREE 7
#define MOST ((DEGREE + 1) * (DEGREE + 2) / 2)
#define NOTHING 1e-8 /* of a polynomial's size: what is left of it beside the others that is one of its own */

PetscErrorCode NearDistantCreate(Layout layout, NearDistant *out) {
  PetscFunctionBeginUser;
  PetscCall(PetscNew(out));
  (*out)->layout = layout;
  PetscCall(PetscCalloc1(layout->bodies, &(*out)->function));
  PetscCall(PetscCalloc1(layout->bodies + 1, &(*out)->start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearDistantDestroy(NearDistant *distant) {
  NearDistant d = *distant;
  PetscFunctionBeginUser;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < d->layout->bodies; v++) PetscCall(PetscFree(d->function[v].P));
  PetscCall(PetscFree(d->function));
  PetscCall(PetscFree(d->pair));
  PetscCall(PetscFree(d->value));
  PetscCall(PetscFree(d->start));
  PetscCall(PetscFree2(d->amplitude, d->answer));
  PetscCall(PetscFree(*distant));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is left of f[n] beside the orthonormal Q[count][n], over its norm. */
static PetscReal DistantRemainder(PetscInt n, PetscInt count, const PetscReal Q[], PetscReal f[]) {
  PetscReal before = 0, after = 0;
  for (PetscInt k = 0; k < n; k++) before += PetscSqr(f[k]);
  for (int twice = 0; twice < 2; twice++) /* once is not enough where little is left */
    for (PetscInt q = 0; q < count; q++) {
      PetscReal sum = 0;
      for (PetscInt k = 0; k < n; k++) sum += Q[q * n + k] * f[k];
      for (PetscInt k = 0; k < n; k++) f[k] -= sum * Q[q * n + k];
    }
  for (PetscInt k = 0; k < n; k++) after += PetscSqr(f[k]);
  for (PetscInt k = 0; k < n; k++) f[k] /= PetscSqrtReal(after);
  return PetscSqrtReal(after / before);
}

/* A curve's polynomials, by Gram and Schmidt from x^i y^j, by degree. X[2n] its markers. */
static PetscErrorCode DistantFunctions(PetscInt n, const PetscReal X[], NearFunctions *own) {
  PetscReal middle[2] = {0, 0}, size = 0, *Q;
  PetscInt count = 0;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * n; k++) middle[k % 2] += X[k] / n;
  for (PetscInt k = 0; k < 2 * n; k++) size = PetscMax(size, PetscAbsReal(X[k] - middle[k % 2]));
  PetscCall(PetscMalloc1(MOST * n, &Q));
  for (PetscInt degree = 0; degree <= DEGREE; degree++)
    for (PetscInt i = degree; i >= 0; i--) {
      PetscReal *f = Q + count * n;
      for (PetscInt k = 0; k < n; k++)
        f[k] = PetscPowRealInt((X[2 * k] - middle[0]) / size, (int)i) *
               PetscPowRealInt((X[2 * k + 1] - middle[1]) / size, (int)(degree - i));
      if (count < n && DistantRemainder(n, count, Q, f) > NOTHING) count++;
    }
  own->stride = LANES * ((2 * count + LANES - 1) / LANES);
  PetscCall(PetscCalloc1(own->stride * 2 * n, &own->P));
  for (PetscInt q = 0; q < count; q++)
    for (PetscInt k = 0; k < n; k++)
      for (int c = 0; c < 2; c++) own->P[(c * count + q) * 2 * n + 2 * k + c] = Q[q * n + k];
  PetscCall(PetscFree(Q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearDistantAdd(NearDistant d, const PetscReal X[], PetscInt v, PetscInt w, const PetscReal shift[2],
                              PetscBool *added) {
  const Layout l = d->layout;
  const PetscInt body[2] = {v, w};
  PetscFunctionBeginUser;
  for (int end = 0; end < 2; end++) {
    const PetscInt b = body[end];
    if (!d->function[b].P) PetscCall(DistantFunctions(LayoutCount(l, b), X + 2 * l->start[b], &d->function[b]));
  }
  const PetscInt numbers = d->function[v].stride * d->function[w].stride;
  *added = 2 * numbers < 4 * LayoutCount(l, v) * LayoutCount(l, w);
  if (!*added) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayReserve((size_t)d->pairs + 1, &d->room, &d->pair));
  d->pair[d->pairs++] = (NearDistantPair){v, w, {shift[0], shift[1]}, d->values};
  d->values += (size_t)numbers;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearDistantMake(NearDistant d) {
  const PetscInt bodies = d->layout->bodies;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < bodies; v++) d->start[v + 1] = d->start[v] + d->function[v].stride;
  PetscCall(PetscMalloc1(d->values, &d->value));
  PetscCall(PetscCalloc2(d->start[bodies], &d->amplitude, d->start[bodies], &d->answer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearDistantFill(NearDistant d, PetscInt pair, PetscInt stride, const PetscReal C[]) {
  const NearDistantPair *p = &d->pair[pair];
  const NearFunctions *row = &d->function[p->row], *column = &d->function[p->column];
  const PetscInt n = 2 * LayoutCount(d->layout, p->row), m = 2 * LayoutCount(d->layout, p->column);
  PetscReal *half, *B;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(column->stride * n, &half, column->stride * row->stride, &B));
  PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){column->P, m, column->stride, m}, (DenseView){C, m, n, stride},
                               0, half, column->stride)); /* all by columns, where C and B are their transposes */
  PetscCall(DenseProduct(PETSC_FALSE, column->stride, row->stride, n, half, row->P, B));
  DenseSingle(row->stride * column->stride, B, d->value + p->at);
  PetscCall(PetscFree2(half, B));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearDistantExpand(NearDistant d, PetscInt pair, PetscInt stride, PetscReal C[]) {
  const NearDistantPair *p = &d->pair[pair];
  const NearFunctions *row = &d->function[p->row], *column = &d->function[p->column];
  const PetscInt n = 2 * LayoutCount(d->layout, p->row), m = 2 * LayoutCount(d->layout, p->column);
  PetscReal *half, *B;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m * row->stride, &half, column->stride * row->stride, &B));
  for (PetscInt k = 0; k < row->stride * column->stride; k++) B[k] = d->value[p->at + (size_t)k];
  PetscCall(DenseProduct(PETSC_FALSE, m, row->stride, column->stride, column->P, B, half));
  PetscCall(PetscArrayzero(C, n * stride));
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt q = 0; q < row->stride; q++)
      for (PetscInt k = 0; k < m; k++) C[i * stride + k] += row->P[q * n + i] * half[q * m + k];
  PetscCall(PetscFree2(half, B));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearDistantApply(NearDistant d, PetscReal alpha, const PetscScalar force[], PetscScalar velocity[]) {
  const Layout l = d->layout;
  PetscFunctionBeginUser;
  if (!d->pairs) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(d->amplitude, d->start[l->bodies]));
  PetscCall(PetscArrayzero(d->answer, d->start[l->bodies]));
  for (PetscInt v = 0; v < l->bodies; v++)
    if (d->function[v].P)
      PetscCall(DenseMultAdd(PETSC_TRUE, 2 * LayoutCount(l, v), d->function[v].stride, 1, d->function[v].P,
                             force + 2 * l->start[v], d->amplitude + d->start[v]));
  for (PetscInt k = 0; k < d->pairs; k++) {
    const NearDistantPair *p = &d->pair[k];
    const PetscInt stride = d->function[p->column].stride, from = d->start[p->column];
    const PetscBool both = p->column >= l->own && p->column < l->end;
    for (PetscInt i = 0; i < d->function[p->row].stride; i += LANES) {
      const PetscInt to = d->start[p->row] + i;
      ApplyRows(2, (BlockRows){PETSC_TRUE, d->value, p->at + (size_t)(i * stride), stride}, 1, d->amplitude + to,
                d->amplitude + from, d->answer + to, both ? d->answer + from : NULL);
    }
  }
  for (PetscInt v = l->own; v < l->end; v++)
    if (d->function[v].P)
      PetscCall(DenseMultAdd(PETSC_FALSE, 2 * LayoutCount(l, v), d->function[v].stride, alpha, d->function[v].P,
                             d->answer + d->start[v], velocity + 2 * LayoutOffset(l, v)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
