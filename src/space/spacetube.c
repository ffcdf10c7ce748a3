/* A tube about the vesicles of a space: what they have of its wall, and what is measured of it. */
#include "numerics/blas.h"
#include "space/space.h"

/* The extent of all vesicles where their surfaces `at` have been placed. */
static PetscErrorCode SpaceTubeExtent(Space s, TubeExtent *extent) {
  PetscFunctionBeginUser;
  *extent = TubeNothing();
  for (PetscInt v = 0; v < s->share.own; v++) {
    TubeMeasure(s->tube.tube, s->vesicle[v]->at, extent);
    if (s->tube.throat) ThroatMeasure(s->tube.throat, s->vesicle[v]->at, extent);
  }
  PetscReal least[] = {extent->gap, extent->film, extent->low, -extent->high, -extent->stretch};
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, 5, MPIU_REAL, MPI_MIN, s->share.comm));
  *extent = (TubeExtent){.gap = least[0], .film = least[1], .low = least[2], .high = -least[3], .stretch = -least[4]};
  s->tube.film = extent->film;
  s->tube.least = TubeLeastFilm(extent);
  if (s->tube.throat) s->tube.least = PetscMax(s->tube.least, ThroatLeastFilm(s->tube.throat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceMeasureFilm(Space s, const PetscReal X[], PetscReal *film) {
  TubeExtent extent;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++) PetscCall(SurfacePlace(s->vesicle[v]->at, X + v * s->size, PETSC_FALSE));
  PetscCall(SpaceTubeExtent(s, &extent));
  *film = extent.film;
  s->tube.spacing = extent.stretch * PETSC_PI / (PetscReal)(s->sphere->p + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodes and rings of a throat and its tube, and what the throat takes of the flux and of the pressure. */
static PetscErrorCode SpacePlaceThroat(Space s, const TubeExtent *extent) {
  const PetscReal P = s->setting.tube.period;
  PetscFunctionBeginUser;
  PetscCall(ThroatPlace(s->tube.throat, s->sphere->p, extent));
  const PetscReal resistance = ThroatResistance(s->tube.throat);
  s->tube.left = P > 0 ? 1 - resistance / (8 * PETSC_PI * s->tube.tube->nu * P) : 1;
  s->tube.drop = resistance / (s->tube.left * PETSC_PI * PetscSqr(s->setting.tube.radius));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpacePlaceTube(Space s, const PetscReal X[]) {
  const Tube tube = s->tube.tube;
  TubeExtent extent;
  PetscFunctionBeginUser;
  PetscCall(SpaceTubeExtent(s, &extent));
  if (s->tube.film < s->tube.least) {
    PetscCall(PetscSNPrintf(s->report.failure, PETVES_MAX_MESSAGE,
                            "the film between a vesicle and the tube is %.3g, least is %.3g", (double)s->tube.film,
                            (double)s->tube.least));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (s->tube.throat)
    PetscCall(SpacePlaceThroat(s, &extent));
  else
    PetscCall(TubePlace(tube, s->sphere->p, &extent));
  const PetscInt each = s->size * TubeRowCount(tube);
  PetscCall(PetscFree2(s->tube.wall, s->tube.traction));
  PetscCall(PetscCalloc2(s->share.own * each, &s->tube.wall, s->contrast ? s->share.own * each : 0, &s->tube.traction));
  for (PetscInt v = 0; v < s->share.own; v++) {
    const Vesicle3 vesicle = s->vesicle[v];
    PetscReal *T = s->tube.wall + v * each, *Theta = vesicle->K ? s->tube.traction + v * each : NULL;
    PetscCall(TubeFactor(tube, X + v * s->size, T, Theta));
    if (s->tube.throat) PetscCall(ThroatFactor(s->tube.throat, X + v * s->size, T, s->tube.flow + v * s->size));
    PetscCall(TubeAddProduct(tube, s->size, T, 1, T, vesicle->S));
    if (Theta) PetscCall(TubeAddProduct(tube, s->size, T, vesicle->setting.ratio - 1, Theta, vesicle->K));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceAddTube(Space s, NearKernel kernel, const PetscReal F[], PetscReal V[]) {
  const Tube tube = s->tube.tube;
  const PetscInt rows = TubeRowCount(tube), each = s->size * rows;
  const PetscReal *factor = kernel == STRESSLET ? s->tube.traction : s->tube.wall, sign = kernel == STRESSLET ? -1 : 1;
  PetscMPIInt n;
  PetscReal *all, *others;
  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(rows, &n));
  PetscCall(PetscCalloc2(rows, &all, rows, &others));
  PetscCall(DenseMultAdd(PETSC_FALSE, rows, s->share.own * s->size, 1, factor, F, all));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, n, MPIU_REAL, MPI_SUM, s->share.comm));
  for (PetscInt v = 0; v < s->share.own; v++) {
    PetscCall(PetscArraycpy(others, all, rows));
    PetscCall(DenseMultAdd(PETSC_FALSE, rows, s->size, -1, factor + v * each, F + v * s->size, others));
    TubeSignRows(tube, rows, 1, sign, others, others);
    PetscCall(DenseMultAdd(PETSC_TRUE, rows, s->size, 1, s->tube.wall + v * each, others, V + v * s->size));
  }
  PetscCall(PetscFree2(all, others));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceMeasureThrust(Space s) {
  const PetscInt size = s->size, each = size * TubeRowCount(s->tube.tube);
  PetscReal sum = 0;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++) {
    const PetscReal ratio = s->vesicle[v]->setting.ratio, *F = s->work.F + v * size, *V = s->work.V + v * size;
    sum -= TubeThrust(s->tube.tube, size, s->tube.wall + v * each, F);
    if (ratio != 1) sum += (1 - ratio) * TubeThrust(s->tube.tube, size, s->tube.traction + v * each, V);
    for (PetscInt k = 0; k < size && s->tube.throat; k++) sum -= F[k] * s->tube.flow[v * size + k];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, s->share.comm));
  s->tube.thrust = sum / s->tube.left;
  PetscFunctionReturn(PETSC_SUCCESS);
}
