#include "bodies/law.h"
#include "bodies/stretch.h"
#include "numerics/blas.h"

/* Relative errors of an edge above which all are corrected after a step, with the area target and without, and of a
   length that is corrected alone. Bending energy changes by up to half of what edges are uneven by. */
#define EDGE_TOLERANCE 1e-7
#define EDGE_TOLERANCE_WITHOUT_AREA 1e-3
#define LENGTH_TOLERANCE 1e-3

#define REGULAR 1e-9 /* of the mean diagonal of C */

PetscErrorCode LawCreate(Membrane m, PetscReal h, PetscInt vesicle, PetscInt end, MembraneLaw *law) {
  const PetscInt *start = m->layout->start;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(law));
  **law = (struct _p_MembraneLaw){m, h * h, vesicle, end, start[vesicle], start[end] - start[vesicle]};
  PetscCall(PetscMalloc1(2 * (*law)->n, &(*law)->tau));
  if (m->stretches)
    PetscCall(PetscCalloc3((*law)->n, &(*law)->c, (*law)->n, &(*law)->viscous, (*law)->n, &(*law)->excess));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LawDestroy(MembraneLaw *law) {
  PetscFunctionBeginUser;
  if (*law) PetscCall(PetscFree((*law)->tau));
  if (*law) PetscCall(PetscFree3((*law)->c, (*law)->viscous, (*law)->excess));
  if (*law) PetscCall(PetscFree3((*law)->ratio, (*law)->z, (*law)->speed));
  PetscCall(PetscFree(*law));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LawAimAreas(MembraneLaw law, const PetscReal ratio[]) {
  const PetscInt vesicles = law->end - law->vesicle;
  PetscFunctionBeginUser;
  /* ratio is not NULL on ranks without vesicles either */
  PetscCall(PetscMalloc3(vesicles + 1, &law->ratio, 2 * law->n, &law->z, vesicles, &law->speed));
  for (PetscInt k = 0; k < vesicles; k++) law->ratio[k] = ratio ? ratio[law->vesicle + k] : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Index of a vesicle's first marker among those of the law. */
static PetscInt LawOffset(MembraneLaw law, PetscInt v) {
  return law->membrane->layout->start[v] - law->first;
}

void LawPlace(MembraneLaw law, PetscReal a0, const PetscScalar X[]) {
  const Membrane m = law->membrane;
  MembraneTangents(m, law->vesicle, law->end, X, law->tau);
  law->a0 = a0;
  for (PetscInt v = law->vesicle; v < law->end && law->c; v++)
    for (PetscInt k = LawOffset(law, v); k < LawOffset(law, v + 1) && MembraneStretches(m, v); k++) { /* others: 0 */
      const Material *of = &m->material[v];
      const PetscReal q = PetscSqr(law->tau[2 * k]) + PetscSqr(law->tau[2 * k + 1]);
      const Stretch s = StretchOf(of->law, q);
      const PetscReal viscous = of->viscosity * a0, resistance = 2 * of->modulus * s.slope * q + viscous;
      law->viscous[k] = viscous / resistance;
      law->c[k] = a0 * m->ds[v] * q / resistance;
      law->excess[k] = 0.5 * s.sigma / s.slope - 0.5 * (q - 1);
    }
}

void LawForce(MembraneLaw law, PetscReal alpha, const PetscScalar sigma[], PetscScalar F[]) {
  const Membrane m = law->membrane;
  PetscScalar *pull = m->work.stretching;
  for (PetscInt v = law->vesicle; v < law->end; v++) {
    const PetscInt at = LawOffset(law, v);
    for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k++) pull[k] = law->tau[2 * at + k] * sigma[at + k / 2];
    MembraneEdgesTranspose(m, v, alpha, pull, F + 2 * at);
  }
}

void LawRows(MembraneLaw law, const PetscScalar V[], const PetscScalar sigma[], PetscScalar d[]) {
  const Membrane m = law->membrane;
  PetscScalar *e = m->work.stretching;
  for (PetscInt v = law->vesicle; v < law->end; v++) {
    const PetscInt at = LawOffset(law, v);
    const PetscReal *tau = law->tau + 2 * at;
    MembraneEdges(m, v, V + 2 * at, e);
    for (PetscInt k = 0; k < LayoutCount(m->layout, v); k++)
      d[at + k] = (tau[2 * k] * e[2 * k] + tau[2 * k + 1] * e[2 * k + 1]) / law->h2;
    for (PetscInt k = at; k < at + LayoutCount(m->layout, v) && law->c && sigma; k++)
      d[k] -= law->c[k] * sigma[k] / law->h2;
  }
}

PetscErrorCode LawTarget(MembraneLaw law, PetscReal a0, Vec Xhat, Vec T, Vec g) {
  const Membrane m = law->membrane;
  const PetscScalar *t;
  PetscScalar *X, *hat = m->work.stretching, *passed = m->work.memory, *d;
  PetscFunctionBeginUser;
  if (T) {
    PetscCall(VecGetArrayRead(T, &t));
    LawRows(law, t, NULL, passed);
    PetscCall(VecRestoreArrayRead(T, &t));
  }
  PetscCall(VecGetArrayPair(Xhat, g, &X, &d));
  for (PetscInt v = law->vesicle; v < law->end; v++) {
    const PetscInt at = LawOffset(law, v);
    const PetscReal ds = m->ds[v], rate = MembraneStretches(m, v) ? law->a0 : a0;
    MembraneEdges(m, v, X + 2 * at, hat);
    for (PetscInt k = 0; k < LayoutCount(m->layout, v); k++) {
      PetscReal star2 = 0, gap = 0;
      for (int c = 0; c < 2; c++) {
        const PetscReal e = ds * law->tau[2 * (at + k) + c];
        star2 += e * e;
        gap += e * (hat[2 * k + c] - e);
      }
      const PetscReal aim = rate * (0.5 * (ds * ds - star2) - gap) / (ds * law->h2);
      d[at + k] += law->c ? (1 - law->viscous[at + k]) * (aim - rate * ds * law->excess[at + k] / law->h2) : aim;
      if (T) d[at + k] -= law->viscous[at + k] * passed[at + k];
    }
  }
  PetscCall(VecRestoreArrayPair(Xhat, g, &X, &d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void LawScale(MembraneLaw law, PetscReal weight, PetscBool inverse, PetscScalar d[]) {
  const Membrane m = law->membrane;
  for (PetscInt v = law->vesicle; v < law->end; v++) {
    for (PetscInt k = LawOffset(law, v); k < LawOffset(law, v + 1); k++) {
      const PetscReal factor = law->h2 / m->ds[v] * weight / (1 + (law->c ? weight * law->c[k] : 0));
      d[k] = inverse ? d[k] / factor : d[k] * factor;
    }
  }
}

PetscErrorCode LawLargest(MembraneLaw law, Vec V, Vec sigma, Vec g, PetscReal *largest) {
  const PetscScalar *v, *s, *aim;
  PetscScalar *d;
  PetscReal own = 0;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(V, &v));
  PetscCall(VecGetArrayRead(sigma, &s));
  PetscCall(VecGetArrayRead(g, &aim));
  PetscCall(PetscMalloc1(law->n, &d));
  LawRows(law, v, s, d);
  for (PetscInt w = law->vesicle; w < law->end; w++)
    for (PetscInt k = LawOffset(law, w); k < LawOffset(law, w + 1); k++)
      own = PetscMax(own, PetscAbsReal(d[k] - aim[k]) * law->h2 / law->membrane->ds[w]);
  PetscCall(PetscFree(d));
  PetscCall(VecRestoreArrayRead(g, &aim));
  PetscCall(VecRestoreArrayRead(sigma, &s));
  PetscCall(VecRestoreArrayRead(V, &v));
  PetscCallMPI(MPI_Allreduce(&own, largest, 1, MPIU_REAL, MPI_MAX, law->membrane->layout->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The edges of a unit at one marker are those of all others, shifted. */
PetscErrorCode LawBlock(MembraneLaw law, PetscInt v, PetscReal D[]) {
  const PetscInt n = LayoutCount(law->membrane->layout, v);
  const PetscReal *tau = law->tau + 2 * LawOffset(law, v);
  PetscReal *unit, *first;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * n, &unit, 2 * n, &first));
  unit[0] = 1;
  MembraneEdges(law->membrane, v, unit, first);
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt j = 0; j < n; j++)
      for (int c = 0; c < 2; c++)
        D[(k * n + j) * 2 + c] = tau[2 * k + c] * first[2 * (k < j ? k - j + n : k - j)] / law->h2;
  PetscCall(PetscFree2(unit, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LawSchur(MembraneLaw law, const PetscReal K[], PetscReal C[]) {
  const PetscInt n = law->n;
  PetscReal *D, trace = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n * n, &D));
  for (PetscInt v = law->vesicle; v < law->end; v++) {
    const PetscInt own = LawOffset(law, v), nv = LayoutCount(law->membrane->layout, v);
    const DenseView columns = {K + 2 * own, 2 * nv, n, 2 * n};
    PetscCall(LawBlock(law, v, D));
    PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){D, 2 * nv, nv, 2 * nv}, columns, 0, C + own, n));
  }
  for (PetscInt k = 0; k < n; k++) trace += C[k * n + k];
  for (PetscInt k = 0; k < n; k++) C[k * n + k] += REGULAR * trace / n;
  for (PetscInt k = 0; k < n && law->c; k++) C[k * n + k] += law->c[k] / law->h2;
  PetscCall(PetscFree(D));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LawTargetAreas(MembraneLaw law, PetscReal a0, Vec Xstar, Vec Xhat, Vec background) {
  const Membrane m = law->membrane;
  const PetscScalar *star, *hat, *u;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(Xstar, &star));
  PetscCall(VecGetArrayRead(Xhat, &hat));
  PetscCall(VecGetArrayRead(background, &u));
  for (PetscInt v = law->vesicle; v < law->end; v++) {
    const PetscInt at = 2 * LawOffset(law, v), n = 2 * LayoutCount(m->layout, v);
    PetscReal *z = law->z + at, size = 0, speed = 0;
    Measures measures;
    MembraneMeasure(m, v, star + at, &measures);
    MembraneAreaGradient(m, v, star + at, z);
    for (PetscInt k = 0; k < n; k++) size += PetscSqr(z[k]);
    size = PetscSqrtReal(size);
    for (PetscInt k = 0; k < n; k++) {
      z[k] /= size;
      speed += z[k] * (a0 * (star[at + k] - hat[at + k]) - u[at + k]);
    }
    law->speed[v - law->vesicle] = speed + a0 * (m->A0[v] - measures.area) / size;
  }
  PetscCall(VecRestoreArrayRead(background, &u));
  PetscCall(VecRestoreArrayRead(Xhat, &hat));
  PetscCall(VecRestoreArrayRead(Xstar, &star));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void LawReplaceAreas(MembraneLaw law, PetscBool aimed, const PetscScalar V[], PetscScalar y[]) {
  for (PetscInt v = law->vesicle; v < law->end && law->ratio; v++) {
    const PetscInt at = 2 * LawOffset(law, v), n = 2 * LayoutCount(law->membrane->layout, v);
    const PetscReal *z = law->z + at;
    PetscReal along = 0, off = aimed ? -law->speed[v - law->vesicle] : 0;
    for (PetscInt k = 0; k < n; k++) {
      along += z[k] * y[at + k];
      off += z[k] * V[at + k];
    }
    for (PetscInt k = 0; k < n; k++) y[at + k] += (law->ratio[v - law->vesicle] * off - along) * z[k];
  }
}

PetscErrorCode LawRestore(MembraneLaw law, PetscInt v, PetscBool lengths, PetscScalar X[], PetscReal *shift,
                          PetscReal *error) {
  const Membrane m = law->membrane;
  const PetscReal tolerance = law->ratio ? EDGE_TOLERANCE : EDGE_TOLERANCE_WITHOUT_AREA;
  PetscFunctionBeginUser;
  *error = 0;
  *shift = law->ratio ? MembraneRestoreArea(m, v, X) : 0;
  if (!lengths || MembraneStretches(m, v) || PetscAbsReal(*shift) > 0.5 * m->ds[v]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MembraneRestoreEdges(m, v, tolerance, X, error));
  if (*error == 0 && law->ratio) PetscCall(MembraneRestoreLength(m, v, LENGTH_TOLERANCE, X));
  PetscFunctionReturn(PETSC_SUCCESS);
}
