/* Layers of a closed surface X(omega) = SUM c_k Y_k(omega), as matrices between coefficients:

       M_kl = INT Y_k(omega) INT G(X(omega) - X(omega')) Y_l(omega') domega' domega.

   Densities are those of the parameter sphere, phi = f dA/domega, so that no area of the surface is in the matrix, and
   the power of forces with coefficients F is SUM F_k . dc_k/dt. The outer integral is by the grid of degree p, the
   inner one by a grid turned to each of its points (spheregrid.h), which is exact for a kernel 1/r times a smooth
   function. */
#pragma once
#include "sphere/spheregrid.h"

/* Kernel3 - G[6][n] = weight[n] times the components xx, yy, zz, yz, xz, xy of a kernel at n distances d[3][n] from its
   sources; normal[3][n]: n dA/domega at the sources, where the kernel has one.
   Stokeslet3:   (I/r + d d/r^3)/(8 pi), of viscosity 1.
   Stresslet3:   -3 d d (d.normal)/(4 pi r^5); on the surface its layer makes U/2 of a rigid motion U. */
typedef struct {
  void (*set)(PetscInt n, const PetscReal d[], const PetscReal normal[], const PetscReal weight[], PetscReal G[]);
  PetscBool normal;
} Kernel3;
PETSC_EXTERN const Kernel3 Stokeslet3, Stresslet3;

/* SphereLayerMatrix - M[size][size], columns contiguous, of the surface c[size].
   SphereSingleLayer - the same of the Stokeslet over the viscosity nu, (M + M^T)/2: the difference of the two is the
   quadrature's. Not collective. */
PETSC_EXTERN PetscErrorCode SphereLayerMatrix(Sphere sphere, const Kernel3 *kernel, const PetscReal c[], PetscReal M[]);
PETSC_EXTERN PetscErrorCode SphereSingleLayer(Sphere sphere, PetscReal nu, const PetscReal c[], PetscReal M[]);

/* LayerNormals - a[3][n] = n dA/domega of the surface c[size] at the points of a table with first derivatives. Not
   collective. */
PETSC_EXTERN PetscErrorCode LayerNormals(const SphereTable *table, const PetscReal c[], PetscReal a[]);
