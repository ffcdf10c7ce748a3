/* The unknowns of the reduced coupled problem and the norm of its residuals (docs/solver.md, Reduced unknowns). A
   rank's part of the vector is V [2n], the solved part of its own markers' velocity, F [2w], the fluid's force on its
   own obstacles' markers, with the velocities q of own free bodies behind (bodies/freebodies.h), and sigma [n], the
   unknowns of the membranes' law at its own edges (bodies/law.h), the tension. Residuals are laid out alike. */
#pragma once
#include "problem/coupling.h"

typedef struct _p_Unknowns *Unknowns;
struct _p_Unknowns {
  Coupling coupling;               /* borrowed */
  PetscReal length;                /* l, the length of the residuals' factors: 2 R0 of the smallest vesicle */
  PetscInt velocity, solid, edges; /* own numbers of each kind */
  PetscScalar *V;                  /* [2(n + w)] work: velocities of all own markers */
};

/* UnknownsCreate - the layout of the unknowns of these bodies. Collective. */
PETSC_EXTERN PetscErrorCode UnknownsCreate(Coupling coupling, Unknowns *unknowns);
PETSC_EXTERN PetscErrorCode UnknownsDestroy(Unknowns *unknowns);

/* UnknownsCreateVec - a vector of unknowns, zero. Collective. */
PETSC_EXTERN PetscErrorCode UnknownsCreateVec(Unknowns unknowns, Vec *x);

/* UnknownsPack - put the parts into x; solid may be NULL where there is none. UnknownsUnpack - copy the parts out of x.
   Not collective. */
PETSC_EXTERN PetscErrorCode UnknownsPack(Unknowns unknowns, Vec V, Vec solid, Vec sigma, Vec x);
PETSC_EXTERN PetscErrorCode UnknownsUnpack(Unknowns unknowns, Vec x, Vec V, Vec solid, Vec sigma);

/* UnknownsScale - multiply the rows of this rank's residual y by their factors (inverse: divide), which give every row
   the unit length^2/time^2, so that the norm does not depend on the units. With the length l = 2 R0 of the smallest
   vesicle the factors are

       momentum                       l
       Dm V/h^2 = g                   (nu + h l alpha) h^2/ds
       V = E u - C F                  the same over h^2, times sqrt(bending force over viscous force)
       obstacles                      (nu + h l alpha)/ds
       force and torque on a body     1/ds, 1/(ds radius)

   h l alpha weighs short steps, in which the momentum's right-hand side alpha u would hide the other rows. Not
   collective. */
PETSC_EXTERN void UnknownsScale(Unknowns unknowns, PetscBool inverse, PetscScalar y[]);

/* UnknownsForce - F[2(n + w)] = Dm^T sigma + (1/a0) K V, minus the forces on the own vesicles' markers and those of
   contact on free bodies, for the unknowns x. Collective. */
PETSC_EXTERN PetscErrorCode UnknownsForce(Unknowns unknowns, const PetscScalar x[], PetscScalar F[]);

/* UnknownsEdges - index at which the law's unknowns start in a rank's part. Not collective. */
static inline PetscInt UnknownsEdges(Unknowns u) {
  return u->velocity + u->solid;
}
