/* What a step amounts to in numbers: the row of series.csv, the rows of the vesicles, and the totals of the run.

   Each vesicle is measured by the rank that owns it, and one sum over ranks gives the numbers of all vesicles to every
   rank. A column of all vesicles is the total, the worst value or the mean of theirs. */
#pragma once
#include "scheme/scheme.h"

/* Columns of series.csv, in order. */
/* clang-format off */
#define RECORD_COLUMNS(COLUMN)              \
  COLUMN(STEP, "step")                      \
  COLUMN(TIME, "time")                      \
  COLUMN(DT, "dt")                          \
  COLUMN(KINETIC, "energy_kinetic")         \
  COLUMN(BENDING, "energy_bending")         \
  COLUMN(AREA, "area")                      \
  COLUMN(LENGTH, "length")                  \
  COLUMN(AREA_ERROR, "area_error")          \
  COLUMN(LENGTH_ERROR, "length_error")      \
  COLUMN(EDGE_RATIO, "edge_ratio")          \
  COLUMN(DIV, "div_max")                    \
  COLUMN(SURFACE_DIV, "surface_div_max")    \
  COLUMN(CENTER_X, "center_x")              \
  COLUMN(CENTER_Y, "center_y")              \
  COLUMN(INCLINATION, "inclination")        \
  COLUMN(FREQUENCY, "frequency")            \
  COLUMN(TENSION_ITS, "tension_its")        \
  COLUMN(BENDING_ITS, "bending_its")        \
  COLUMN(COUPLED_ITS, "coupled_its")        \
  COLUMN(NSOLVE, "nsolve")                  \
  COLUMN(WALL, "wall")                      \
  COLUMN(AREA_SHIFT, "area_shift")          \
  COLUMN(NORMAL_SPEED, "normal_speed")      \
  COLUMN(VELOCITY_X, "velocity_x")          \
  COLUMN(VELOCITY_Y, "velocity_y")          \
  COLUMN(GRAVITY, "energy_gravity")         \
  COLUMN(GAP, "gap")                        \
  COLUMN(CONTACT, "energy_contact")         \
  COLUMN(VISCOSITY_WALL, "viscosity_wall")  \
  COLUMN(VISCOSITY, "viscosity")            \
  COLUMN(NORMAL_WALL, "normal_stress_wall") \
  COLUMN(NORMAL, "normal_stress")
/* clang-format on */
#define RECORD_ENUM(id, name) COLUMN_##id,
enum { RECORD_COLUMNS(RECORD_ENUM) COLUMN_COUNT };
PETSC_EXTERN const char *const SeriesColumns[COLUMN_COUNT];

/* Columns that each vesicle has of its own; -1 past the last. With at most RECORD_FEW vesicles these columns are in
   series.csv with a suffix for each vesicle, with more vesicles they are in vesicles.h5. */
#define RECORD_FEW 40
PETSC_EXTERN const int RecordVesicleColumns[];

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
