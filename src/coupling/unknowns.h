/* The unknowns of the reduced coupled problem and the norm of its residuals (docs/solver.md, Reduced unknowns). A
   rank's part of the vector is V      [2n]  the solved part of its own markers' velocity, F [2w] the fluid's force on
   its own obstacles' markers, sigma  [n]   the tension of its own edges, d      [m]   its share of the forces on the
   faces next to walls, ranks having about as many each. Residuals are laid out alike. */
#pragma once
#include "coupling/coupling.h"
#include "fluid/walls.h"

typedef struct _p_Unknowns *Unknowns;
struct _p_Unknowns {
  Coupling coupling;                       /* borrowed */
  Walls walls;                             /* borrowed */
  PetscReal length;                        /* l, that residuals are weighed with: 2 R0 of the smallest vesicle */
  PetscInt velocity, solid, tension, wall; /* own numbers of each kind */
  PetscInt first_wall;                     /* number of the first own wall force */
  PetscMPIInt *count, *at;                 /* [ranks] wall forces of each rank, and where they start */
};

PETSC_EXTERN PetscErrorCode UnknownsCreate(Coupling coupling, Walls walls, Unknowns *unknowns);
PETSC_EXTERN PetscErrorCode UnknownsDestroy(Unknowns *unknowns);

/* UnknownsCreateVec - a vector of unknowns, zero. UnknownsCreateWallVec - of wall forces alone. Collective. */
PETSC_EXTERN PetscErrorCode UnknownsCreateVec(Unknowns unknowns, Vec *x);
PETSC_EXTERN PetscErrorCode UnknownsCreateWallVec(Unknowns unknowns, Vec *d);

/* UnknownsPack - x from its parts; solid may be NULL where there is none. UnknownsUnpack - and back. Not collective. */
PETSC_EXTERN PetscErrorCode UnknownsPack(Unknowns unknowns, Vec V, Vec solid, Vec sigma, Vec d, Vec x);
PETSC_EXTERN PetscErrorCode UnknownsUnpack(Unknowns unknowns, Vec x, Vec V, Vec solid, Vec sigma, Vec d);

/* UnknownsGatherWalls - every rank's own wall forces to all[walls->n] of every rank. Collective. */
PETSC_EXTERN PetscErrorCode UnknownsGatherWalls(Unknowns unknowns, const PetscScalar own[], PetscScalar all[]);

/* UnknownsScale - rows of this rank's residual y times their factors (inverse: over them), which give every row the
   unit length^2/time^2, so that the norm does not depend on the units. A residual f of the momentum equation
   (length/time^2) is weighed with the length l, 2 R0 of the smallest vesicle. The other rows, by which a residual of
   the membrane is a surface divergence times nu: Dm V/h^2 = g           (nu + h l alpha) h^2/ds; h l alpha weighs short
   steps, where the momentum's right-hand side u alpha would hide the row V = E u - Theta F      that over h^2, an
   edge's difference, times the root of the force it means, bending over viscous (an energy norm) obstacles (nu + h l
   alpha)/ds wall forces            2 h, at most l: a force on the row of faces at a wall, where the fluid sticks, gives
   it a velocity of the order h^2/nu, the same force on a membrane h R0/nu Not collective. */
PETSC_EXTERN void UnknownsScale(Unknowns unknowns, PetscBool inverse, PetscScalar y[]);

/* UnknownsTension - where the tensions start in a rank's part; UnknownsWalls - the wall forces. Not collective. */
static inline PetscInt UnknownsTension(Unknowns u) {
  return u->velocity + u->solid;
}
static inline PetscInt UnknownsWalls(Unknowns u) {
  return u->velocity + u->solid + u->tension;
}

/* UnknownsWeight - nu + h l alpha. UnknownsTensionScale - the factor of the rows Dm V/h^2 = g of one vesicle. Not
 * collective. */
PETSC_EXTERN PetscReal UnknownsWeight(Unknowns unknowns);
PETSC_EXTERN PetscReal UnknownsTensionScale(Unknowns unknowns, PetscInt vesicle);
