/* A closed surface, the field X of spheregrid.h, at the points of the fine grid: its measures, and matrices between
   coefficients that a membrane's forces are made of. With E, F, G the first fundamental form, a = X_theta x X_phi, W =
   |a| and N = a . (E X_phi_phi - 2F X_theta_phi + G X_theta_theta),

       J = dA/domega = W/sin(theta),        h = 2H sqrt(J) = N W^(-5/2)/sqrt(sin(theta)),
       bending energy = 1/2 SUM w h^2       (bending modulus 1; 8 pi for a sphere),

   w the weights of the grid and 2H the sum of the principal curvatures. The derivatives of h and J by the coefficients
   are matrices, so that the bending force is the exact gradient of the energy, and tension and area constraint are
   transposes of one another. Fields have their components blocked at points, [3][n], and have size coefficients. */
#pragma once
#include "sphere/spheregrid.h"

typedef struct _p_Surface *Surface;
struct _p_Surface {
  Sphere sphere;                /* borrowed */
  PetscInt n;                   /* points */
  PetscReal *D[HARMONIC_PARTS]; /* [3][n] X and its derivatives */
  PetscReal *normal;            /* [3][n] unit, outward */
  PetscReal *J, *h;             /* [n] */
  PetscReal area, volume, energy;
  PetscReal *dh, *dJ; /* [size][n] derivatives by the coefficients */
};

/* SurfaceEllipsoid - c[3][count], on a whole sphere, of an ellipsoid with these half axes along x, y, z, about the
   origin: harmonics of degree 1. Not collective. */
PETSC_EXTERN void SurfaceEllipsoid(PetscInt p, const PetscReal axes[3], PetscReal c[]);

/* SurfaceSpheroid - c[2p + 1], a body of revolution, of a spheroid with these half axes about the origin. Not
   collective. */
PETSC_EXTERN void SurfaceSpheroid(PetscInt p, PetscReal along, PetscReal across, PetscReal c[]);

/* SurfaceCreate - nowhere yet. SurfacePlace - at the coefficients c[3][count]: points, measures, and, where asked for,
   dh and dJ. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode SurfaceCreate(Sphere sphere, Surface *surface);
PETSC_EXTERN PetscErrorCode SurfaceDestroy(Surface *surface);
PETSC_EXTERN PetscErrorCode SurfacePlace(Surface surface, const PetscReal c[], PetscBool derivatives);

/* SurfaceCombine - out[size][n], what the sum over the parts first .. last of factor[part - first][3][n] times a
   derivative of a field is of the field's coefficients. Not collective. */
PETSC_EXTERN void SurfaceCombine(Surface surface, PetscInt first, PetscInt last, const PetscReal factor[],
                                 PetscReal out[]);

/* SurfaceGradient - g[size], the gradient of the energy. SurfaceBending - K[size][size] = SUM w dh dh, the
   Gauss-Newton part of its second derivative. SurfaceAreaColumns - A^T[count][size], A U = INT Y_k div_s U dA. Where
   derivatives have been placed; not collective. */
PETSC_EXTERN PetscErrorCode SurfaceGradient(Surface surface, PetscReal g[]);
PETSC_EXTERN PetscErrorCode SurfaceBending(Surface surface, PetscReal K[]);
PETSC_EXTERN PetscErrorCode SurfaceAreaColumns(Surface surface, PetscReal A[]);

/* SurfaceNormals - N[size][size], the projection n n. of a field, in coefficients. SurfacePull - K[size][size] = INT
   max(sigma, 0) grad_s(n.) . grad_s(n.) dA, the stiffness by which a tension sigma[count] pulls bumps flat. Not
   collective. */
PETSC_EXTERN PetscErrorCode SurfaceNormals(Surface surface, PetscReal N[]);
PETSC_EXTERN PetscErrorCode SurfacePull(Surface surface, const PetscReal sigma[], PetscReal K[]);
