/* The near field: what the grid's kernel and lattice take from the markers' velocity is given back (docs/nearfield.md),
   U = u_inf + E u + C (f ds),      C = S - L, S the exact free-space single layer, L = E G E^T/h^2 the mobility of the
   same kernel on the infinite lattice. The grid's own mobility is L and a smooth part of walls and images, so kernel,
   angle to the grid, place in the cells and spacing of the markers cancel. Pairs of markers of one vesicle, and of
   vesicles near one another, images included; each pair with its images in the grid's walls (nearimage.h). In unbounded
   fluid there is no grid to take from: C = S, of all pairs. */
#pragma once
#include "coupling/boxpart.h"
#include "coupling/lattice.h"
#include "coupling/neardistant.h"
#include "coupling/nearfar.h"
#include "coupling/nearimage.h"
#include "coupling/bodies.h"

/* C of an own vesicle with one that is near, moved by `shift` (length): each pair of vesicles or images once, in rows,
   two for each marker of the row's vesicle, its x and its y velocity, with columns interlaced, which are the columns of
   that marker's force on the others too. A vesicle's block with itself has of each row what is right of the diagonal,
   and of a marker with itself the half. */
typedef struct {
  PetscInt row, column; /* vesicles */
  PetscReal shift[2];
  PetscBool single; /* in single precision */
  size_t at;        /* in the store's value, or single */
} NearBlock;

/* An image of the block's column so near to its row that both need finer points. */
typedef struct {
  PetscInt block;
  PetscReal shift[2], gap; /* length */
} NearClose;

/* The blocks' values in double and in single precision: in use, and room. */
typedef struct {
  PetscReal *value;
  float *single;
  size_t values, value_room, singles, single_room;
} NearStore;

/* What two obstacles that rest do to one another, which stays as it is: the first blocks of the list, with their close
   images and values, and distant pairs. */
typedef struct {
  PetscInt blocks, closes;
  size_t values, singles;
  NearDistant distant;
  PetscBool made;
} NearFixed;

typedef struct _p_NearField *NearField;
struct _p_NearField {
  Markers markers;    /* borrowed */
  Bodies bodies;      /* borrowed */
  PetscReal nu, unit; /* NearLogarithm */
  PetscBool free;     /* unbounded fluid: C = S */
  OffsetTable lattice;
  NearImage image;         /* what the walls add to each pair, from a table that is this one's */
  NearFar far[2];          /* distant pairs of one vesicle, of two */
  PetscReal **kress;       /* [bodies][n] by index difference, what the curve's quadrature has besides the plain
                              logarithm, at 0 its weight; NULL for others' bodies */
  PaddedStencil *stencil;  /* [2M] */
  PetscReal *fourth[2][2]; /* [M], whole vectors: a component's fourth moment along x and along y, less the mean */
  NearBounds *bounds;      /* [vesicles] */
  NearBlock *block;        /* fixed ones, then others in the order of their rows */
  NearClose *close;
  NearStore store;
  NearFixed fixed;
  PetscInt blocks, block_room, closes, close_room; /* in use, and made */
  PetscBool crossed;                               /* whether any rank has a pair with another rank's marker */
  PetscScalar *force;                              /* [2M] work */
  PetscScalar *velocity;                           /* [2n] work */
  BoxPart box;                                     /* NULL without */
  PetscLogEvent event[2];                          /* place, apply */
};

/* NearFieldCreate - for bodies whose markers are on a grid, in a fluid of viscosity nu. Collective. */
PETSC_EXTERN PetscErrorCode NearFieldCreate(Markers markers, Bodies bodies, PetscReal nu, NearField *near);
PETSC_EXTERN PetscErrorCode NearFieldDestroy(NearField *near);

/* NearFieldPlace - C of the own vesicles where the markers have been placed (MarkersPlace). Collective. */
PETSC_EXTERN PetscErrorCode NearFieldPlace(NearField near);

/* NearFieldAddBoxPart - from here on with the box part, for the fluid that spec makes. Collective. */
PETSC_EXTERN PetscErrorCode NearFieldAddBoxPart(NearField near, const FluidSpec *spec);

/* NearFieldCreateBoxPart - BoxPartCreate with the near field's markers and lattice. Collective. */
PETSC_EXTERN PetscErrorCode NearFieldCreateBoxPart(NearField near, const FluidSpec *spec, PetscBool whole,
                                                   BoxPart *box);

/* NearFieldApply - U += alpha (C + D) F, D the box part if there is one, own parts F[2n] and U[2n] of marker vectors; F
   is a force times ds (length^3/time^2 with density 1). Collective. */
PETSC_EXTERN PetscErrorCode NearFieldApply(NearField near, PetscReal alpha, const PetscScalar F[], PetscScalar U[]);

/* NearFieldAdd - out += scale (C + D), or scale C where the box part is not asked for, between the markers first ..
   first + n - 1, out[2n][2n] entries interlaced, the rows of own markers only. Not collective. */
PETSC_EXTERN PetscErrorCode NearFieldAdd(NearField near, PetscReal scale, PetscBool box, PetscInt first, PetscInt n,
                                         PetscReal out[]);

/* NearFieldAddBetween - the same of the velocity of the markers in rows by forces on those in columns, out[2 n of
   columns][2 n of rows], each a range of whole bodies. Not collective. */
PETSC_EXTERN PetscErrorCode NearFieldAddBetween(NearField near, PetscReal scale, PetscBool box, const MarkerRange *rows,
                                                const MarkerRange *columns, PetscReal out[]);
