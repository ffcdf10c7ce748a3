/* What a step in three dimensions amounts to in numbers: the row of series.csv. Each vesicle is measured by the rank
   that owns it, and one sum over ranks gives the numbers of all vesicles to every rank. */
#pragma once
#include "space/space.h"

/* Columns, in order, and what they make of the vesicles' numbers, as in record.h; the LARGEST is one more. Units: those
   of the options, angles in radians. */
/* clang-format off */
#define SPACE_COLUMNS(COLUMN)                \
  COLUMN(STEP, "step", RUN)                  \
  COLUMN(TIME, "time", RUN)                  \
  COLUMN(DT, "dt", RUN)                      \
  COLUMN(BENDING, "energy_bending", TOTAL)   \
  COLUMN(AREA, "area", TOTAL)                \
  COLUMN(VOLUME, "volume", TOTAL)            \
  COLUMN(AREA_ERROR, "area_error", WORST)    \
  COLUMN(VOLUME_ERROR, "volume_error", WORST)\
  COLUMN(CENTER_X, "center_x", MEAN)         \
  COLUMN(CENTER_Y, "center_y", MEAN)         \
  COLUMN(CENTER_Z, "center_z", MEAN)         \
  COLUMN(VELOCITY_X, "velocity_x", MEAN)     \
  COLUMN(VELOCITY_Y, "velocity_y", MEAN)     \
  COLUMN(VELOCITY_Z, "velocity_z", MEAN)     \
  COLUMN(AXIS_SHORT, "axis_short", FIRST)    \
  COLUMN(AXIS_MIDDLE, "axis_middle", FIRST)  \
  COLUMN(AXIS_LONG, "axis_long", FIRST)      \
  COLUMN(INCLINATION, "inclination", FIRST)  \
  COLUMN(ELEVATION, "elevation", FIRST)      \
  COLUMN(ROTATION, "rotation_z", FIRST)      \
  COLUMN(TENSION_MIN, "tension_min", LEAST)  \
  COLUMN(TENSION_MAX, "tension_max", LARGEST)\
  COLUMN(NORMAL_SPEED, "normal_speed", WORST)\
  COLUMN(TAIL, "spectrum_tail", WORST)       \
  COLUMN(GAP, "gap", RUN)                     \
  COLUMN(ITS, "coupled_its", RUN)            \
  COLUMN(WALL, "wall", RUN)
/* clang-format on */
#define SPACE_ENUM(id, name, kind) SPACE_##id,
enum { SPACE_COLUMNS(SPACE_ENUM) SPACE_COUNT };
PETSC_EXTERN const char *const SpaceColumns[SPACE_COUNT];

#define SPACE_FEW 40 /* vesicles that have columns of their own, with a suffix, where there are several */

typedef struct {
  Space space;                 /* borrowed */
  PetscReal last[SPACE_COUNT]; /* the last row, over all vesicles */
  PetscReal *each;             /* [vesicles][SPACE_COUNT] */
  char *header, *text;         /* as lines of series.csv without line ends */
  size_t room;
  PetscInt its; /* of the run */
} SpaceRecord;

/* SpaceRecordCreate - a row of zeros, with the header. Not collective. SpaceRecordMeasure - the
   numbers of the present state and the last step. SpaceRecordTake - their row, which is added to the totals.
   Collective. */
PETSC_EXTERN PetscErrorCode SpaceRecordCreate(Space space, SpaceRecord *record);
PETSC_EXTERN PetscErrorCode SpaceRecordDestroy(SpaceRecord *record);
PETSC_EXTERN PetscErrorCode SpaceRecordMeasure(SpaceRecord *record);
PETSC_EXTERN PetscErrorCode SpaceRecordTake(SpaceRecord *record);
