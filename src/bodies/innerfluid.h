/* The fluid inside bodies that move freely, in unsteady and convective flow. The forces of the markers act on the fluid
   on both sides of a body's curve. A part of them changes the momentum of the fluid inside, what is left moves the
   body. With F the force of the fluid on the markers, R the body's rigid motions and q its velocity,

       M dq/dt = R^T F + load + INT_inside R^T Du/Dt dA,      M = density (A, A, I),

   A the area and I its second moment about the centroid c. Du/Dt is that of the momentum equation of the disturbance u
   on the grid, a0 u - uhat + N(u*) (docs/fluid.md, Inertia of the fluid), and the inside is where the step has placed
   the body, for the history uhat too: the equation stands at fixed places. The velocity must be the grid's. With that
   of the body in its place, (density - 1) a0 (A, A, I) q for the inertia of both, light bodies are unstable: in short
   steps the near field bounds F and with it a0 u, but not a0 q.

   The integral is a sum over rings of points, the curve's markers Y drawn in to c, which must see them all, by Gauss'
   rule in s, with the velocity that E gives there,

       INT g dA = SUM_ik w_i s_i (Y_k - c) x dY/dk g(c + s_i (Y_k - c)).

   Spreading and E smooth the velocity, which adds `smoothed` times its Laplacian. On the curve that is its force, which
   counts half. With T the torques of a disc of radius r on the fluid on either side, INT x cross u then lacks

       smoothed/nu (T_outside - T_inside)/2 = smoothed 2 pi r^2 q_3, at most 3/2 of it in sudden motion,

   `smoothed` times the circulation around the body, which the outermost ring adds. */
#pragma once
#include "bodies/obstacles.h"

typedef struct _p_InnerFluid *InnerFluid;
struct _p_InnerFluid {
  Obstacles obstacles; /* borrowed */
  PetscInt *start;     /* [curves + 1] first point of each curve; curves that do not move freely have none */
  PetscInt n;          /* points */
  PetscReal *rest;     /* [2n] points at time 0 */
  PetscReal *X;        /* [2n] where they have been placed */
  PetscReal *weight;   /* [n] of the integral (length^2) */
  PetscReal *turn;     /* [n] of the integral for the rotation */
  PetscReal *mass;     /* [3 free] M over the fluid's density */
  PetscReal *rate[2];  /* [3 free] INT R^T Du/Dt of what came last, and of the step so far */
};

/* InnerFluidCreate - of the free bodies among the obstacles, with points about h apart. InnerFluidPlace - X where the
   obstacles have been placed, from Create to Place that at time 0. Not collective. */
PETSC_EXTERN PetscErrorCode InnerFluidCreate(Obstacles obstacles, PetscReal h, PetscReal smoothed, InnerFluid *inner);
PETSC_EXTERN PetscErrorCode InnerFluidDestroy(InnerFluid *inner);
PETSC_EXTERN void InnerFluidPlace(InnerFluid inner);

/* InnerFluidAdd - alpha INT_inside R^T g of all bodies, from parts g[2n] of g at the points that add up over the ranks,
   is added to the rate of the step (a step begins: it is the rate), or is that of a product. Collective. */
typedef enum { INNER_PRODUCT, INNER_BEGIN, INNER_ADD } InnerPart;
PETSC_EXTERN PetscErrorCode InnerFluidAdd(InnerFluid inner, InnerPart part, PetscReal alpha, const PetscReal g[]);
