/* What a step amounts to in numbers: the row of series.csv, the rows of the vesicles, and the totals of the run.

   Each vesicle is measured by the rank that owns it, and one sum over ranks gives the numbers of all vesicles to every
   rank. A column of all vesicles is the total, the worst value or the mean of theirs. */
#pragma once
#include "scheme/scheme.h"

/* Columns of series.csv, in order, and what they make of the vesicles' numbers: nothing (RUN), a sum of which no
   vesicle has a column (PAIRS), or the TOTAL, the WORST (largest in magnitude), the MEAN, the FIRST vesicle's (neither
   a total nor a worst value of angles means anything) or the LEAST of columns that each vesicle has. */
/* clang-format off */
#define RECORD_COLUMNS(COLUMN)                   \
  COLUMN(STEP, "step", RUN)                      \
  COLUMN(TIME, "time", RUN)                      \
  COLUMN(DT, "dt", RUN)                          \
  COLUMN(KINETIC, "energy_kinetic", RUN)         \
  COLUMN(BENDING, "energy_bending", TOTAL)       \
  COLUMN(AREA, "area", TOTAL)                    \
  COLUMN(LENGTH, "length", TOTAL)                \
  COLUMN(AREA_ERROR, "area_error", WORST)        \
  COLUMN(LENGTH_ERROR, "length_error", WORST)    \
  COLUMN(EDGE_RATIO, "edge_ratio", WORST)        \
  COLUMN(DIV, "div_max", RUN)                    \
  COLUMN(SURFACE_DIV, "surface_div_max", RUN)    \
  COLUMN(CENTER_X, "center_x", MEAN)             \
  COLUMN(CENTER_Y, "center_y", MEAN)             \
  COLUMN(INCLINATION, "inclination", FIRST)      \
  COLUMN(FREQUENCY, "frequency", FIRST)          \
  COLUMN(TENSION_ITS, "tension_its", RUN)        \
  COLUMN(BENDING_ITS, "bending_its", RUN)        \
  COLUMN(COUPLED_ITS, "coupled_its", RUN)        \
  COLUMN(NSOLVE, "nsolve", RUN)                  \
  COLUMN(WALL, "wall", RUN)                      \
  COLUMN(AREA_SHIFT, "area_shift", RUN)          \
  COLUMN(NORMAL_SPEED, "normal_speed", WORST)    \
  COLUMN(VELOCITY_X, "velocity_x", MEAN)         \
  COLUMN(VELOCITY_Y, "velocity_y", MEAN)         \
  COLUMN(GRAVITY, "energy_gravity", TOTAL)       \
  COLUMN(GAP, "gap", LEAST)                      \
  COLUMN(CONTACT, "energy_contact", PAIRS)       \
  COLUMN(VISCOSITY_WALL, "viscosity_wall", RUN)  \
  COLUMN(VISCOSITY, "viscosity", RUN)            \
  COLUMN(NORMAL_WALL, "normal_stress_wall", RUN) \
  COLUMN(NORMAL, "normal_stress", RUN)
/* clang-format on */
#define RECORD_ENUM(id, name, kind) COLUMN_##id,
enum { RECORD_COLUMNS(RECORD_ENUM) COLUMN_COUNT };
PETSC_EXTERN const char *const SeriesColumns[COLUMN_COUNT];

/* RecordIsOwn - whether each vesicle has a column of its own. With at most RECORD_FEW vesicles these columns are in
   series.csv with a suffix for each vesicle, with more vesicles they are in vesicles.h5. Not collective. */
#define RECORD_FEW 40
PETSC_EXTERN PetscBool RecordIsOwn(int column);

/* Places of a force's energy other than one of RECORD_COLUMNS: a column of its own behind all others, or none. */
enum { RECORD_NOWHERE = -2, RECORD_LAST = -1 };

typedef struct {
  PetscInt vesicles;            /* number of vesicles */
  Forces forces;                /* borrowed */
  PetscInt solids;              /* columns of obstacles */
  PetscReal last[COLUMN_COUNT]; /* the last row, over all vesicles */
  PetscReal *each;              /* [vesicles][COLUMN_COUNT] the vesicles' own columns of the last row */
  PetscReal *solid;        /* [solids] the obstacles' columns of the last row, behind the vesicles' in series.csv */
  int column[FORCES_MOST]; /* where the energy of each force goes: a column, RECORD_LAST or RECORD_NOWHERE */
  PetscReal energy[FORCES_MOST]; /* of the forces whose energy comes last; else 0 */
  PetscInt others;               /* number of these */
  PetscReal *work;               /* [vesicles] */
  char *header, *text;           /* names of the columns, and the last row, as lines of series.csv without line ends */
  size_t room;                   /* characters that header and text have room for */
  PetscInt solves, tension, bending, coupled; /* sums over the run */
  PetscReal cfl_max;                          /* largest of a step */
} Record;

/* RecordCreate - a row of zeros, with the header for the vesicles, obstacles and forces. The energy of a force whose
   name is none of RECORD_COLUMNS comes last, in a column of its own. Not collective. */
PETSC_EXTERN PetscErrorCode RecordCreate(PetscInt vesicles, const SceneObstacles *obstacles, Forces forces,
                                         Record *record);
PETSC_EXTERN PetscErrorCode RecordDestroy(Record *record);

/* RecordMeasure - the vesicles' own columns of the present state, into `each`, and the least gap of all. RecordTake -
   the row of the scheme's state and last step, which is added to the totals. With obstacles the row ends with

     pressure_drop, flux    scheme/pressuredrop.h
     force_x, force_y       of the fluid on all obstacles (length^3/time^2, density 1)

   and, with at most RECORD_FEW obstacles, for each of them

     force_x, force_y, torque    of the fluid, the torque about the obstacle's middle (length^4/time^2)
     center_x, center_y, angle   where obstacles move: middle (length) and the angle it has turned by (radian)

   Collective. */
PETSC_EXTERN PetscErrorCode RecordMeasure(Record *record, Scheme scheme);
PETSC_EXTERN PetscErrorCode RecordTake(Record *record, Scheme scheme);

/* RecordFits - whether the text is a row of this step and time with as many numbers as the header has names.
   RecordParse - the last row from its text; a text that is longer than `room` is cut. Not collective. */
PETSC_EXTERN PetscBool RecordFits(const Record *record, PetscInt step, PetscReal t);
PETSC_EXTERN void RecordParse(Record *record, const char text[]);
