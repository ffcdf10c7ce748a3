/* The smooth part of a grid's mobility between places (docs/nearfield.md, Box part),

       W = E A^-1 E^T/h^2 - L,

   what walls and periodic images add to the infinite lattice, L of the nearest image times a window over a period. It
   is measured: a Stokes solve for each source on a grid of its own, in quasi-steady flow. Each rank has such a grid and
   solves for some of the sources; the caller sums over ranks. */
#pragma once
#include "layers/boxaxis.h"
#include "layers/imagetable.h"
#include "layers/latticegreen.h"
#include "fluid/stokes/fluid.h"

#define BOX_LATTICE_CELLS 30 /* reach of the lattice's tables; farther its closed form is right to 2e-7 */

/* The lattice's answers to the sources, borrowed: of forces, or (dipole not NULL) of dipoles. Tables reach
   BOX_LATTICE_CELLS and OFFSET_LAGS. */
typedef struct {
  PetscReal unit; /* NearLogarithm */
  const OffsetTable *stokeslet;
  const ImageTable *half;    /* in front of a wall; NULL without walls */
  const OffsetTable *dipole; /* [2] */
  PetscBool whole;           /* the smooth part itself is wanted: less the exact images in walls */
} BoxLattice;

/* BoxGridSpec - the run's fluid for tables and preconditioners: by the default solver, which cannot fail, whatever
   solves the steps. Not collective. */
static inline FluidSpec BoxGridSpec(const FluidSpec *run) {
  FluidSpec spec = *run;
  spec.form = FORM_DISTURBANCE;
  (void)PetscStrncpy(spec.helmholtz, "fftw_tridiagonal", sizeof(spec.helmholtz));
  (void)PetscStrncpy(spec.poisson, "fftw_tridiagonal", sizeof(spec.poisson));
  return spec;
}

/* BoxGridAdd - W += scale times the smooth part of the grid `spec`, with the named kernel, its lattice as far as it is
   tabulated and the closed form beyond. W[2][parts][x pairs][y pairs], of a velocity component to a force component
   (velocity per force) or to a part of a tensor (velocity per tensor), whose source is spread over the whole box as
   well. Every rank adds the sources that are its own: the sum over ranks is the whole. Not collective. */
PETSC_EXTERN PetscErrorCode BoxGridAdd(const FluidSpec *spec, MPI_Comm comm, const char kernel[],
                                       const BoxLattice *lattice, const BoxAxis axis[2], PetscReal scale,
                                       PetscReal W[]);
