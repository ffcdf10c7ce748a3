#include "mobility/neardistant.h"
#include "layers/nearrows.h"

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
  for (PetscInt v = 0; v < d->layout->bodies; v++) PetscCall(PetscFree(d->function[v].value));
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
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * n; k++) middle[k % 2] += X[k] / n;
  for (PetscInt k = 0; k < 2 * n; k++) size = PetscMax(size, PetscAbsReal(X[k] - middle[k % 2]));
  PetscCall(PetscMalloc1(MOST * n, &Q));
  for (PetscInt degree = 0; degree <= DEGREE; degree++)
    for (PetscInt i = degree; i >= 0; i--) {
      PetscReal *f = Q + own->count * n;
      for (PetscInt k = 0; k < n; k++)
        f[k] = PetscPowRealInt((X[2 * k] - middle[0]) / size, (int)i) *
               PetscPowRealInt((X[2 * k + 1] - middle[1]) / size, (int)(degree - i));
      if (own->count < n && DistantRemainder(n, own->count, Q, f) > NOTHING) own->count++;
    }
  own->stride = LANES * ((2 * own->count + LANES - 1) / LANES);
  PetscCall(PetscMalloc1(n * own->count, &own->value));
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt q = 0; q < own->count; q++) own->value[k * own->count + q] = Q[q * n + k];
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
    if (!d->function[b].value) PetscCall(DistantFunctions(LayoutCount(l, b), X + 2 * l->start[b], &d->function[b]));
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

/* a[stride] = a curve's polynomials' parts of x, interlaced numbers of n markers. */
static void DistantParts(const NearFunctions *f, PetscInt n, const PetscReal x[], PetscReal a[]) {
  (void)PetscArrayzero(a, f->stride);
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++)
      for (PetscInt q = 0; q < f->count; q++) a[c * f->count + q] += x[2 * k + c] * f->value[k * f->count + q];
}

/* x += alpha times the sum of the polynomials with parts a[stride]. */
static void DistantSum(const NearFunctions *f, PetscInt n, PetscReal alpha, const PetscReal a[], PetscReal x[]) {
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) {
      PetscReal sum = 0;
      for (PetscInt q = 0; q < f->count; q++) sum += a[c * f->count + q] * f->value[k * f->count + q];
      x[2 * k + c] += alpha * sum;
    }
}

PetscErrorCode NearDistantFill(NearDistant d, PetscInt pair, PetscInt stride, const PetscReal C[]) {
  const NearDistantPair *p = &d->pair[pair];
  const NearFunctions *row = &d->function[p->row], *column = &d->function[p->column];
  const PetscInt n = LayoutCount(d->layout, p->row), m = LayoutCount(d->layout, p->column);
  PetscReal *half, *B;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(column->stride, &half, row->stride * column->stride, &B));
  for (PetscInt i = 0; i < 2 * n; i++) {
    DistantParts(column, m, C + i * stride, half);
    for (PetscInt q = 0; q < row->count; q++)
      for (PetscInt k = 0; k < column->stride; k++)
        B[(i % 2 * row->count + q) * column->stride + k] += row->value[i / 2 * row->count + q] * half[k];
  }
  for (PetscInt k = 0; k < row->stride * column->stride; k++) d->value[p->at + (size_t)k] = (float)B[k];
  PetscCall(PetscFree2(half, B));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearDistantExpand(NearDistant d, PetscInt pair, PetscInt stride, PetscReal C[]) {
  const NearDistantPair *p = &d->pair[pair];
  const NearFunctions *row = &d->function[p->row], *column = &d->function[p->column];
  const PetscInt n = LayoutCount(d->layout, p->row), m = LayoutCount(d->layout, p->column);
  PetscReal *half;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(column->stride, &half));
  PetscCall(PetscArrayzero(C, 2 * n * stride));
  for (PetscInt i = 0; i < 2 * n; i++) {
    PetscCall(PetscArrayzero(half, column->stride));
    for (PetscInt q = 0; q < row->count; q++)
      for (PetscInt k = 0; k < column->stride; k++)
        half[k] += row->value[i / 2 * row->count + q] *
                   d->value[p->at + (size_t)((i % 2 * row->count + q) * column->stride + k)];
    DistantSum(column, m, 1, half, C + i * stride);
  }
  PetscCall(PetscFree(half));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearDistantApply(NearDistant d, PetscReal alpha, const PetscScalar force[], PetscScalar velocity[]) {
  const Layout l = d->layout;
  PetscFunctionBeginUser;
  if (!d->pairs) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < l->bodies; v++)
    if (d->function[v].value)
      DistantParts(&d->function[v], LayoutCount(l, v), force + 2 * l->start[v], d->amplitude + d->start[v]);
  PetscCall(PetscArrayzero(d->answer, d->start[l->bodies]));
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
    if (d->function[v].value)
      DistantSum(&d->function[v], LayoutCount(l, v), alpha, d->answer + d->start[v], velocity + 2 * LayoutOffset(l, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}
