/* Which rank owns which markers.

   Bodies are curves of markers, numbered one after another. Each body belongs to one rank, and ranks own contiguous
   ranges of bodies of about equal work. Marker vectors (two numbers a marker) and edge vectors (one number a marker,
   such as a tension) are MPI vectors in the order of the bodies: the part of a rank is that of its bodies. So what a
   body needs of itself is on its owner; what others need of it is gathered. */
#pragma once
#include "base/base.h"

typedef struct _p_Layout *Layout;
struct _p_Layout {
  MPI_Comm comm;
  PetscMPIInt rank, size;
  PetscInt bodies, M;            /* bodies and markers of all ranks */
  PetscInt *start;               /* [bodies+1] first marker of each body */
  PetscInt *body;                /* [ranks+1] first body of each rank */
  PetscInt own, end;             /* this rank's bodies: own .. end - 1 */
  PetscInt first, n;             /* this rank's markers: first .. first + n - 1 */
  PetscMPIInt *count[3], *at[3]; /* [ranks] length and start of each rank's part, with one to three numbers a marker */
};

/* LayoutCreate - for bodies whose first markers are start[bodies+1]. body[ranks+1]: first body of each rank; NULL: by
   equal work, where that of a body is the square of its markers, like that of products with its dense matrices. Both
   arrays are copied. Not collective. */
PETSC_EXTERN PetscErrorCode LayoutCreate(MPI_Comm comm, PetscInt bodies, const PetscInt start[], const PetscInt body[],
                                         Layout *layout);

/* LayoutCreatePart - the bodies first .. end - 1 of a layout, on the same ranks, numbered from 0 on. Not collective. */
PETSC_EXTERN PetscErrorCode LayoutCreatePart(Layout all, PetscInt first, PetscInt end, Layout *layout);
PETSC_EXTERN PetscErrorCode LayoutDestroy(Layout *layout);

/* LayoutCreateVec - zero vector with `each` (1 to 3) numbers a marker. Collective. */
PETSC_EXTERN PetscErrorCode LayoutCreateVec(Layout layout, int each, Vec *x);

/* LayoutOwner - the rank that a body belongs to. Not collective. */
PETSC_EXTERN PetscMPIInt LayoutOwner(Layout layout, PetscInt body);

/* LayoutCount - number of markers of a body. LayoutOffset - where the markers of one of this rank's bodies start in
   this rank's part of an edge vector; in a marker vector they start at twice that. Not collective. */
static inline PetscInt LayoutCount(Layout layout, PetscInt body) {
  return layout->start[body + 1] - layout->start[body];
}
static inline PetscInt LayoutOffset(Layout layout, PetscInt body) {
  return layout->start[body] - layout->first;
}

/* Markers first .. first + n - 1. */
typedef struct {
  PetscInt first, n;
} MarkerRange;

/* LayoutBody - the body that a marker belongs to. Not collective. */
static inline PetscInt LayoutBody(Layout layout, PetscInt marker) {
  PetscInt place;
  (void)PetscFindInt(marker, layout->bodies, layout->start, &place);
  return place < 0 ? -place - 2 : place; /* negative: minus 1 plus the number of first markers that are not larger */
}

/* LayoutGather - own[each n] of every rank to all[each M] of every rank. LayoutGatherVec - a marker or edge vector to
   all[] of every rank. LayoutSum - the sum over ranks of part[each M] to own[each n] of the owners. Collective. */
PETSC_EXTERN PetscErrorCode LayoutGather(Layout layout, int each, const PetscScalar own[], PetscScalar all[]);
PETSC_EXTERN PetscErrorCode LayoutGatherVec(Layout layout, Vec x, PetscScalar all[]);
PETSC_EXTERN PetscErrorCode LayoutSum(Layout layout, int each, const PetscScalar part[], PetscScalar own[]);

/* LayoutToRank - own[each n] of every rank to all[each M] of rank `root`. LayoutFromRank - all[each M] of rank `root`
   to own[each n] of every rank. `all` is not touched on other ranks. Collective. */
PETSC_EXTERN PetscErrorCode LayoutToRank(Layout layout, PetscMPIInt root, int each, const PetscScalar own[],
                                         PetscScalar all[]);
PETSC_EXTERN PetscErrorCode LayoutFromRank(Layout layout, PetscMPIInt root, int each, const PetscScalar all[],
                                           PetscScalar own[]);
