/* What a step amounts to in numbers: a row of series.csv and the rows of the vesicles.

   A kind of simulation declares its columns in one list and gives the numbers (model.h). A column of all vesicles is
   the total, the worst value or the mean of theirs. All numbers are the same on every rank. */
#pragma once
#include "base/base.h"

/* What a column makes of the vesicles' numbers: nothing, it has a number of its own and single vesicles have none
   (RUN), or each vesicle has one too (APART); a sum of which no vesicle has a column (PAIRS); the TOTAL, the WORST
   (largest in magnitude), the MEAN, the FIRST vesicle's (neither a total nor a worst value of angles means anything),
   the LEAST or the LARGEST of columns that each vesicle has. */
typedef enum {
  RECORD_RUN,
  RECORD_PAIRS,
  RECORD_APART,
  RECORD_TOTAL,
  RECORD_WORST,
  RECORD_MEAN,
  RECORD_FIRST,
  RECORD_LEAST,
  RECORD_LARGEST
} RecordKind;

#define RECORD_NAME 32 /* characters of a column's name with a vesicle's number, or of a number and its comma */

typedef struct {
  char name[RECORD_NAME];
  RecordKind kind;
} RecordColumn;

/* RECORD_COLUMN - an entry of an array of columns, by a list of COLUMN(id, "name", KIND). */
#define RECORD_COLUMN(id, name, kind) {name, RECORD_##kind},

/* The columns of a run. What is of the run alone and depends on the scene comes last in series.csv, behind the columns
   of single vesicles. */
typedef struct {
  PetscInt vesicles, columns, extras;
  const RecordColumn *column;       /* [columns] borrowed */
  const char (*extra)[RECORD_NAME]; /* [extras] names, borrowed */
} RecordSetting;

typedef struct {
  RecordSetting setting;
  PetscReal *last;     /* [columns + extras] the last row, over all vesicles */
  PetscReal *each;     /* [vesicles][columns] the vesicles' own columns of the last row; others are 0 */
  char *header, *text; /* names of the columns, and the last row, as lines of series.csv without line ends */
  size_t room;         /* characters that header and text have room for */
} Record;

/* RecordCreate - a row of zeros, with the header. Not collective. */
PETSC_EXTERN PetscErrorCode RecordCreate(const RecordSetting *setting, Record *record);
PETSC_EXTERN PetscErrorCode RecordDestroy(Record *record);

/* RecordIsOwn - whether each vesicle has a column of its own. With at most RECORD_FEW vesicles these columns are in
   series.csv with a suffix for each vesicle, with more vesicles they are in vesicles.h5. Not collective. */
#define RECORD_FEW 40
PETSC_EXTERN PetscBool RecordIsOwn(const RecordColumn *column);

/* RecordCombine - the columns of all vesicles in `last` from `each`, and the text of the row. Not collective. */
PETSC_EXTERN void RecordCombine(Record *record);

/* RecordNumber - the last row's number of the column of this name, which there is. Not collective. */
PETSC_EXTERN PetscReal RecordNumber(const Record *record, const char name[]);

/* RecordFits - whether the text is a row of this step and time, the columns "step" and "time", with as many numbers as
   the header has names. RecordParse - the last row from its text; a text that is longer than `room` is cut. Not
   collective. */
PETSC_EXTERN PetscBool RecordFits(const Record *record, PetscInt step, PetscReal t);
PETSC_EXTERN void RecordParse(Record *record, const char text[]);
