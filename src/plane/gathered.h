/* Values of all ranks for writers of files, the restart and callers: the vectors of a state on markers, on every rank,
   and rows of the grid, on rank 0. */
#pragma once
#include "scheme/scheme.h"

/* A vector of a state on markers. */
typedef enum {
  STATE_MARKERS,
  STATE_VELOCITY,
  STATE_TENSION,
  STATE_SOLIDS,
  STATE_RATES,
  STATE_PLACES,
  STATE_PARTS
} StatePartName;
typedef struct {
  const char *name; /* in files */
  PetscInt each;    /* numbers a marker, or 1 */
  Layout layout;    /* of the vesicles, the obstacles or the free bodies; NULL: every rank has all numbers */
  Vec vector;
  PetscInt n;     /* markers; 0: the state has no such vector */
  PetscInt first; /* where the rank's numbers begin in its part of the vector */
} StatePart;

/* StatePartOf - a vector of a state of the scheme; not collective. StateGather - values[n][each] of all ranks, on every
   rank; StateScatter - every rank takes its own of the values. Collective. */
PETSC_EXTERN StatePart StatePartOf(Scheme scheme, const State *state, StatePartName name);
PETSC_EXTERN PetscErrorCode StateGather(const StatePart *part, PetscReal values[]);
PETSC_EXTERN PetscErrorCode StateScatter(const StatePart *part, const PetscReal values[]);

/* StateShow - StateGather of the scheme's state for frames and callers, who see the tension where STATE_TENSION is the
   law's unknown, the tension over the stretch (bodies/law.h). StateStretch - the stretch [M] of the edges. Collective.
 */
PETSC_EXTERN PetscErrorCode StateShow(Scheme scheme, StatePartName name, PetscReal values[]);
PETSC_EXTERN PetscErrorCode StateStretch(Scheme scheme, PetscReal stretch[]);

/* RowsLayout - the rows of a field of the grid, `each` numbers in a row, as a layout for LayoutToRank and
   LayoutFromRank with one number a marker. Not collective. */
PETSC_EXTERN PetscErrorCode RowsLayout(Grid grid, Field field, PetscInt each, Layout *rows);
