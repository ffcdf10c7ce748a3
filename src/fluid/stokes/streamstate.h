/* The parts of a solve by stream function (stream.h) and the rows of forces and velocities that it is given: what its
   way up (sweepup.c) and its way down (sweepdown.c) share. Each rank has the rows of its slab. */
#pragma once
#include "fluid/stokes/fluid.h"
#include "fluid/stokes/sidewalls.h"
#include "fluid/stokes/streamflow.h"
#include "fluid/stokes/streammeter.h"
#include "fluid/transforms/tridiagonal.h"

typedef struct _p_Stream *Stream;

/* Where rows come from and where they go to. Rows are this rank's; row j of a field of forces is asked for once, in
   order, each row of u before that of v with the same number; of u the row above the last, too, if there is one (the
   next rank's first; row 0 on one rank). */
typedef struct {
  void *ctx;
  PetscInt forced[2]; /* forces are zero outside rows forced[0] .. forced[1] - 1 of u and v, and are not asked for but
                         in the row below; all rows where there is one next to a seam in y */
  PetscInt wanted[2]; /* velocities are not wanted outside rows wanted[0] .. wanted[1] - 1; all: 0, rows of u */
  const StreamPast *past; /* a further force, of states before, and what of it is in the velocities; NULL: none */
  Vec flow;               /* becomes the flow of the velocity; NULL: not wanted */
  PetscBool add;          /* the flow of the velocity is added to `flow` */
  const PetscScalar *(*force)(void *ctx, Field f, PetscInt j,
                              PetscScalar work[]);                     /* may be work[n_x], which it fills */
  void (*velocity)(void *ctx, Field f, PetscInt j, PetscScalar row[]); /* downwards; to u it may add what it has */
  const PetscReal *mean[2];  /* [rows of the whole grid] added to every u and v of a row, of v zero on walls in y,
                                of u zero between walls in x; may be NULL */
  const PetscScalar *source; /* [rows][n_x] G^T of the means and of what `velocity` adds; NULL: zero */
} StreamRows;

struct _p_Stream {
  Fluid fluid;
  RowTransform t;           /* along the nodes of a row */
  PetscReal alpha;          /* coefficient that `factors` are for; -1: none yet */
  ModeFactors factors;      /* constants of the recurrences */
  Slabs slabs;              /* y of the rows, and what comes into the slab */
  SideWalls side;           /* NULL where x is periodic */
  PetscInt *last;           /* [blocks] the last row on the way down in which a block has y */
  PetscInt kept;            /* blocks of modes in which Z of the last row has not decayed */
  PetscScalar *row[3];      /* [n_x] two rows of u's force or of chi, one of v */
  PetscScalar *curl, *zero; /* [n_x] */
  Tridiagonal mean;         /* the solve for the row means of u, one mode; NULL between walls in x, without means */
  PetscReal one[2];         /* eigenvalue and scale of that mode */
  PetscReal *means, mean_v; /* [rows of u] mode 0 of u, and of v */
  PetscReal *profile;       /* StreamProfile, then work; NULL unless a channel may carry no flux */
  PetscReal profile_alpha;  /* coefficient that the profile is for; -1: none yet */
  StreamMeter meter;
  StreamFlows flows;
  PetscScalar *flow; /* the flow that the solve under way makes; NULL: none */
};

/* StreamGather - the way up: y of all own rows from the forces, with nothing coming in from below. measured: the forces
   go to the meter too. Not collective. */
PETSC_EXTERN void StreamGather(Stream stream, const StreamRows *rows, PetscBool measured);

/* StreamBeginDown - start the way down at the uppermost row of the slab, after SlabsClose. StreamNodeModes - the
   modes of chi/h of row j of nodes, the next row downwards, and their number; they are written to `into` unless that is
   NULL. squares: the meter gets them. Not collective. */
PETSC_EXTERN void StreamBeginDown(Stream stream);
PETSC_EXTERN PetscInt StreamNodeModes(Stream stream, PetscInt j, PetscBool squares, PetscReal *into, PetscReal **modes);

/* StreamScatter - the whole way down, or to the last row that is wanted: rows of velocity, their flow and what is
   measured. Not collective. */
PETSC_EXTERN void StreamScatter(Stream stream, const StreamRows *rows, PetscBool measured);

/* The mean that is added to row `at` of the whole grid. */
static inline PetscReal StreamGiven(const StreamRows *rows, Field f, PetscInt at) {
  return rows->mean[f] ? rows->mean[f][at] : 0;
}
