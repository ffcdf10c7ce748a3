/* Everything that a run leaves on disk (DESIGN section 12), all in -output_dir, and what it prints. */
#pragma once
#include "output/h5.h"
#include "scheme/scheme.h"

typedef struct _p_Output *Output;
struct _p_Output {
  MPI_Comm comm;
  PetscMPIInt rank;
  Scene scene;   /* borrowed */
  Scheme scheme; /* borrowed */
  char folder[PETSC_MAX_PATH_LEN];
  FILE *series;                  /* rank 0 */
  hid_t fields;                  /* run.h5 */
  PetscInt frames;               /* saved times so far */
  PetscReal *times;              /* of the saved frames, rank 0 */
  PetscScalar *cells;            /* one cell-centred field, this rank's rows */
  PetscReal last[24];            /* the last row of series.csv, in the order of SeriesColumns */
  PetscReal *each;               /* [vesicles][COLUMN_COUNT] the vesicles' own columns of it */
  PetscBool quiet;               /* nothing on the terminal */
  PetscLogDouble start, printed; /* wall time at the start, at the last progress line */
  PetscInt total_solves, total_tension, total_bending, total_coupled;
};

/* OutputCreate - make the folder, open series.csv and run.h5, write resolved.opts. Collective. */
PETSC_EXTERN PetscErrorCode OutputCreate(Scene scene, Scheme scheme, Output *output);

/* OutputDestroy - close every file. Collective. */
PETSC_EXTERN PetscErrorCode OutputDestroy(Output *output);

/* OutputPath - name of a file in the folder. */
PETSC_EXTERN PetscErrorCode OutputPath(Output output, const char file[], char path[PETSC_MAX_PATH_LEN]);

/* OutputCheckFile - stop every rank with one line when rank 0 could not write a file (f NULL or closing it fails, as on
   a full disk). Collective; the other ranks pass NULL. */
PETSC_EXTERN PetscErrorCode OutputCheckFile(Output output, FILE *f, const char path[]);

/* OutputSeries - add the scheme's state and last step to series.csv. Collective. */
PETSC_EXTERN PetscErrorCode OutputSeries(Output output);

/* OutputFields - add the present fields and markers to run.h5 and run.xmf. Collective. */
PETSC_EXTERN PetscErrorCode OutputFields(Output output);

/* OutputVelocityAtCells - component c of the velocity w (local array) at this rank's cell centres: mean of the cell's
   two faces, plus the background at the flow's time; cells[rows][nx]. Collective. */
PETSC_EXTERN PetscErrorCode OutputVelocityAtCells(Output output, int c, const PetscScalar w[], PetscScalar cells[]);

/* OutputCheckpoint - write checkpoint.h5: to a temporary name, then renamed. Collective. */
PETSC_EXTERN PetscErrorCode OutputCheckpoint(Output output);

/* OutputSummary - write summary.json; reason: why the run ended ("finished", "steady", or the failure). Collective. */
PETSC_EXTERN PetscErrorCode OutputSummary(Output output, const char reason[]);

/* OutputProgress - a line with step, time, percent and expected time left, at most every few seconds unless `force`. */
PETSC_EXTERN PetscErrorCode OutputProgress(Output output, PetscBool force);

/* OutputFinalTable - the summary that a run ends with, on the terminal. */
PETSC_EXTERN PetscErrorCode OutputFinalTable(Output output, const char reason[]);

/* Parts of OutputCreate, one a file. */
PETSC_EXTERN PetscErrorCode SeriesCreate(Output output);
PETSC_EXTERN PetscErrorCode FieldsCreate(Output output);
PETSC_EXTERN PetscErrorCode OutputResolvedOptions(Output output);
PETSC_EXTERN PetscErrorCode OutputXdmf(Output output);

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
  COLUMN_COUNT
};
