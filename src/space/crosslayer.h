/* What vesicles do to one another: the single and the double layer between different surfaces, by Stokeslets and
   stresslets between the points of the grids of degree p, and by finer grids where surfaces are near (nearlayer.h). The
   single layer's matrix between the coefficients of two surfaces is the transpose of that the other way. Every rank
   knows all surfaces and sums for its own. Bodies of revolution are whole spheres here, which only what comes in and
   goes out does not know. */
#pragma once
#include "space/contact3.h"
#include "sphere/surface.h"

/* Which vesicles a rank owns. */
typedef struct {
  MPI_Comm comm;
  PetscInt vesicles, first, own; /* number of all, first own one, number of own ones */
} VesicleShare;

/* ShareGather - all[vesicles][each] on every rank of own[own][each]. Collective. */
PETSC_EXTERN PetscErrorCode ShareGather(const VesicleShare *share, PetscInt each, const PetscReal own[],
                                        PetscReal all[]);

typedef struct {
  PetscInt surface[2];
  PetscReal spacing; /* the larger one of the grids of degree p */
  NearPair near;     /* NULL: not made */
  Contact3 contact;
} CrossPair;

typedef struct _p_CrossLayer *CrossLayer;
struct _p_CrossLayer {
  Sphere fields; /* of what comes in and goes out; borrowed */
  Sphere sphere; /* whole; `fields`, where that is whole */
  VesicleShare share;
  PetscReal nu;
  Contact3Law law;
  PetscReal *X;       /* [vesicles][3 count] of all */
  Surface *surface;   /* [vesicles] there */
  PetscReal *points;  /* [vesicles][3][n] on the grids of degree p */
  PetscReal *normals; /* [vesicles][3][n] n dA/domega there, of stresslets */
  NearTables tables;
  PetscInt pairs;
  CrossPair *pair; /* [pairs] near ones of which a surface is own */
  PetscReal gap;   /* least of all; negative where surfaces overlap */
  PetscInt nearest[2];
};

/* CrossLayerCreate - with these kernels: the Stokeslet, or both. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CrossLayerCreate(Sphere fields, VesicleShare share, PetscReal nu, Contact3Law law,
                                             PetscInt kernels, CrossLayer *cross);
PETSC_EXTERN PetscErrorCode CrossLayerDestroy(CrossLayer *cross);

/* CrossLayerMeasure - the least gap of the surfaces X[own][size]. CrossLayerPlace - the same, and what the surfaces do
   to one another where none overlap. CrossLayerAdd - U[own][size] += the velocities by forces F[own][size] on the other
   vesicles, or by the double layer of their velocities F. Collective. */
PETSC_EXTERN PetscErrorCode CrossLayerMeasure(CrossLayer cross, const PetscReal X[]);
PETSC_EXTERN PetscErrorCode CrossLayerPlace(CrossLayer cross, const PetscReal X[]);
PETSC_EXTERN PetscErrorCode CrossLayerAdd(CrossLayer cross, NearKernel kernel, const PetscReal F[], PetscReal U[]);

/* CrossLayerEnergy - of contact, where surfaces have been placed. CrossLayerAddContact - G[own][size] += what a
   change of the surfaces, change[own][size], adds to its gradient, and where asked for the gradient. Collective. */
PETSC_EXTERN PetscErrorCode CrossLayerEnergy(CrossLayer cross, PetscReal *energy);
PETSC_EXTERN PetscErrorCode CrossLayerAddContact(CrossLayer cross, PetscBool gradient, const PetscReal change[],
                                                 PetscReal G[]);
