/* Where the unknowns of the scheme direct that are not the fluid's stand among the rows. Not collective. */
#pragma once
#include "scheme/direct.h"

/* Uniform forces g, of x first, that hold the mean velocity: of a periodic box in quasi-steady flow, where forces leave
   it free, or with obstacles, and of a channel without flux. */
static inline PetscInt MeanForces(DirectSolver d) {
  const Grid g = d->fluid->grid;
  if (g->wall[0]) return 0;
  return g->wall[1] ? d->fluid->zero_flux : 2 * (d->fluid->steady || d->fluid->held);
}

/* Rows of the vesicles' areas (directarea.c). */
static inline PetscInt AreaRows(DirectSolver d) {
  return d->coupling->area ? d->coupling->membrane->layout->bodies : 0;
}

/* Unknowns besides the fluid's: sigma, U, F, the obstacles' F, J, those of the areas, g. */
static inline PetscInt Others(DirectSolver d) {
  return (d->coupling->contrast ? 7 : 5) * d->M + 2 * d->W + AreaRows(d) + MeanForces(d);
}

/* Where these start, and the row of the q-th velocity of all bodies: the obstacles' stand beside their F. */
static inline PetscInt FirstSigma(DirectSolver d) {
  return d->start[d->fluid->grid->size] - Others(d);
}
static inline PetscInt FirstU(DirectSolver d) {
  return FirstSigma(d) + d->M;
}
static inline PetscInt FirstF(DirectSolver d) {
  return FirstSigma(d) + 3 * d->M;
}
static inline PetscInt FirstJ(DirectSolver d) {
  return FirstF(d) + 2 * (d->M + d->W);
}
static inline PetscInt FirstMean(DirectSolver d) {
  return d->start[d->fluid->grid->size] - MeanForces(d);
}
static inline PetscInt FirstArea(DirectSolver d) {
  return FirstMean(d) - AreaRows(d);
}
static inline PetscInt RowOf(DirectSolver d, PetscInt q) {
  return (q < 2 * d->M ? FirstU(d) : FirstF(d)) + q;
}
