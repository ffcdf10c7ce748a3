/* The velocity alone of an unsteady Stokes solve, H u + G p = r_u, G^T u = 0, in a box that is periodic in x, or
   has walls both ways: what a Krylov iteration needs of it. Rows of forces come in from below and rows of velocity go
   out from above, one at a time, so that neither is ever an array over the grid.

   On the nodes between faces, chi with u = d_y chi, v = -d_x chi has no divergence, and the curl of the momentum
   equation has no pressure (docs/fluid.md, Stream function):
       (alpha - nu (d_xx + d_yy)) (-(d_xx + d_yy)) chi = d_x r_v - d_y r_u,
   with chi = 0 and d_y chi = 0 on walls. One Fourier transform along x there and one back, a fourth-order recurrence in
   y between them. The mean flow, mode 0, is a tridiagonal problem by itself. Between walls in x, modes are sines, there
   is no mean flow, and what holds the fluid at the walls is a force (sidewalls.h).

   In a channel that may carry no flux a uniform pressure gradient along it holds the mean flow at zero: u loses as much
   of the discrete Poiseuille profile as makes its sum zero. */
#pragma once
#include "fluid/stokes/streamstate.h"

/* StreamCreate - for a fluid in a box that is periodic in x, or has walls both ways, whose alpha it follows. Not
   collective. */
PETSC_EXTERN PetscErrorCode StreamCreate(Fluid fluid, Stream *stream);
PETSC_EXTERN PetscErrorCode StreamDestroy(Stream *stream);

/* StreamProfile - the Poiseuille profile over its mean, [rows of all], where a channel may carry no flux; borrowed,
   NULL elsewhere. Not collective. */
PETSC_EXTERN const PetscReal *StreamProfile(Stream stream);

/* StreamSolve - velocity for these forces, zero mean in quasi-steady flow in a box that is periodic both ways. Counted
   as one scalar solve, whose transforms it has. Modes are followed from forces to where 2e-22 of them are left.
   measures: of this velocity with all that is added on all of the grid (its divergence less `source` in the wanted
   rows; no sum of squares where a flow is made), NULL: not wanted. Collective. */
PETSC_EXTERN PetscErrorCode StreamSolve(Stream stream, const StreamRows *rows, StreamMeasures *measures);
