/* A tube about the vesicles of a space: what they have of its wall, and what is measured of it. */
#include "space/space.h"

/* The extent of all vesicles where their surfaces `at` have been placed. */
static PetscErrorCode SpaceTubeExtent(Space s, TubeExtent *extent) {
  PetscFunctionBeginUser;
  *extent = TubeNothing();
  for (PetscInt v = 0; v < s->share.own; v++) TubeMeasure(s->tube.tube, s->vesicle[v]->at, extent);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &extent->gap, 1, MPIU_REAL, MPI_MIN, s->share.comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &extent->low, 1, MPIU_REAL, MPI_MIN, s->share.comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &extent->stretch, 1, MPIU_REAL, MPI_MAX, s->share.comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &extent->high, 1, MPIU_REAL, MPI_MAX, s->share.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceMeasureFilm(Space s, const PetscReal X[], PetscReal *film) {
  TubeExtent extent;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++) PetscCall(SurfacePlace(s->vesicle[v]->at, X + v * s->size, PETSC_FALSE));
  PetscCall(SpaceTubeExtent(s, &extent));
  *film = extent.gap;
  s->tube.least = TubeLeastFilm(&extent);
  s->tube.spacing = extent.stretch * PETSC_PI / (PetscReal)(s->sphere->p + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpacePlaceTube(Space s, const PetscReal X[]) {
  const Tube tube = s->tube.tube;
  TubeExtent extent;
  PetscFunctionBeginUser;
  PetscCall(SpaceTubeExtent(s, &extent));
  s->tube.film = extent.gap;
  s->tube.least = TubeLeastFilm(&extent);
  if (s->tube.film < s->tube.least) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TubePlace(tube, s->sphere->p, &extent));
  const PetscInt each = s->size * TubeRowCount(tube);
  PetscCall(PetscFree(s->tube.wall));
  PetscCall(PetscMalloc1(s->share.own * each, &s->tube.wall));
  for (PetscInt v = 0; v < s->share.own; v++) {
    PetscCall(TubeFactor(tube, X + v * s->size, s->tube.wall + v * each));
    PetscCall(TubeAddMobility(tube, s->size, s->tube.wall + v * each, s->vesicle[v]->M));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceAddTube(Space s, const PetscReal F[], PetscReal V[]) {
  const Tube tube = s->tube.tube;
  const PetscInt rows = TubeRowCount(tube), each = s->size * rows;
  PetscMPIInt n;
  PetscReal *all, *others;
  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(rows, &n));
  PetscCall(PetscCalloc2(rows, &all, rows, &others));
  for (PetscInt v = 0; v < s->share.own; v++)
    PetscCall(TubeRows(tube, s->size, s->tube.wall + v * each, 1, F + v * s->size, all));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, n, MPIU_REAL, MPI_SUM, s->share.comm));
  for (PetscInt v = 0; v < s->share.own; v++) {
    PetscCall(PetscArraycpy(others, all, rows));
    PetscCall(TubeRows(tube, s->size, s->tube.wall + v * each, -1, F + v * s->size, others));
    PetscCall(TubeAddRows(tube, s->size, s->tube.wall + v * each, others, V + v * s->size));
  }
  PetscCall(PetscFree2(all, others));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceMeasureThrust(Space s) {
  PetscReal part;
  PetscFunctionBeginUser;
  s->tube.thrust = 0;
  for (PetscInt v = 0; v < s->share.own; v++) {
    PetscCall(TubeThrust(s->tube.tube, s->vesicle[v]->at, s->work.F + v * s->size, &part));
    s->tube.thrust -= part;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &s->tube.thrust, 1, MPIU_REAL, MPI_SUM, s->share.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
