/* A simulation in the plane: the parts that its step is made of, and what the files have of it (output/model.h).

   The row of series.csv is in planerecord.c, frames are in planeframes.c and planexdmf.c, checkpoints in
   planecheckpoint.c, the rest is in plane.c. */
#pragma once
#include "output/checkpoint.h"
#include "output/model.h"
#include "plane/tracers.h"
#include "scheme/scheme.h"

/* Columns of series.csv, in order, and what they make of the vesicles' numbers (output/record.h). */
/* clang-format off */
#define PLANE_COLUMNS(COLUMN)                    \
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
  COLUMN(GAP, "gap", APART)                      \
  COLUMN(CONTACT, "energy_contact", PAIRS)       \
  COLUMN(VISCOSITY_WALL, "viscosity_wall", RUN)  \
  COLUMN(VISCOSITY, "viscosity", RUN)            \
  COLUMN(NORMAL_WALL, "normal_stress_wall", RUN) \
  COLUMN(NORMAL, "normal_stress", RUN)
/* clang-format on */
#define PLANE_ENUM(id, name, kind) COLUMN_##id,
enum { PLANE_COLUMNS(PLANE_ENUM) COLUMN_COUNT };

/* Sums over the run, in checkpoints in this order. */
enum { TOTAL_SOLVES, TOTAL_TENSION, TOTAL_BENDING, TOTAL_COUPLED, TOTAL_COUNT };

typedef struct _p_Plane *Plane;
struct _p_Plane {
  Scene scene; /* borrowed */
  Fluid fluid;
  Layout all;          /* vesicles, then obstacles */
  Layout layout;       /* vesicles */
  Obstacles obstacles; /* NULL without */
  Membrane membrane;
  Coupling coupling;
  Scheme scheme;
  Tracers tracers;
  PetscInt totals[TOTAL_COUNT];
  PetscReal cfl_max;          /* largest of a step */
  char (*extra)[RECORD_NAME]; /* names of the columns that depend on the scene */
  PetscReal *work;            /* [vesicles] */
  PetscScalar *cells[3];      /* u, v, p at cell centres of this rank's rows, for frames */
  PetscReal *shown;           /* a series of a frame; work */
};

/* PlaneCreate - everything from a resolved scene; the model's context is the Plane. After an error the caller destroys
   what has been made. PlaneOf - the Plane of a model; NULL of another kind. The first is collective. */
PETSC_EXTERN PetscErrorCode PlaneCreate(Scene scene, Model *model);
PETSC_EXTERN Plane PlaneOf(const Model *model);

/* PlaneColumns - the columns of series.csv: PLANE_COLUMNS, behind them with obstacles

     pressure_drop, flux    scheme/pressuredrop.h
     force_x, force_y       of the fluid on all obstacles (length^3/time^2, density 1)

   and, with at most RECORD_FEW obstacles, for each of them

     force_x, force_y, torque    of the fluid, the torque about the obstacle's middle (length^4/time^2)
     center_x, center_y, angle   where obstacles move: middle (length) and the angle it has turned by (radian)
     velocity_x, velocity_y, rotation    where an obstacle moves freely

   and the energies of forces that are none of PLANE_COLUMNS. PlaneRow, PlaneMeasure - the numbers (ModelOps). */
PETSC_EXTERN PetscErrorCode PlaneColumns(Plane plane, RecordSetting *columns);
PETSC_EXTERN PetscErrorCode PlaneRow(void *plane, PetscReal last[]);
PETSC_EXTERN PetscErrorCode PlaneMeasure(void *plane, PetscReal each[], PetscReal last[]);

/* PlaneSeries, PlaneDescribe, PlaneFrame, PlanePrint - frames (ModelOps): velocity and pressure at cell centres, the
   vesicles, the force on obstacles, their markers where they move, and tracers. PlaneIsWrapped - whether they have the
   markers by whole periods in the box too: where the box is periodic. */
PETSC_EXTERN PetscErrorCode PlaneSeries(void *plane, AppendedKind *kind);
PETSC_EXTERN PetscErrorCode PlaneDescribe(const void *plane, H5File *file);
PETSC_EXTERN PetscErrorCode PlaneFrame(void *plane, AppendedFile *file);
PETSC_EXTERN void PlanePrint(const void *plane, FILE *file, PetscInt frame, PetscReal time);
PETSC_EXTERN PetscBool PlaneIsWrapped(Scheme scheme);

/* PlaneCheckpoint - checkpoints (ModelOps): fields of the grid under <group>/fluid, markers under <group>/vesicle and
   <group>/obstacle, tracers, and under /solver what the solvers have kept from earlier steps. */
PETSC_EXTERN PetscErrorCode PlaneCheckpoint(void *plane, H5File *file, PetscBool write, PetscInt *frames);
