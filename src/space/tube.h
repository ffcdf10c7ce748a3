/* The wall of a circular tube of radius R about the axis x, with no markers on it: what it adds to the velocities of
   rings. The velocity at the radius R by a ring of radius r and force 1 in unbounded fluid has the Fourier transform

       G(k, r) = [ L_1 - H_rR,  i k H_R ;  -i k H_r,  L_0 - k^2 H ]        (components r, x),
       L_m = I_m(kr) K_m(kR)/(2 pi),      H = -(r I_1(kr) K_0(kR) - R I_0(kr) K_1(kR))/(4 pi k),

   subscripts r and R for derivatives, and the wall adds the velocity

       W = -(1/pi) INT_0^inf Re[ exp(ik(x - x')) G(k, r)* G(k, R)^-1 G(k, r') ] dk = -T^T T,

   so that it comes to rest at R and no fluid is pushed through the tube (Haberman and Sayre 1958 have the sphere). With
   a factor L L^T of G(k, R), which a turn of the phase makes real, a row of T is a component of L^-1 G at a node k of a
   quadrature, its real part or its imaginary one.

   With a given pressure drop over a period, forces f drive a mean velocity (f . u_1)/(8 pi nu P) too, u_1 the flow of
   mean velocity 1 and P the period: one more row of T, of the other sign. */
#pragma once
#include "sphere/surface.h"

#define TUBE_NODES 160
#define TUBE_ROWS (4 * TUBE_NODES + 1)

typedef struct {
  PetscReal radius; /* R (length); 0: no tube */
  PetscReal period; /* P (length); 0: the flux is given, not the pressure drop */
} TubeSetting;

typedef struct _p_Tube *Tube;

/* How near bodies of revolution come to the wall, negative where they are outside, and how long a meridian is for its
   angle at most. */
typedef struct {
  PetscReal gap, stretch;
} TubeExtent;

/* TubeCreate - of a fluid of viscosity nu. TubeMeasure - add a body of revolution that has been placed to an extent
   (gap PETSC_MAX_REAL, stretch 0: of none). TubePlace - the nodes, and rings that are no farther apart than the gap,
   for bodies of this degree and extent. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode TubeCreate(const TubeSetting *setting, PetscReal nu, Tube *tube);
PETSC_EXTERN PetscErrorCode TubeDestroy(Tube *tube);
PETSC_EXTERN void TubeMeasure(Tube tube, Surface surface, TubeExtent *extent);
PETSC_EXTERN PetscErrorCode TubePlace(Tube tube, PetscInt p, const TubeExtent *extent);

/* TubeFactor - T[size][TUBE_ROWS] of a body of revolution c[size]. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode TubeFactor(Tube tube, const PetscReal c[], PetscReal T[]);

/* TubeAddMobility - M[size][size] += T^T S T, S the signs of the rows. TubeRows - row[TUBE_ROWS] += scale T F[size].
   TubeAddRows - U[size] += T^T S row. Not collective. */
PETSC_EXTERN PetscErrorCode TubeAddMobility(PetscInt size, const PetscReal T[], PetscReal M[]);
PETSC_EXTERN PetscErrorCode TubeRows(PetscInt size, const PetscReal T[], PetscReal scale, const PetscReal F[],
                                     PetscReal row[]);
PETSC_EXTERN PetscErrorCode TubeAddRows(PetscInt size, const PetscReal T[], const PetscReal row[], PetscReal U[]);

/* TubeThrust - F . u_1 of forces F[size] on a body of revolution where it has been placed: -pi R^2 times the pressure
   drop that they add, by the reciprocal theorem. Not collective. */
PETSC_EXTERN PetscErrorCode TubeThrust(Tube tube, Surface surface, const PetscReal F[], PetscReal *thrust);
