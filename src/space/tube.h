/* The wall of a circular tube of radius R about the axis x, with no markers on it: what it adds to the velocities of
   rings. The velocity at the radius R by a ring of radius r and force 1 in unbounded fluid has the Fourier transform

       G(k, r) = [ L_1 - H_rR,  i k H_R ;  -i k H_r,  L_0 - k^2 H ]        (components r, x),
       L_m = I_m(kr) K_m(kR)/(2 pi),      H = -(r I_1(kr) K_0(kR) - R I_0(kr) K_1(kR))/(4 pi k),

   subscripts r and R for derivatives, and the wall adds the velocity

       W = -(1/pi) INT_0^inf Re[ exp(ik(x - x')) G(k, r)* G(k, R)^-1 G(k, r') ] dk = -T^T T,     * conjugate transpose,

   over the viscosity, so that the fluid is at rest at R and none is pushed through the tube (Haberman and Sayre 1958
   have the sphere). G is real but for the factors i, which belong to the phase: diag(1, i) on both sides takes them
   away. With the factor L L^T of this G(k, R), a row of T is a component of L^-1 G at a node k of a quadrature, its
   real part or its imaginary one.

   The last row of T is that of u_1, the flow of mean velocity 1. With a given pressure drop over a period P forces f
   drive a mean velocity (f . u_1)/(8 pi nu P) too: this row's entry of the diagonal matrix S is 1/(8 pi nu P), or 0
   where the flux is given, and the others are -1.

   A row of T has what a flow t, which is regular in the tube, does to a body's forces. With its traction tau on the
   body the double layer of velocities U has of the wall

       D_W = -T^T S Theta,     Theta U = INT tau . U dA:

   for a flow U inside the body, W times its traction and D_W U are nothing together, as in the reciprocal theorem. */
#pragma once
#include "sphere/surface.h"

typedef struct {
  PetscReal radius; /* R (length); 0: no tube */
  PetscReal period; /* P (length); 0: the flux is given, not the pressure drop */
  PetscReal mean;   /* mean velocity of the flow in the tube alone (length/time) */
} TubeSetting;

/* A node of the quadrature in k: weight, K_0 and K_1 at kR over exp(-kR), and L of G(k, R) = L L^T. */
typedef struct {
  PetscReal k, weight, K[2], L[3];
} TubeNode;

#define TUBE_WAVES 4          /* nodes for a length over the gap */
#define TUBE_MOST_LENGTHS 640 /* over the gap */

typedef struct _p_Tube *Tube;
struct _p_Tube {
  TubeSetting setting;
  PetscReal nu;
  PetscInt nodes, waves; /* waves: rows of T of the tube alone, four a node and one */
  PetscReal *u, *w;      /* [nodes] Gauss and Legendre on (0, 1) */
  PetscReal highest;     /* k up to which the nodes are */
  TubeNode *node;        /* [nodes] */
  SphereTable rings;     /* of bodies of the last degrees; n 0: not made */
  struct {
    PetscInt rows; /* of T, behind those of the tube */
    PetscReal gap, length;
  } more; /* walls within the tube: how near they come to it, how long they are along x */
};

/* How near bodies of revolution come to the tube, negative where they are outside, how long a meridian is for its angle
   at most, from where to where the bodies reach along the axis, and how near they come to any wall (throat.h). */
typedef struct {
  PetscReal gap, stretch, low, high, film;
} TubeExtent;

/* TubeCreate - of a fluid of viscosity nu. TubeNothing - the extent of no body; TubeMeasure - add one that has been
   placed. TubeLeastBetween - the least of a function near a node, by its values before it, at it and after it.
   TubeLeastFilm - of this extent: thinner ones take more nodes or rings than there may be. TubePlace - the nodes, as
   many as the length of the extent over its gap asks for, and rings that are no farther apart than the film, for bodies
   of this degree. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode TubeCreate(const TubeSetting *setting, PetscReal nu, Tube *tube);
PETSC_EXTERN PetscErrorCode TubeDestroy(Tube *tube);
PETSC_EXTERN TubeExtent TubeNothing(void);
PETSC_EXTERN void TubeMeasure(Tube tube, Surface surface, TubeExtent *extent);
PETSC_EXTERN PetscReal TubeLeastBetween(PetscReal before, PetscReal here, PetscReal after);
PETSC_EXTERN PetscReal TubeLeastFilm(const TubeExtent *extent);
PETSC_EXTERN PetscErrorCode TubePlace(Tube tube, PetscInt p, const TubeExtent *extent);

/* TubeExtend - walls within the tube. TubeRowCount - rows of T of the tube and of them. Not collective. */
PETSC_EXTERN void TubeExtend(Tube tube, PetscInt rows, PetscReal gap, PetscReal length);
static inline PetscInt TubeRowCount(Tube tube) {
  return tube->waves + tube->more.rows;
}

/* TubeRings - rings[2n][waves]: the columns of T of forces 1 along x on n rings X[2][n], x and r, then of those along
   r; where normals[2][n] are given (NULL: not), of velocities there by the tractions over the viscosity. TubeSignRows -
   signed_rows[columns][rows] = scale S a[columns][rows], which may be one array. TubeProject - T[size][apart], rows
   numbers each, of a body, by those of its rings, rings[2n][rows]. Not collective. Errors: memory. */
PETSC_EXTERN void TubeRings(Tube tube, PetscInt n, const PetscReal X[], const PetscReal normals[], PetscReal rings[]);
PETSC_EXTERN void TubeSignRows(Tube tube, PetscInt rows, PetscInt columns, PetscReal scale, const PetscReal a[],
                               PetscReal signed_rows[]);
PETSC_EXTERN PetscErrorCode TubeProject(Tube tube, PetscInt rows, const PetscReal rings[], PetscReal T[],
                                        PetscInt apart);

/* TubeFactor - the tube's rows of T[size][rows] of a body of revolution c[size], and of Theta[size][rows] (NULL: not
   wanted). Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode TubeFactor(Tube tube, const PetscReal c[], PetscReal T[], PetscReal Theta[]);

/* TubeAddProduct - M[size][size] += scale T^T S A, A[size][rows]. Not collective. */
PETSC_EXTERN PetscErrorCode TubeAddProduct(Tube tube, PetscInt size, const PetscReal T[], PetscReal scale,
                                           const PetscReal A[], PetscReal M[]);

/* TubeThrust - f . u_1 of forces F[size] and rows T[size][rows], or INT tau_1 . U dA of velocities F and rows Theta,
   tau_1 the traction of u_1. With forces f on the fluid, and a fluid of another viscosity inside, f . u_1 + (1 - ratio)
   INT tau_1 . U dA is -pi R^2 times the pressure drop that a body adds, by the reciprocal theorem. Not collective. */
PETSC_EXTERN PetscReal TubeThrust(Tube tube, PetscInt size, const PetscReal T[], const PetscReal F[]);
