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
  H5File fields;                 /* run.h5 */
  PetscBool fields_open;         /* on every rank */
  FILE *index;                   /* rank 0: run.h5.index */
  PetscBool go_on;               /* both files go on after the checkpoint of -restart */
  PetscInt frames;               /* saved times so far */
  PetscInt scheduled;            /* of them those at multiples of -output_every, the first included */
  PetscReal *times;              /* of the saved frames */
  PetscScalar *cells;            /* one cell-centred field, this rank's rows */
  PetscReal last[24];            /* the last row of series.csv, in the order of SeriesColumns */
  PetscReal *each;               /* [vesicles][COLUMN_COUNT] the vesicles' own columns of it */
  PetscBool quiet;               /* nothing on the terminal */
  char *row;                     /* the same with all columns, as text */
  const char *reason;            /* why the run ended */
  PetscInt saved_step;           /* of the newest checkpoint.h5 that this run wrote or started from; -1 none */
  PetscReal checkpoint_seconds;  /* longest that writing one has taken */
  PetscLogDouble start, printed; /* wall time at the start, at the last progress line */
  PetscInt total_solves, total_tension, total_bending, total_coupled;
  PetscReal cfl_max; /* largest of a step */
};

/* OutputCreate - make the folder, open series.csv and run.h5, write resolved.opts. The folder may hold results already
   with -output_overwrite only, or when -restart names a checkpoint in it: then (after RestartRead) both files go on
   after the checkpoint's step. Collective. */
PETSC_EXTERN PetscErrorCode OutputCreate(Scene scene, Scheme scheme, Output *output);

/* OutputDestroy - close every file. Collective. */
PETSC_EXTERN PetscErrorCode OutputDestroy(Output *output);

/* OutputPath - name of a file in the folder. */
PETSC_EXTERN PetscErrorCode OutputPath(Output output, const char file[], char path[PETSC_MAX_PATH_LEN]);

/* OutputWriteText - write a text file on rank 0 under a temporary name and rename it; stops every rank with one line
   when that fails. Collective. */
PETSC_EXTERN PetscErrorCode OutputWriteText(Output output, const char file[], PetscErrorCode (*write)(Output, FILE *));

/* OutputCheck - stop every rank with one line when rank 0 could not write a file. Collective. */
PETSC_EXTERN PetscErrorCode OutputCheck(Output output, PetscBool written, const char path[]);

/* OutputSync - 0 when all of a file is on the disk. Rank 0's. */
PETSC_EXTERN int OutputSync(const char path[]);

/* OutputSeries - add the scheme's state and last step to series.csv. Collective. */
PETSC_EXTERN PetscErrorCode OutputSeries(Output output);

/* OutputMeasureVesicles - the vesicles' own columns of the present state, into `each`. Collective. */
PETSC_EXTERN PetscErrorCode OutputMeasureVesicles(Output output);

/* OutputFields - add the present fields and markers to run.h5 and run.xmf; scheduled: a saved time of -output_every,
   not only the end of this run. Collective. */
PETSC_EXTERN PetscErrorCode OutputFields(Output output, PetscBool scheduled);

/* OutputVelocityAtCells - component c of the velocity w (local array) at this rank's cell centres: mean of the cell's
   two faces, plus the background at the flow's time; cells[rows][nx]. Collective. */
PETSC_EXTERN PetscErrorCode OutputVelocityAtCells(Output output, int c, const PetscScalar w[], PetscScalar cells[]);

/* OutputNextTime - the first multiple of -output_every after the present time. */
PETSC_EXTERN PetscReal OutputNextTime(Output output);

/* OutputCheckpoint - write checkpoint.h5: to a temporary name, with a checksum at its end, all of it and of series.csv
   and run.h5 on the disk, then renamed. The ones before it become checkpoint_1.h5 and so on. Does nothing when the
   present step has its checkpoint. Collective. */
PETSC_EXTERN PetscErrorCode OutputCheckpoint(Output output);

/* OutputSummary - write summary.json; reason: why the run ended ("finished", "steady", "stopped", or the failure).
   Collective. */
PETSC_EXTERN PetscErrorCode OutputSummary(Output output, const char reason[]);

/* OutputProgress - a line with step, time, percent and expected time left, at most every few seconds unless `force`. */
PETSC_EXTERN PetscErrorCode OutputProgress(Output output, PetscBool force);

/* OutputFinalTable - the summary that a run ends with, on the terminal. */
PETSC_EXTERN PetscErrorCode OutputFinalTable(Output output, const char reason[]);

/* Parts of OutputCreate. SeriesPrepare - the new series.csv, or the rows up to the checkpoint's step, under a temporary
   name. FieldsCreate - run.h5, new or cut to the checkpoint's frames. SeriesOpen - series.csv takes its name. So
   nothing of an earlier run is changed before all of it has been found good. */
PETSC_EXTERN PetscErrorCode SeriesPrepare(Output output);
PETSC_EXTERN PetscErrorCode FieldsCreate(Output output);
PETSC_EXTERN PetscErrorCode SeriesOpen(Output output);
PETSC_EXTERN PetscErrorCode OutputXdmf(Output output);

/* FieldsCreateFile - a file with the attributes and the empty series of run.h5. Collective. */
PETSC_EXTERN PetscErrorCode FieldsCreateFile(Output output, const char path[], H5File *file);

/* The series of a frame, and how many a run has (without vesicles the fluid's three). */
#define FRAME_SERIES 6
PETSC_EXTERN const char *const FrameSeries[FRAME_SERIES];
PETSC_EXTERN PetscInt FrameSeriesCount(Output output);

/* FramesOpen - write run.h5.index for the frames so far, and go on with it. FramesAppend - a further frame, whose
   values are in run.h5. Collective. FramesSync - 0 when all of it is on the disk. FramesClose - the end of it; closed:
   run.h5 is closed and whole, so that the index goes. Rank 0's. */
PETSC_EXTERN PetscErrorCode FramesOpen(Output output);
PETSC_EXTERN PetscErrorCode FramesAppend(Output output, PetscInt frame, PetscReal time);
PETSC_EXTERN int FramesSync(Output output);
PETSC_EXTERN PetscErrorCode FramesClose(Output output, PetscBool closed);

/* FramesRepair - where a run was killed (its index is there): run.h5 anew, of the frames that the checkpoint counts.
   Stops with one line when that cannot be written; frames that cannot be read leave run.h5 as it is. Collective. */
PETSC_EXTERN PetscErrorCode FramesRepair(Output output, const char path[]);

/* CheckpointAdopt - the checkpoint that -restart names in the folder becomes its newest: later ones belong to steps
   that are taken anew. */
PETSC_EXTERN PetscErrorCode CheckpointAdopt(Output output);

/* RestartRead - put the scheme into the state of -restart's checkpoint, and output's counts to where they were. Stops
   with one line when the checkpoint is missing, damaged, of another format or of another scene. Collective. */
PETSC_EXTERN PetscErrorCode RestartRead(Output output);

/* ChecksumOfFile - CRC-32 of the file up to its last `tail` bytes, which are copied to `end`; false when it cannot be
   read or is shorter. Rank 0's. */
#define CHECKPOINT_FORMAT 2
#define CHECKPOINT_TAIL "petves checkpoint, crc32 %08x\n"
#define CHECKPOINT_TAIL_LENGTH 34
PETSC_EXTERN PetscBool ChecksumOfFile(const char path[], long tail, unsigned *crc, char *end);

/* Room for a row of series.csv: 32 vesicles, 24 characters a number. */
#define SERIES_ROW_LENGTH 16384

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
