/* The velocity at markers that a Stokes solve by stream function gives for forces at markers:

       U = E S^-1 (alpha E^T F + force of the dipoles),

   S the Stokes operator. Forces are spread and velocities interpolated row by row as the solve passes the grid, so that
   no field is made on the grid. The stream must be of the markers' grid. A call gathers the forces to all ranks, has
   the messages of one solve, and sums the velocities to the owners. */
#pragma once
#include "markers/dipolerows.h"

/* MarkersRespond - U = E u, u the velocity of the Stokes solve for the force alpha E^T F and the dipoles (NULL: none).
   MarkersAddFlow - U = E u for the force alpha E^T F, and flow += the flow of u. MarkersFollow - U = E u for the
   forcing f, which has the dipoles' force and source in it, and for the force of earlier states (past, NULL: none),
   which also says how U and the flow of u are made; U may be NULL: not wanted. measures: of u on the whole grid, NULL:
   not wanted. U may be F. Collective. */
PETSC_EXTERN PetscErrorCode MarkersRespond(Markers markers, Stream stream, DipoleRows dipoles, PetscReal alpha, Vec F,
                                           Vec U);
PETSC_EXTERN PetscErrorCode MarkersAddFlow(Markers markers, Stream stream, PetscReal alpha, Vec F, Vec U, Vec flow,
                                           StreamMeasures *measures);
PETSC_EXTERN PetscErrorCode MarkersFollow(Markers markers, Stream stream, DipoleRows dipoles, const Forcing *f,
                                          const StreamPast *past, Vec U, StreamMeasures *measures);
