#include "space/fromscene.h"
#include "scene/auto.h"

#define ON_THROAT 24 /* spaces of the throat's rings that its radius has at least */
#define ON_DEPTH 4   /* and its depth */
#define STEEPEST 0.2 /* mouth over the depth, at least */

static PetscErrorCode SceneFlow3(const void *flow, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[]) {
  PetscFunctionBeginUser;
  PetscCall(Flow3Velocities((const Flow *)flow, t, n, X, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* That a vesicle of its area and volume has a shape that fits into the tube: with the radius R_A of the sphere of this
   area, rho = R/R_A must be above the root of rho^3 - 3 rho + 2v = 0, which a cylinder with round ends has. */
static PetscErrorCode SpaceCheckPassage(Scene s, Space space) {
  PetscReal least = 0;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < space->share.own; v++) {
    const Vesicle3 vesicle = space->vesicle[v];
    const PetscReal RA = PetscSqrtReal(vesicle->area / (4 * PETSC_PI)),
                    reduced = PetscMin(1, vesicle->volume / (4 * PETSC_PI * RA * RA * RA / 3));
    least = PetscMax(least, 2 * RA * PetscCosReal((PetscAcosReal(-reduced) + 4 * PETSC_PI) / 3));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPI_MAX, s->comm));
  PetvesCheck(s->space.tube.radius > least, s->comm,
              "-tube_radius %g: no shape with a vesicle's area and volume fits into the tube; allowed: above %g",
              (double)s->space.tube.radius, (double)least);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* That rings can resolve the throat. */
static PetscErrorCode SpaceCheckThroat(Scene s, Throat throat) {
  const SceneTube *tube = &s->space.tube;
  const PetscReal space = ThroatLeastFilm(throat), depth = tube->radius - tube->throat;
  PetscFunctionBeginUser;
  PetvesCheck(tube->throat >= ON_THROAT * space && depth >= ON_DEPTH * space, s->comm,
              "-tube_throat %g: too narrow or too shallow for a throat of this length; allowed: from %g to %g, or a "
              "shorter -tube_throat_length and -tube_throat_mouth",
              (double)tube->throat, (double)(ON_THROAT * space), (double)(tube->radius - ON_DEPTH * space));
  PetvesCheck(tube->throat_mouth >= STEEPEST * depth, s->comm,
              "-tube_throat_mouth %g: too steep for rings; allowed: from %g", (double)tube->throat_mouth,
              (double)(STEEPEST * depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* That the first shapes are inside the tube. */
static PetscErrorCode SpaceCheckTube(Scene s, Space space) {
  PetscReal film;
  PetscFunctionBeginUser;
  if (!space->tube.tube) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SpaceCheckPassage(s, space));
  if (space->tube.throat) PetscCall(SpaceCheckThroat(s, space->tube.throat));
  PetscCall(SpaceMeasureFilm(space, space->state.X, &film));
  PetvesCheck(
      film >= space->tube.least || !space->tube.throat, s->comm,
      "-tube_throat %g: a vesicle's first shape comes to %.3g of a wall; allowed: a -vesicle_center farther away, "
      "%.3g of it",
      (double)s->space.tube.throat, (double)film, (double)space->tube.least);
  PetvesCheck(film >= space->tube.least, s->comm,
              "-tube_radius %g: a vesicle's first shape comes to %.3g of it; allowed: above %.4g",
              (double)s->space.tube.radius, (double)film, (double)(s->space.tube.radius - film + space->tube.least));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* That contact reaches no farther than the fine grids of near surfaces do, `reach`. */
static PetscErrorCode SpaceCheckContact(Scene s, const Contact3Law *law, PetscReal reach) {
  PetscFunctionBeginUser;
  PetvesCheck(law->stress <= 0 || law->range + (law->adhesion > 0 ? law->band : 0) <= reach, s->comm,
              "-contact_repulsion_range %g: with -contact_adhesion_range it reaches farther than -sphere_degree %d has "
              "fine grids for; allowed: %.3g for both, or a lower degree",
              (double)law->range, (int)s->space.degree, (double)reach);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceFromScene(Scene s, Space *space) {
  const PetscInt p = s->space.degree, count = s->vesicles.count;
  const SpaceSetting setting = {.p = p,
                                .symmetry = s->dim == DIM_AXIAL ? SPHERE_REVOLVED : SPHERE_WHOLE,
                                .order = s->scheme.order,
                                .newton = s->space.newton,
                                .rtol = 1e-7,
                                .flow = SceneFlow3,
                                .context = &s->flow,
                                .policy = {.adaptive = (PetscBool)(s->time.adapt == ADAPT_ERROR),
                                           .base = s->time.dt,
                                           .tolerance = s->time.adapt_tol,
                                           .max_step = s->time.adapt_max_step},
                                .repulsion = {.stress = s->repulsion.stress,
                                              .range = s->repulsion.range,
                                              .adhesion = s->repulsion.adhesion,
                                              .band = s->repulsion.band > 0 ? s->repulsion.band : s->repulsion.range},
                                .tube = {.radius = s->space.tube.radius,
                                         .period = s->space.tube.period,
                                         .mean = s->flow.type == FLOW_TUBE ? 0.5 * s->flow.peak : 0},
                                .throat = {.radius = s->space.tube.throat,
                                           .center = s->space.tube.throat_center,
                                           .length = s->space.tube.throat_length,
                                           .mouth = s->space.tube.throat_mouth}};
  Vesicle3Setting *material;
  PetscFunctionBeginUser;
  PetscCall(SceneReport(s));
  PetscCall(PetscMalloc1(count, &material));
  for (PetscInt v = 0; v < count; v++) {
    material[v] = (Vesicle3Setting){.nu = s->fluid.nu,
                                    .bending = ListEntry(&s->membrane.stiffness, 1, v, 0),
                                    .label_rate = s->space.label_rate,
                                    .ratio = SceneViscosityRatio(s, v)};
    for (int d = 0; d < 3; d++) material[v].weight[d] = SceneWeight(s, v, d);
  }
  PetscCall(SpaceCreate(s->comm, &setting, count, material, s->space.X, space));
  PetscCall(PetscFree(material));
  PetscCall(SpaceCheckTube(s, *space));
  if (!(*space)->cross) PetscFunctionReturn(PETSC_SUCCESS);
  const CrossLayer cross = (*space)->cross;
  PetscCall(CrossLayerMeasure(cross, (*space)->state.X));
  PetvesCheck(cross->gap > 0, s->comm,
              "-vesicle_center: vesicles %" PetscInt_FMT " and %" PetscInt_FMT
              " overlap by %.3g; allowed: centers farther from one another",
              cross->nearest[0] + 1, cross->nearest[1] + 1, (double)-cross->gap);
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt v = 0; v < count; v++) least = PetscMin(least, s->space.R0[v]);
  PetscCall(SpaceCheckContact(s, &setting.repulsion, NearReach(PETSC_PI * least / (PetscReal)(p + 1)) / 2));
  PetscFunctionReturn(PETSC_SUCCESS);
}
