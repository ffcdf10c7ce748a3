/* The coupled problem by a sparse LU: what the solution of the scheme coupled is compared with. On one rank. */
#pragma once
#include "check.h"
#include "krylov/solver.h"

/* DirectSolve - [H + B E/a0, G, S; G^T; S^T] with the near field, at the coupling's markers, p of zero mean. The
   markers' velocity V and the force F = Dm^T sigma/h^2 + (c_b ds/(h^2 a0)) D4 V on them are unknowns of their own, as
   are the obstacles' F and the jump of a viscosity contrast, so that the matrix is sparse. Takes what is
   known, g and k of the problem, f with the states before it, and changes f and k; gives w, p, sigma, V and solid. */
void DirectSolve(Coupling coupling, const CoupledProblem *problem, Vec w, Vec p);

/* Where the unknowns stand: the fields of the grid, then tension, V of the vesicles' markers, F of the vesicles' and of
   the obstacles' markers, the jump, areas, and uniform forces g that hold the mean velocity. */
typedef enum {
  PART_SIGMA = FIELD_P + 1,
  PART_V,
  PART_F,
  PART_SOLID,
  PART_JUMP,
  PART_AREA,
  PART_MEAN,
  PARTS
} DirectPart;

/* The matrix while it is assembled. */
typedef struct {
  Coupling c;
  Fluid fluid;
  Grid grid;
  PetscInt first[PARTS + 1]; /* index of the first unknown of each part, and of its row */
  Mat A;
} Direct;

/* DirectAdd - a value on top of what the entry has. */
void DirectAdd(Direct *d, PetscInt row, PetscInt column, PetscReal value);

/* DirectAddContrast - B V in the rows of V, the double layer in those of obstacles, J - Q (1 - ratio) (V +
   (treading/a0) dV/dt) = 0, the dipoles of J in the momentum and the divergence, and in the rows of the mean velocity.
 */
void DirectAddContrast(Direct *d);

static inline PetscInt DirectIndex(const Direct *d, int field, PetscInt i, PetscInt j) {
  return d->first[field] + j * d->grid->columns[field] + i;
}

/* An entry beside the grid across a periodic seam, on the grid. */
static inline PetscInt DirectEntry(Grid g, int dir, PetscInt entry) {
  return g->wall[dir] ? entry : (entry + g->n[dir]) % g->n[dir];
}

/* The row of the q-th velocity of all bodies: the obstacles' stand beside their F. */
static inline PetscInt DirectRow(const Direct *d, PetscInt q) {
  const PetscInt n = d->first[PART_F] - d->first[PART_V];
  return q < n ? d->first[PART_V] + q : d->first[PART_SOLID] + q - n;
}

/* Uniform forces that hold the mean velocity: of a periodic box in quasi-steady flow, where forces leave it free, or
   with obstacles, and of a channel without flux. */
static inline PetscInt DirectMeans(const Direct *d) {
  if (d->grid->wall[0]) return 0;
  return d->grid->wall[1] ? d->fluid->zero_flux : 2 * (d->fluid->steady || d->fluid->held);
}
