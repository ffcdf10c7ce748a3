/* One vesicle in three dimensions within a step: its part of the coupled problem, as dense matrices between
   coefficients (docs/space.md).

   Unknowns are x = (Q, sigma): Q[size] the velocity of the labels, X = Xhat + Q/a0, and the tension sigma[count].
   With X* the extrapolated shape, where everything stands, Y the shape about which bending is linearised (X*, or the
   iterate of a second Newton step), g and K_b the gradient and Gauss-Newton matrix of the bending energy there, K_s the
   pull of the last tension, and A the area rows,

       F = known + C x,   C = [(kappa K_b + K_s)/a0, A^T],
       known = kappa g + kappa K_b (Xhat - Y) + K_s (Xhat - X*) - (w.X*) n J,
       U = u_inf - M F,                                      M the mobility of all vesicles,
       Q + (gamma/a0) P_t Lambda Q - P_n U = P_t rigid - gamma P_t Lambda Xhat,      A U = r,

   M = K^-1 S of one vesicle, S the single layer and K = (1 + ratio)/2 + (1 - ratio) D with the double layer D, F the
   membrane's resistance, minus its force on the fluid, w the weight of a volume; P_n = n n., P_t = 1 - P_n.
   Labels follow the normal motion; tangentially they go with the rigid part of the last normal velocity, and Lambda =
   (l/p)^4 draws them to a clean spectrum at the rate gamma. r is zero but for the target of the whole area. */
#pragma once
#include "sphere/surface.h"

/* What does not change in a run. */
typedef struct {
  PetscReal nu;
  PetscReal bending;    /* bending modulus kappa (length^5/time^2: over the density, as nu is) */
  PetscReal label_rate; /* gamma (1/time) */
  PetscReal ratio;      /* viscosity inside over outside */
  PetscReal weight[3];  /* difference of the densities over that outside, times gravity (length/time^2) */
} Vesicle3Setting;

typedef struct _p_Vesicle3 *Vesicle3;
struct _p_Vesicle3 {
  Vesicle3Setting setting;
  PetscReal area, volume; /* of the first shape, which the membrane keeps */
  PetscInt count, size;   /* coefficients of the tension, of a field */
  PetscInt unknowns;      /* size + count */
  Surface at;             /* X* */
  Surface about;          /* Y */
  PetscReal *S;           /* [size][size] own single layer */
  PetscReal *K;           /* [size][size], factored; NULL where the ratio is 1 */
  PetscBLASInt *pivot;    /* [size] of it */
  PetscReal *N;           /* [size][size] P_n */
  PetscReal *columns;     /* [unknowns][size] C, with A^T */
  PetscInt motions;       /* rigid ones that the sphere's fields have: 6; of bodies of revolution 1, along the axis */
  PetscReal *motion;      /* [motions][size] translations, turns about the middle of X* */
  PetscReal middle[3];
  PetscReal *pull;  /* [size][size] K_s */
  PetscReal *clean; /* [size] gamma Lambda */
  PetscReal *known; /* [size] */
  PetscReal a0;
};

/* Vesicle3Create - of the first shape X[size], placed nowhere yet. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode Vesicle3Create(Sphere sphere, const Vesicle3Setting *setting, const PetscReal X[],
                                           Vesicle3 *vesicle);
PETSC_EXTERN PetscErrorCode Vesicle3Destroy(Vesicle3 *vesicle);

/* Vesicle3Place - surface, S, K, P_n, A, motions and pull at X*[size]; sigma[count]: the last tension. Vesicle3Factor -
   factor K, when a tube has been added to it; done: it is not singular. Vesicle3Linearise - columns and known about
   Y[size], for a0 and Xhat[size]. Not collective. */
PETSC_EXTERN PetscErrorCode Vesicle3Place(Vesicle3 vesicle, const PetscReal Xstar[], const PetscReal sigma[]);
PETSC_EXTERN PetscErrorCode Vesicle3Factor(Vesicle3 vesicle, PetscBool *done);
PETSC_EXTERN PetscErrorCode Vesicle3Linearise(Vesicle3 vesicle, PetscReal a0, const PetscReal Xhat[],
                                              const PetscReal Xstar[], const PetscReal Y[]);

/* Vesicle3Force - F[size] = C x, x[unknowns]. Vesicle3Velocity - U := K^-1 U, columns U[columns][size], becomes the
   velocity with this ratio of viscosities from that of equal ones. Vesicle3Rows - y[unknowns] = -(P_n, A) U + what the
   rows have of x alone (NULL: nothing). Not collective. */
PETSC_EXTERN PetscErrorCode Vesicle3Force(Vesicle3 vesicle, const PetscReal x[], PetscReal F[]);
PETSC_EXTERN PetscErrorCode Vesicle3Velocity(Vesicle3 vesicle, PetscInt columns, PetscReal U[]);
PETSC_EXTERN PetscErrorCode Vesicle3Rows(Vesicle3 vesicle, const PetscReal x[], const PetscReal U[], PetscReal y[]);

/* Vesicle3RemoveMotion - U[size] less the rigid motion of X* that is nearest to it in coefficients. Not collective. */
PETSC_EXTERN PetscErrorCode Vesicle3RemoveMotion(Vesicle3 vesicle, PetscReal U[]);

/* Vesicle3Target - b[unknowns], the right-hand sides, without those of u_inf: the labels' rigid part by the last
   velocity U[size] (NULL: none), and the target of the area. Not collective. */
PETSC_EXTERN PetscErrorCode Vesicle3Target(Vesicle3 vesicle, const PetscReal Xhat[], const PetscReal Xstar[],
                                           const PetscReal U[], PetscReal b[]);

/* Vesicle3Matrix - B[unknowns][unknowns], the vesicle's own part of the problem: what y = Vesicle3Rows makes of x by U
   = -M C x, with a small multiple of the identity in the tension's block. Not collective. */
PETSC_EXTERN PetscErrorCode Vesicle3Matrix(Vesicle3 vesicle, PetscReal B[]);

/* Vesicle3KeepVolume - shift X[size] evenly along its normals until it has its volume; `at` is used. Not collective. */
PETSC_EXTERN PetscErrorCode Vesicle3KeepVolume(Vesicle3 vesicle, PetscReal X[]);
