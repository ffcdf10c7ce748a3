#include "scene/space.h"
#include "scene/auto.h"
#include "scene/checks.h"
#include "scene/properties.h"

#define CAPSULE_MOST 0.97 /* reduced volume: below the largest that the family of capsules has, 0.9765 */

/* What scenes of the other dimension have in place of an option. */
static const struct {
  Dimension dim;
  const char *name, *say;
} instead[] = {
    {DIM_PLANE, "-vesicle_radius", "-dim 3; -dim 2 has -vesicle_area and -vesicle_reduced_area, or -vesicle_semi_axes"},
    {DIM_PLANE, "-vesicle_reduced_volume", "-dim 3; -dim 2 has -vesicle_reduced_area"},
    {DIM_SPACE, "-vesicle_area", "-dim 2; -dim 3 has -vesicle_radius"},
    {DIM_SPACE, "-vesicle_reduced_area", "-dim 2; -dim 3 has -vesicle_reduced_volume"},
    {DIM_SPACE, "-vesicle_semi_axes", "-dim 2; -dim 3 has -vesicle_half_axes"},
    {DIM_SPACE, "-vesicle_shape", "-dim 2; -dim 3 has -vesicle_spheroid, and -vesicle_file without it"},
    {DIM_SPACE, "-vesicle_angle", "-dim 2; -dim 3 has -vesicle_axis"},
    {DIM_SPACE, "-vesicle_markers", "-dim 2; -dim 3 has -sphere_degree"},
    {DIM_SPACE, "-domain_cells", "-dim 2; -dim 3 has no grid, see -sphere_degree"},
    {DIM_SPACE, "-domain_box", "-dim 2; in three dimensions the fluid has no bounds"}};

const char *SceneSpaceMissing(const OptionRow *row, const void *scene) {
  const PetscInt dim = ((Scene)scene)->dim == DIM_PLANE ? DIM_PLANE : DIM_SPACE;
  for (size_t k = 0; k < sizeof(instead) / sizeof(instead[0]); k++)
    if (dim == (PetscInt)instead[k].dim && !strcmp(row->name, instead[k].name)) return instead[k].say;
  return dim == DIM_PLANE || row->group ? NULL : "-dim 2";
}

/* R0: the largest radius and the least. The largest bending modulus, of which with the largest radius -flow_chi and
   -flow_ca are. The fastest rate of relaxation: the largest modulus over nu R0^3 of a vesicle (1/time). */
static void SceneSpaceScales(Scene s, PetscReal R0[2], PetscReal *bending, PetscReal *relaxation) {
  R0[0] = *bending = *relaxation = 0;
  R0[1] = PETSC_MAX_REAL;
  for (PetscInt v = 0; v < s->vesicles.count; v++) {
    const PetscReal kappa = ListEntry(&s->membrane.stiffness, 1, v, 0), R = s->space.R0[v];
    R0[0] = PetscMax(R0[0], R);
    R0[1] = PetscMin(R0[1], R);
    *bending = PetscMax(*bending, kappa);
    *relaxation = PetscMax(*relaxation, kappa / (s->fluid.nu * R * R * R));
  }
}

/* Whether the second and third of three numbers an entry are all 0, or (alike) equal. */
static PetscBool SceneAlongAxis(const RealList *list, PetscBool alike) {
  for (PetscInt k = 0; k + 2 < list->n; k += 3)
    if (alike ? list->v[k + 1] != list->v[k + 2] : list->v[k + 1] != 0 || list->v[k + 2] != 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Lists of other lengths, and what a scene in three dimensions cannot have. */
/* clang-format off */
static PetscErrorCode SceneCheckSpace(Scene s) {
  static const struct {
    const char *name;
    PetscInt each;
  } lists[] = {{"-vesicle_radius", 1},    {"-vesicle_reduced_volume", 1}, {"-vesicle_center", 3},
               {"-vesicle_half_axes", 3}, {"-vesicle_axis", 3},           {"-vesicle_density_difference", 1},
               {"-vesicle_bending", 1},   {"-vesicle_viscosity_ratio", 1}};
  const RealList *axis = &s->space.axis, *bending = &s->membrane.stiffness;
  const PetscBool half_axes = SceneGiven(s, "-vesicle_half_axes"), volume = SceneGiven(s, "-vesicle_reduced_volume"),
                  file = (PetscBool)(*s->vesicles.file != 0);
  PetscBool directionless = PETSC_FALSE;
  PetscReal softest = PETSC_MAX_REAL;
  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof(lists) / sizeof(lists[0]); k++)
    PetscCall(SceneCheckList(s, lists[k].name, lists[k].each, s->vesicles.count, "vesicles", "a vesicle"));
  for (PetscInt k = 0; k < bending->n; k++) softest = PetscMin(softest, bending->v[k]);
  for (PetscInt k = 0; k < axis->n; k += 3)
    if (axis->v[k] == 0 && axis->v[k + 1] == 0 && axis->v[k + 2] == 0) directionless = PETSC_TRUE;
  const SceneRule rules[] = {
    {s->flow.type == FLOW_FORMULA && !SceneGiven(s, "-flow_u") && !SceneGiven(s, "-flow_v") && !SceneGiven(s, "-flow_w"),
     "-flow_type formula: no formula given; allowed: with -flow_u, -flow_v or -flow_w"},
    {s->flow.type == FLOW_UNIFORM && s->flow.velocity.n != 3,
     "-flow_velocity {-flow_velocity}: not three numbers; allowed: u_x,u_y,u_z"},
    {strcmp(s->scheme.type, "coupled") != 0, "-scheme_type {-scheme_type}: of the plane; allowed with -dim 3: coupled"},
    {half_axes && (volume || SceneGiven(s, "-vesicle_radius")),
     "-vesicle_half_axes {-vesicle_half_axes}: with -vesicle_radius or -vesicle_reduced_volume; allowed: one of both descriptions"},
    {file && (half_axes || volume || SceneGiven(s, "-vesicle_axis") || SceneGiven(s, "-vesicle_spheroid")),
     "-vesicle_file {-vesicle_file}: with -vesicle_half_axes, -vesicle_reduced_volume, -vesicle_axis or -vesicle_spheroid; allowed: -vesicle_radius and -vesicle_center"},
    {s->gravity.g.n != 3, "-fluid_gravity {-fluid_gravity}: not three numbers; allowed: g_x,g_y,g_z"},
    {s->time.adapt == ADAPT_ERROR && s->scheme.order < 2,
     "-time_adapt error: with -scheme_type {-scheme_type} of order {-scheme_order}; allowed: coupled with -scheme_order 2 or 3"},
    {s->space.degree % 2, "-sphere_degree {-sphere_degree}: odd; allowed: an even number"},
    {s->space.degree > 32 && (s->dim != DIM_AXIAL || s->vesicles.count > 1 || file),
     "-sphere_degree {-sphere_degree}: more than whole surfaces have room for; allowed up to 32, or with -dim axisymmetric and one vesicle without -vesicle_file"},
    {half_axes && s->space.spheroid == SPHEROID_CAPSULE,
     "-vesicle_half_axes {-vesicle_half_axes}: with -vesicle_spheroid capsule; allowed: one of both descriptions"},
    {softest == 0, "-vesicle_bending {-vesicle_bending}: no stiffness; allowed with -dim 3: >0"},
    {s->space.spheroid == SPHEROID_CAPSULE && ListLargest(&s->space.reduced_volume) > CAPSULE_MOST,
     "-vesicle_reduced_volume {-vesicle_reduced_volume}: too round for -vesicle_spheroid capsule; allowed: up to 0.97"},
    {directionless, "-vesicle_axis {-vesicle_axis}: 0,0,0 is no direction; allowed: any other"}};
  PetscCall(REFUSE(s, rules));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a scene of bodies of revolution about x cannot have; the flow in a tube. */
static PetscErrorCode SceneResolveAxial(Draft s) {
  SceneTube *tube = &s->space.tube;
  const PetscBool in_tube = (PetscBool)(tube->radius > 0), driven = (PetscBool)(tube->period > 0);
  const PetscInt flow = s->flow.type;
  const PetscReal mouth = tube->throat_mouth > 0 ? tube->throat_mouth : tube->radius;
  PetscFunctionBeginUser;
  if (s->dim != DIM_AXIAL) PetscFunctionReturn(PETSC_SUCCESS);
  const SceneRule rules[] = {
    {flow != FLOW_QUIESCENT && flow != FLOW_AXIAL && flow != FLOW_TUBE && flow != FLOW_UNIFORM,
     "-flow_type {-flow_type}: not axisymmetric about x; allowed with -dim axisymmetric: quiescent, axial, tube and uniform"},
    {flow != FLOW_QUIESCENT && s->flow.center[1] != 0,
     "-flow_center_y {-flow_center_y}: off the axis; allowed with -dim axisymmetric: 0"},
    {flow == FLOW_UNIFORM && !SceneAlongAxis(&s->flow.velocity, PETSC_FALSE),
     "-flow_velocity {-flow_velocity}: off the axis; allowed with -dim axisymmetric: u_x,0,0"},
    {!SceneAlongAxis(&s->vesicles.center, PETSC_FALSE),
     "-vesicle_center {-vesicle_center}: off the axis; allowed with -dim axisymmetric: x,0,0"},
    {!SceneAlongAxis(&s->space.axis, PETSC_FALSE),
     "-vesicle_axis {-vesicle_axis}: not along the axis; allowed with -dim axisymmetric: 1,0,0"},
    {SceneGiven(s, "-vesicle_half_axes") && !SceneAlongAxis(&s->space.half_axes, PETSC_TRUE),
     "-vesicle_half_axes {-vesicle_half_axes}: no body of revolution; allowed with -dim axisymmetric: the second equal to the third"},
    {!SceneAlongAxis(&s->gravity.g, PETSC_FALSE),
     "-fluid_gravity {-fluid_gravity}: off the axis; allowed with -dim axisymmetric: g_x,0,0"},
    {in_tube && flow != FLOW_QUIESCENT && flow != FLOW_TUBE,
     "-flow_type {-flow_type}: with -tube_radius {-tube_radius}; allowed: quiescent and tube"},
    {in_tube && flow == FLOW_TUBE && SceneGiven(s, "-flow_half_width") && s->flow.half_width != tube->radius,
     "-flow_half_width {-flow_half_width}: with -tube_radius {-tube_radius}; allowed: the same number, or none"},
    {in_tube && tube->throat >= tube->radius,
     "-tube_throat {-tube_throat}: not narrower than the tube; allowed: below -tube_radius {-tube_radius}, or 0"},
    {in_tube && tube->throat > 0 && SceneHasContrast(s),
     "-vesicle_viscosity_ratio {-vesicle_viscosity_ratio}: with -tube_throat {-tube_throat}; allowed in a throat: 1"},
    {in_tube && driven && !SceneGiven(s, "-tube_pressure_drop"),
     "-tube_period {-tube_period}: without -tube_pressure_drop; allowed: with it, or 0"},
    {in_tube && driven && tube->throat > 0 && tube->period < tube->throat_length + 2 * mouth,
     "-tube_period {-tube_period}: shorter than the throat and its mouths; allowed: from %g", {tube->throat_length + 2 * mouth}},
    {tube->pressure_drop != 0 && (flow != FLOW_TUBE || !driven),
     "-tube_pressure_drop {-tube_pressure_drop}: without what it needs; allowed: with -flow_type tube and -tube_period"},
    {driven && (SceneGiven(s, "-flow_peak_velocity") || s->flow.ca != 0),
     "-tube_pressure_drop {-tube_pressure_drop}: with -flow_peak_velocity or -flow_ca; allowed: one of them"}};
  PetscCall(REFUSE(s, rules));
  if (in_tube) s->flow.half_width = tube->radius;
  tube->throat_mouth = mouth;
  if (driven) s->flow.peak = tube->pressure_drop * tube->radius * tube->radius / (4 * s->fluid.nu * tube->period);
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

PetscErrorCode SceneResolveSpace(Draft s) {
  PetscReal R0[2], bending, relaxation;
  SurfaceRows rows = {0};
  PetscFunctionBeginUser;
  PetscCall(SceneReadSurfaces(s, &rows));
  PetscCall(SceneCheckSpace(s));
  PetscCall(SceneResolveAxial(s));
  PetscCall(SceneChooseByError(s, AUTO_SPACE));
  PetscCall(OptionsDepend(&s->options, s));
  PetscCall(SceneMakeSurfaces(s, &rows));
  SceneSpaceScales(s, R0, &bending, &relaxation);
  if (s->flow.chi != 0) s->flow.rate = s->flow.chi * bending / (s->fluid.nu * R0[0] * R0[0] * R0[0]);
  if (s->flow.ca != 0) s->flow.peak = s->flow.ca * bending / (s->fluid.nu * R0[0] * R0[0]);
  if (s->repulsion.stress > 0 && s->repulsion.range == 0) s->repulsion.range = R0[1] / 10;
  PetscReal rate = FlowShearRate(&s->flow);
  PetscCall(Flow3Check(s->comm, &s->flow, s->vesicles.count, &s->vesicles.center, R0[0], s->time.end, &rate));
  if (s->space.label_rate == 0) s->space.label_rate = 10 * PetscMax(rate, relaxation);
  PetscFunctionReturn(PETSC_SUCCESS);
}
