/* The parts of a solve by stream function (stream.c): up all rows with the forces, down them with the velocity. */
#pragma once
#include "fluid/sidewalls.h"
#include "fluid/stream.h"
#include "fluid/streamslabs.h"
#include "fluid/tridiagonal.h"

#define STREAM_BLOCK TRIDIAGONAL_BLOCK

struct _p_Stream {
  Fluid fluid;
  ZeroFlux flux;            /* borrowed, or NULL */
  RowTransform t;           /* along the nodes of a row */
  StreamFactors factors;    /* of the recurrences */
  StreamSlabs slabs;        /* what they leave */
  SideWalls side;           /* NULL where x is periodic */
  PetscInt *fed;            /* [blocks] the last row with y of a block, on the way down */
  PetscInt felt;            /* blocks of Z in the last row */
  PetscScalar *row[3];      /* [n_x] two rows of u's force or of chi, one of v */
  PetscScalar *curl, *zero; /* [n_x] */
  Tridiagonal mean;         /* of u's row means: one mode; NULL between walls, where there are none */
  PetscReal one[2];         /* its eigenvalue and its scale */
  PetscReal *means, mean_v; /* [rows of u] mode 0 of u, and of v */
  StreamMeter meter;
  StreamFlows flows;
  PetscScalar *flow; /* of the solve under way, where it is wanted */
};

/* What is added to the mean of row `at` of all. */
static inline PetscReal StreamGiven(const StreamRows *rows, Field f, PetscInt at) {
  return rows->mean[f] ? rows->mean[f][at] : 0;
}

/* StreamGather - y of all own rows from the forces, with nothing coming in from below. StreamBeginDown - then all has
   been closed: the rows are asked for downwards. StreamNodeModes - the next row of nodes, j: modes of chi/h, so many;
   in `into` unless that is NULL; squares: the meter gets them. StreamScatter - down all rows, or to the last one that
   is wanted: velocities, flow and what is measured. Not collective. */
PETSC_EXTERN void StreamGather(Stream stream, const StreamRows *rows, PetscBool measured);
PETSC_EXTERN void StreamBeginDown(Stream stream);
PETSC_EXTERN PetscInt StreamNodeModes(Stream stream, PetscInt j, PetscBool squares, PetscReal *into, PetscReal **modes);
PETSC_EXTERN void StreamScatter(Stream stream, const StreamRows *rows, PetscBool measured);
