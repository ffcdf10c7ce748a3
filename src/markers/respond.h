/* What a solve by stream function does to markers. Forces and velocities go row by row between markers and stream,
   which must be of the markers' grid: nothing is made on the grid. */
#pragma once
#include "markers/dipolerows.h"

/* MarkersRespond - U = E u, u the Stokes solve's velocity for the force alpha E^T F and the dipoles (NULL: none).
   MarkersAddFlow - the same without dipoles, and flow += the flow of u. MarkersFollow - for the forcing f, in which the
   dipoles' force and source are, and for the force of states before (past, NULL: none), U and the flow made being what
   it says; U NULL: not wanted. measures: of u on the whole grid, NULL: not wanted. U may be F.
   Collective. */
PETSC_EXTERN PetscErrorCode MarkersRespond(Markers markers, Stream stream, DipoleRows dipoles, PetscReal alpha, Vec F,
                                           Vec U);
PETSC_EXTERN PetscErrorCode MarkersAddFlow(Markers markers, Stream stream, PetscReal alpha, Vec F, Vec U, Vec flow,
                                           StreamMeasures *measures);
PETSC_EXTERN PetscErrorCode MarkersFollow(Markers markers, Stream stream, DipoleRows dipoles, const Forcing *f,
                                          const StreamPast *past, Vec U, StreamMeasures *measures);
