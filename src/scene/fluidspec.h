/* The specification of a fluid. */
#pragma once
#include "options/options.h"
#include "scene/flow.h"

typedef enum { BC_WALL, BC_PERIODIC, BC_FREE } BoundaryType;
typedef enum { FORM_DISTURBANCE, FORM_TOTAL } FlowForm;
typedef enum { DRIVE_PRESSURE, DRIVE_FLUX } DriveType;
typedef enum { INERTIA_AUTO, INERTIA_NONE, INERTIA_UNSTEADY, INERTIA_CONVECTIVE } InertiaType;

typedef struct {
  MPI_Comm comm;
  PetscReal box[4];  /* x_min, x_max, y_min, y_max */
  PetscInt cells[2]; /* in x and y, square */
  PetscInt bc[2];    /* BoundaryType in x and y; BC_FREE in both or in none */
  PetscReal nu;      /* viscosity (density is 1) */
  PetscInt inertia;  /* InertiaType, never INERTIA_AUTO */
  PetscInt drive;    /* DriveType: in a channel no mean pressure gradient, or no flux, of what is solved for */
  PetscBool held;    /* in a box that is periodic both ways the mean of what is solved for stays zero, whatever forces
                        there are: with obstacles */
  PetscInt form;     /* FlowForm: of the total form the walls move with the flow */
  const Flow *flow;  /* background flow, borrowed */
  char helmholtz[OPTION_MAX_NAME]; /* back end of the Helmholtz solves */
  char poisson[OPTION_MAX_NAME];   /* back end of the Poisson solves */
  PetscReal dt;                    /* the step that the first Helmholtz operator is made for */
} FluidSpec;

/* Period over the other side up to which the box part of the near field has a table: modes grow with it. */
#define FLUID_LONGEST_PERIOD 4

/* FluidSpecCellSize - h, the edge of the square cells. */
static inline PetscReal FluidSpecCellSize(const FluidSpec *spec) {
  return (spec->box[1] - spec->box[0]) / spec->cells[0];
}

/* FluidSpecPeriods - the periods in x and y (length); 0 where there is no period. */
static inline void FluidSpecPeriods(const FluidSpec *spec, PetscReal period[2]) {
  for (int d = 0; d < 2; d++) period[d] = spec->bc[d] == BC_PERIODIC ? spec->box[2 * d + 1] - spec->box[2 * d] : 0;
}

/* FluidSpecIsFree - whether the fluid is unbounded: the box is only the window in which fields are written. */
static inline PetscBool FluidSpecIsFree(const FluidSpec *spec) {
  return spec->bc[0] == BC_FREE;
}
