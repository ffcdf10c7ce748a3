/* The unknowns of the reduced coupled problem and the norm of its residuals (docs/solver.md, Reduced unknowns). A
   rank's part of the vector is V [2n], the solved part of its own markers' velocity, F [2w], the fluid's force on its
   own obstacles' markers, and sigma [n], the tension of its own edges. Residuals are laid out alike. */
#pragma once
#include "coupling/coupling.h"

typedef struct _p_Unknowns *Unknowns;
struct _p_Unknowns {
  Coupling coupling;                 /* borrowed */
  PetscReal length;                  /* l, that residuals are weighed with: 2 R0 of the smallest vesicle */
  PetscInt velocity, solid, tension; /* own numbers of each kind */
};

PETSC_EXTERN PetscErrorCode UnknownsCreate(Coupling coupling, Unknowns *unknowns);
PETSC_EXTERN PetscErrorCode UnknownsDestroy(Unknowns *unknowns);

/* UnknownsCreateVec - a vector of unknowns, zero. Collective. */
PETSC_EXTERN PetscErrorCode UnknownsCreateVec(Unknowns unknowns, Vec *x);

/* UnknownsPack - x from its parts; solid may be NULL where there is none. UnknownsUnpack - and back. Not collective. */
PETSC_EXTERN PetscErrorCode UnknownsPack(Unknowns unknowns, Vec V, Vec solid, Vec sigma, Vec x);
PETSC_EXTERN PetscErrorCode UnknownsUnpack(Unknowns unknowns, Vec x, Vec V, Vec solid, Vec sigma);

/* UnknownsScale - rows of this rank's residual y times their factors (inverse: over them), which give every row the
   unit length^2/time^2, so that the norm does not depend on the units. A residual f of the momentum equation
   (length/time^2) is weighed with the length l, 2 R0 of the smallest vesicle. The other rows, by which a residual of
   the membrane is a surface divergence times nu: Dm V/h^2 = g           (nu + h l alpha) h^2/ds; h l alpha weighs short
   steps, where the momentum's right-hand side u alpha would hide the row V = E u - Theta F      that over h^2, an
   edge's difference, times the root of the force it means, bending over viscous (an energy norm) obstacles (nu + h l
   alpha)/ds. Not collective. */
PETSC_EXTERN void UnknownsScale(Unknowns unknowns, PetscBool inverse, PetscScalar y[]);

/* UnknownsTension - where the tensions start in a rank's part. Not collective. */
static inline PetscInt UnknownsTension(Unknowns u) {
  return u->velocity + u->solid;
}

/* UnknownsWeight - nu + h l alpha. UnknownsTensionScale - the factor of the rows Dm V/h^2 = g of one vesicle. Not
 * collective. */
PETSC_EXTERN PetscReal UnknownsWeight(Unknowns unknowns);
PETSC_EXTERN PetscReal UnknownsTensionScale(Unknowns unknowns, PetscInt vesicle);
