/* Background flow u_inf, an exact solution of the Stokes equations, or a caller's own. Lengths and times are in the
   user's units. */
#pragma once
#include "options/options.h"

typedef enum {
  FLOW_QUIESCENT,
  FLOW_SHEAR,
  FLOW_POISEUILLE,
  FLOW_EXTENSION,
  FLOW_UNIFORM,
  FLOW_CUSTOM,
  FLOW_FORMULA,
  FLOW_AXIAL,
  FLOW_TUBE
} FlowType;

typedef struct {
  PetscInt type; /* FlowType */
  PetscReal rate, peak, half_width, center[2];
  RealList velocity;                   /* FLOW_UNIFORM: u_x, u_y, in three dimensions u_z */
  PetscReal chi, ca, ca_stretching;    /* what the user gives in place of rate or peak */
  char formula[3][PETSC_MAX_PATH_LEN]; /* FLOW_FORMULA: u_x, u_y, in three dimensions u_z */
  PetvesFlow function;                 /* FLOW_CUSTOM: the caller's, with its context; FLOW_FORMULA: the formulas' */
  void *ctx;
} Flow;

/* FlowIsCustom - the velocity is a function of which nothing else is known. */
static inline PetscBool FlowIsCustom(const Flow *flow) {
  return flow->type == FLOW_CUSTOM || flow->type == FLOW_FORMULA;
}

/* FlowReadFormulas - make the function of FLOW_FORMULA for points of dim coordinates (formula.c). Collective; stops
   with the user's message. FlowDropFormulas - free it. */
PETSC_EXTERN PetscErrorCode FlowReadFormulas(MPI_Comm comm, PetscInt dim, Flow *flow);
PETSC_EXTERN PetscErrorCode FlowDropFormulas(Flow *flow);

/* FlowVelocity - u_inf[2] at (x, y) and time t; NaN when a custom flow's function fails. */
PETSC_EXTERN void FlowVelocity(const Flow *flow, PetscReal t, PetscReal x, PetscReal y, PetscReal u[2]);

/* FlowVelocities - u_inf at n points X[2n] and time t, u[2n]: at most one call of a custom flow's function. message is
   empty, or says that the function failed or gave a value that is not finite: this rank's, to be agreed on before the
   next collective call. Not collective. */
PETSC_EXTERN PetscErrorCode FlowVelocities(const Flow *flow, PetscReal t, PetscInt n, const PetscReal X[],
                                           PetscReal u[], char message[PETVES_MAX_MESSAGE]);

/* FlowShearRate - the fastest rate at which the flow shears a vesicle (1/time); 0 where it is not known. */
PETSC_EXTERN PetscReal FlowShearRate(const Flow *flow);

/* FlowCheck - that a custom flow has no divergence at time 0, and one of formulas none later before the end either, by
   differences at points all over the box of cells of size h; that formulas have the periods of the box (0: none) and
   stay within the walls of a channel. Collective; stops with the user's message. */
PETSC_EXTERN PetscErrorCode FlowCheck(MPI_Comm comm, const Flow *flow, const PetscReal box[4],
                                      const PetscReal period[2], PetscReal h, PetscReal end);

/* FlowPressureGradient - grad p_inf[2] at any point (uniform for the flows offered) for viscosity nu. */
PETSC_EXTERN void FlowPressureGradient(const Flow *flow, PetscReal nu, PetscReal g[2]);

/* FlowGradient - gradient[a][b] = d(u_inf)_a/dx_b at y, the same at every x; not of a custom flow, which has none to
   give. */
PETSC_EXTERN void FlowGradient(const Flow *flow, PetscReal y, PetscReal gradient[2][2]);

/* Flow3Velocities - u[3][n] of the background flow at X[3][n] and time t. Shear (rate (y - y_c), 0, 0), extension (rate
   x, -rate y, 0), axial (rate x, -rate y/2, -rate z/2), poiseuille u_max (1 - ((y - y_c)/L)^2) along x, tube u_max (1 -
   (y^2 + z^2)/L^2) along x, uniform, a caller's, formulas; NaN where a caller's function fails. Not collective. Errors:
   memory. */
PETSC_EXTERN PetscErrorCode Flow3Velocities(const Flow *flow, PetscReal t, PetscInt n, const PetscReal X[],
                                            PetscReal u[]);

/* Flow3Check - that a caller's flow and formulas are finite and have no divergence at time 0, and formulas none later
   before the end either, by differences about `count` centers, within a distance R; rate: the largest gradient found,
   left as it is for other flows. Collective; stops with the user's message. */
PETSC_EXTERN PetscErrorCode Flow3Check(MPI_Comm comm, const Flow *flow, PetscInt count, const RealList *center,
                                       PetscReal R, PetscReal end, PetscReal *rate);
