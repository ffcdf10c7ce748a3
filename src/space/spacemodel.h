/* Runs in three dimensions: what the run and the files have of a space (output/model.h).

   run.h5 has of each frame the points of all vesicles, a grid of the degree p with both poles, with velocity and
   tension there, and the coefficients [vesicle][3][count] of spherical harmonics (sphere/harmonics.h). */
#pragma once
#include "output/checkpoint.h"
#include "output/model.h"
#include "space/space.h"

/* Columns of series.csv, in order, and what they make of the vesicles' numbers (output/record.h). Units: those of the
   options, angles in radians. From FILM on they are of tubes alone. */
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
  COLUMN(GAP, "gap", RUN)                    \
  COLUMN(CONTACT, "energy_contact", RUN)     \
  COLUMN(ITS, "coupled_its", RUN)            \
  COLUMN(WALL, "wall", RUN)                  \
  COLUMN(FILM, "film", RUN)                  \
  COLUMN(FLOW, "mean_velocity", RUN)         \
  COLUMN(PRESSURE, "pressure_drop_extra", RUN)
/* clang-format on */
#define SPACE_ENUM(id, name, kind) SPACE_##id,
enum { SPACE_COLUMNS(SPACE_ENUM) SPACE_COUNT, SPACE_WITHOUT_TUBE = SPACE_FILM };

typedef struct _p_SpaceModel *SpaceModel;
struct _p_SpaceModel {
  Scene scene; /* borrowed */
  Space space;
  PetscInt its;                        /* iterations of the run */
  PetscInt columns;                    /* of series.csv */
  PetscInt points;                     /* of a vesicle in frames */
  PetscInt *first;                     /* [vesicles + 1] first point of each */
  PetscReal *Y;                        /* [points][count] harmonics there */
  char warning[2][PETVES_MAX_MESSAGE]; /* that harmonics do not resolve a shape, or a film; empty: none */
};

/* SpaceModelCreate - the space of a resolved scene; the model's context is the SpaceModel. After an error the caller
   destroys what has been made. Collective. */
PETSC_EXTERN PetscErrorCode SpaceModelCreate(Scene scene, Model *model);

/* SpaceFramesPoints - the points of frames and their harmonics. SpaceGather, SpaceSeries, SpaceDescribe, SpaceFrame,
   SpacePrint - points for callers, and frames (ModelOps; spaceframes.c). */
PETSC_EXTERN PetscErrorCode SpaceFramesPoints(SpaceModel model);
PETSC_EXTERN PetscErrorCode SpaceGather(void *model, ModelPart part, PetscReal numbers[]);
PETSC_EXTERN PetscErrorCode SpaceSeries(void *model, AppendedKind *kind);
PETSC_EXTERN PetscErrorCode SpaceDescribe(const void *model, H5File *file);
PETSC_EXTERN PetscErrorCode SpaceFrame(void *model, AppendedFile *file);
PETSC_EXTERN void SpacePrint(const void *model, FILE *file, PetscInt frame, PetscReal time);
