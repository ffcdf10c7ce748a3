/* Forces on the markers of membranes, one list of them for steps, stresses, energies, frames and preconditioner. A
   force is a file of this folder and one row of the list in forcelist.c.

   A step takes a force at its new markers X = X* + Y - Y(X*), linearised at the extrapolated markers X* where it is
   placed. Minus the force is

       K Y + k,      K symmetric.

   Arrays X, V and F are the own parts [2n] of marker vectors of the vesicles; V, and F with V or k, of all bodies: what
   is on the markers of obstacles counts for free bodies. Forces are lengths squared over time squared times a length a
   marker (length^3/time^2). Each operation adds its answer to what the array has. An operation is NULL where a force
   has nothing of it. */
#pragma once
#include "bodies/bodies.h"
#include "fluid/grid/grid.h"

/* Where the counterforce of a force is. */
typedef enum {
  FORCE_WITHIN,  /* on the same body: neither sum nor torque on any body */
  FORCE_BETWEEN, /* on another body, an obstacle or a wall */
  FORCE_OUTSIDE  /* nowhere in the fluid */
} ForceReach;

/* At the markers X at an instant, wherever the force is placed: F += the force, E[vesicles] += the energies of the own
   vesicles (length^4/time^2); the other one is NULL. */
typedef PetscErrorCode ForceAt(void *, Instant at, const PetscScalar X[], PetscScalar F[], PetscReal E[]);

typedef struct {
  const char *name; /* of this force alone; its energy is in the column energy_NAME of series.csv */
  ForceReach reach;
  void *context;                                                    /* first argument of all operations */
  PetscErrorCode (*place)(void *, Instant at, const PetscReal X[]); /* at X*[2M] of all vesicles, at an instant */
  /* until it is placed again, with this expected tension[n] of the own vesicles and this a0, in fluid of viscosity nu
   */
  void (*expect)(void *, PetscReal nu, PetscReal a0, const PetscScalar tension[]);
  PetscErrorCode (*rate)(void *, PetscReal alpha, const PetscScalar V[], PetscScalar F[]);  /* F += alpha K V */
  PetscErrorCode (*known)(void *, PetscReal alpha, const PetscScalar X[], PetscScalar F[]); /* F += alpha k, with X* */
  /* K[2n][2n] += alpha times the part of K of one vesicle, for dense blocks of the preconditioner */
  PetscErrorCode (*dense)(void *, PetscInt vesicle, PetscReal alpha, PetscReal K[]);
  ForceAt *law;    /* for F; NULL: the force is -(K X + k) with X* = X */
  ForceAt *energy; /* for E */
  /* sum += SUM of the force's x component times the period by which a seam of the box separates the force from its
     counterforce, at markers x of all bodies, where it is placed at X*[2(M + W)]; on every rank */
  PetscErrorCode (*seams)(void *, const PetscReal Xstar[], const PetscScalar x[], PetscReal *sum);
  PetscErrorCode (*destroy)(void *);
} Force;

#define FORCES_MOST 8

typedef struct _p_Forces *Forces;
struct _p_Forces {
  PetscInt n;
  Force force[FORCES_MOST];
};

/* ForcesAdd - one more force. ForcesDestroy - all of them. ForcesFind - the context of the force of this name; NULL
   without. ForcesReach - the farthest reach of all. Not collective. */
PETSC_EXTERN PetscErrorCode ForcesAdd(Forces forces, const Force *force);
PETSC_EXTERN PetscErrorCode ForcesDestroy(Forces *forces);
PETSC_EXTERN void *ForcesFind(Forces forces, const char name[]);
PETSC_EXTERN ForceReach ForcesReach(Forces forces);

/* Operations of all forces, in the order of the list; ForcesLaw - of those from the first reach to the last one.
   Collective. */
PETSC_EXTERN PetscErrorCode ForcesPlace(Forces forces, Instant at, const PetscReal X[]);
PETSC_EXTERN PetscErrorCode ForcesExpect(Forces forces, PetscReal nu, PetscReal a0, Vec tension);
PETSC_EXTERN PetscErrorCode ForcesRate(Forces forces, PetscReal alpha, const PetscScalar V[], PetscScalar F[]);
PETSC_EXTERN PetscErrorCode ForcesKnown(Forces forces, PetscReal alpha, const PetscScalar X[], PetscScalar F[]);
PETSC_EXTERN PetscErrorCode ForcesDense(Forces forces, PetscInt vesicle, PetscReal alpha, PetscReal K[]);
PETSC_EXTERN PetscErrorCode ForcesLaw(Forces forces, ForceReach first, ForceReach last, Instant at,
                                      const PetscScalar X[], PetscScalar F[]);
PETSC_EXTERN PetscErrorCode ForcesSeams(Forces forces, const PetscReal Xstar[], const PetscScalar x[], PetscReal *sum);

/* A row of the list: makes a force, or leaves its name NULL where the scene (NULL: none) has none of it. */
typedef PetscErrorCode ForceCreate(Bodies bodies, Grid grid, Scene scene, Force *force);
PETSC_EXTERN ForceCreate ForceCreate_Bending, ForceCreate_Turning, ForceCreate_Contact, ForceCreate_Gravity,
    ForceCreate_Stretching, ForceCreate_Moment, ForceCreate_Potential;
