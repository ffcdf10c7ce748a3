/* What a step amounts to in numbers: the row of series.csv, the rows of the vesicles, and the run's totals. */
#pragma once
#include "scheme/scheme.h"

/* Columns of series.csv, in order; NULL past the last. */
PETSC_EXTERN const char *const SeriesColumns[];
enum {
  COLUMN_STEP,
  COLUMN_TIME,
  COLUMN_DT,
  COLUMN_KINETIC,
  COLUMN_BENDING,
  COLUMN_AREA,
  COLUMN_LENGTH,
  COLUMN_AREA_ERROR,
  COLUMN_LENGTH_ERROR,
  COLUMN_EDGE_RATIO,
  COLUMN_DIV,
  COLUMN_SURFACE_DIV,
  COLUMN_CENTER_X,
  COLUMN_CENTER_Y,
  COLUMN_INCLINATION,
  COLUMN_FREQUENCY,
  COLUMN_TENSION_ITS,
  COLUMN_BENDING_ITS,
  COLUMN_COUPLED_ITS,
  COLUMN_NSOLVE,
  COLUMN_WALL,
  COLUMN_AREA_SHIFT,
  COLUMN_NORMAL_SPEED,
  COLUMN_VELOCITY_X,
  COLUMN_VELOCITY_Y,
  COLUMN_GRAVITY,
  COLUMN_GAP,
  COLUMN_CONTACT,
  COLUMN_VISCOSITY_WALL,
  COLUMN_VISCOSITY,
  COLUMN_NORMAL_WALL,
  COLUMN_NORMAL,
  COLUMN_COUNT
};

/* RecordVesicleColumns - those that vesicles have of their own; -1 past the last. Up to RECORD_FEW vesicles they are in
   series.csv, with a suffix each, and in vesicles.h5 above. */
#define RECORD_FEW 40
PETSC_EXTERN const int RecordVesicleColumns[];

typedef struct {
  PetscInt vesicles, solids;    /* vesicles; columns of obstacles */
  PetscReal last[COLUMN_COUNT]; /* the last row, over all vesicles */
  PetscReal *each;              /* [vesicles][COLUMN_COUNT] the vesicles' own columns of it */
  PetscReal *solid;             /* [solids] the obstacles' columns of it, the last ones in series.csv */
  char *header, *text;          /* the names and the last row as lines of series.csv, without the line's end */
  size_t room;                  /* of each of the two: it grows with the vesicles */
  PetscInt solves, tension, bending, coupled; /* sums over the run */
  PetscReal cfl_max;                          /* largest of a step */
} Record;

/* RecordCreate - zero, with the header for so many vesicles and for these obstacles. */
PETSC_EXTERN PetscErrorCode RecordCreate(PetscInt vesicles, const SceneObstacles *obstacles, Record *record);
PETSC_EXTERN PetscErrorCode RecordDestroy(Record *record);

/* RecordMeasure - the vesicles' own columns of the present state, into `each`, and the least gap of all. Collective. */
PETSC_EXTERN PetscErrorCode RecordMeasure(Record *record, Scheme scheme);

/* RecordTake - the row of the scheme's state and last step, which is added to the totals. Collective. */
PETSC_EXTERN PetscErrorCode RecordTake(Record *record, Scheme scheme);

/* RecordFits - whether the text is a row of as many numbers as the header has names, of this step and time. Not
   collective. */
PETSC_EXTERN PetscBool RecordFits(const Record *record, PetscInt step, PetscReal t);

/* RecordParse - the last row from its text; a text that is too long for so many vesicles is cut. */
PETSC_EXTERN PetscErrorCode RecordParse(Record *record, const char text[]);
