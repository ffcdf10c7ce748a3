/* The kinds of vesicles of a scene: the kind of each vesicle, and the markers that all vesicles of a kind share. */
#include "scene/vesicles.h"
#include "kernel/kernel.h"
#include "scene/checks.h"
#include "scene/properties.h"

#define MAX_NEWTON 20 /* of the first markers; four are usual */
#define MANY 100      /* markers, from which on it matters that Fourier transforms of them are fast */
#define LEEWAY 0.04   /* by which their number may differ for it */

/* The odd number with prime factors up to 13 that is nearest to M, if one is near. */
static PetscInt KindFastOdd(PetscInt M) {
  for (PetscInt away = 0; away <= LEEWAY * M; away += 2)
    for (int side = -1; side <= 1; side += 2) {
      PetscInt left = M + side * away;
      for (PetscInt p = 3; p <= 13; p += 2)
        while (left % p == 0) left /= p;
      if (left == 1) return M + side * away;
    }
  return M;
}

#define STRONG 100 /* chi from which on membranes wrinkle */
#define THINNEST 8 /* times the markers of a round vesicle, at most */

/* Number of markers for the exact near field, where markers have to resolve the shape and not the grid: 45 for a
   reduced area of 0.6 and more, in proportion more for thinner vesicles, and half as many more where the flow is so
   strong that membranes wrinkle. No edge is longer than two cells, so that the kernel leaks nothing. */
static PetscReal KindMarkersByShape(Scene scene, const Kind *kind) {
  const PetscReal length = kind->length, V = 4 * PETSC_PI * kind->area / PetscSqr(length),
                  thin = PetscMin(THINNEST, PetscMax(1, 0.6 / V));
  const PetscReal rate = FlowShearRate(&scene->flow) * scene->fluid.nu * PetscPowRealInt(length / (2 * PETSC_PI), 3);
  const PetscReal strong = kind->material.bending > 0 && rate >= STRONG * (1 - 1e-6) * kind->material.bending ? 1.5 : 1;
  return PetscMax(45 * thin * strong, length / (2 * FluidSpecCellSize(&scene->fluid)));
}

/* Dense matrices of a vesicle grow with the square of its markers: 3 GB and more above it, and 32-bit sizes end soon.
 */
#define MOST_MARKERS 10000

/* clang-format off */
/* Number of markers of a curve: the user's own; by the shape; or the even (for spectral edges odd) number nearest to
   length/(spacing h). They are as far apart as kernel and near field need. */
static PetscErrorCode KindMarkerCount(Scene scene, const Kind *kind, PetscBool spectral, PetscInt *M) {
  const Kernel *kernel = KernelFind(scene->coupling.kernel);
  const SceneVesicles *own = &scene->vesicles;
  const PetscBool exact = scene->coupling.near_field == NEAR_EXACT, by_shape = exact && !own->markers && own->spacing == 0;
  const PetscReal spacing = own->spacing > 0 ? own->spacing : kernel->default_spacing;
  const PetscReal least = exact ? NEAR_LEAST_SPACING : kernel->least_spacing;
  const PetscReal length = kind->length, h = FluidSpecCellSize(&scene->fluid), pairs = length / (2 * spacing * h);
  const PetscReal wanted = own->markers ? own->markers : (by_shape ? KindMarkersByShape(scene, kind) : 2 * pairs);
  const SceneRule many[] = {
    {own->markers > MOST_MARKERS,
     "-vesicle_markers {-vesicle_markers}: more than the dense matrices of a vesicle hold; allowed: at most %.0f", {MOST_MARKERS}},
    {wanted > MOST_MARKERS,
     "-vesicle_spacing {-vesicle_spacing}: %.3g markers on a membrane of length %g at h = %g; allowed: at most %.0f a vesicle, so a smaller vesicle, a larger spacing or coarser -domain_cells", {wanted, length, h, MOST_MARKERS}}};
  PetscFunctionBeginUser;
  PetscCall(REFUSE(scene, many));
  if (own->markers)
    *M = own->markers;
  else if (by_shape)
    *M = 2 * (PetscInt)PetscCeilReal((wanted - 1) / 2 * (1 - 1e-12)) + 1;
  else /* odd: no Nyquist mode */
    *M = spectral ? 2 * (PetscInt)PetscFloorReal(pairs) + 1 : 2 * (PetscInt)PetscFloorReal(pairs + 0.5);
  if (!own->markers && !by_shape && spectral && *M > MANY) *M = KindFastOdd(*M);
  /* rounding to a number of markers may go just below the limit */
  const PetscReal apart = own->spacing > 0 ? own->spacing : length / (*M * h);
  const PetscBool close = !own->allow_close_markers && apart < least * (1 - 1e-12);
  const SceneRule few[] = {
    {*M < 8,
     "-vesicle_spacing %g: %.0f markers on a membrane of length %g at h = %g; allowed: at least 8, so a finer -domain_cells", {spacing, *M, length, h}},
    {close && own->markers,
     "-vesicle_markers %g: markers %g h apart with -delta_type {-delta_type}; allowed: at least %g h (-vesicle_allow_close_markers goes on)", {own->markers, apart, least}},
    {close && own->spacing > 0,
     "-vesicle_spacing %g: markers %g h apart with -delta_type {-delta_type}; allowed: at least %g h (-vesicle_allow_close_markers goes on)", {spacing, apart, least}}};
  PetscCall(REFUSE(scene, few));
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

/* M markers X[2M], to be freed, on a curve of this length and area. */
static PetscErrorCode KindFitCurve(const Curve *curve, PetscReal length, PetscReal area, PetscBool spectral, PetscInt M,
                                   PetscReal **X) {
  PetscReal left;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * M, X));
  PetscCall(CurveEqualEdges(curve, NULL, spectral ? PETSC_FALSE : PETSC_TRUE, M, *X));
  /* what M markers sample of a curve with sharper tips than they resolve has neither its length nor its area */
  if (spectral) PetscCall(CurveFit(M, spectral, length, area, *X, MAX_NEWTON, &left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define SAME_LENGTH 1e-6 /* relative, of a membrane that does not stretch and its shape at rest */

/* The shape at rest, where it is another one than the first. */
static PetscErrorCode KindFitRest(Scene scene, PetscBool spectral, Kind *kind) {
  const char *const file = scene->membrane.rest;
  const PetscReal R0 = kind->length / (2 * PETSC_PI);
  Curve circle = {.axes = {R0, R0}}, *curve = &circle;
  PetscInt curves = 1;
  PetscFunctionBeginUser;
  if (!strcmp(file, "initial")) PetscFunctionReturn(PETSC_SUCCESS);
  if (strcmp(file, "circle"))
    PetscCall(CurvesFromFile(scene->comm, "-membrane_rest", file, NULL, &curves, &curve, NULL));
  const PetscReal length = CurveLength(curve);
  const SceneRule rules[] = {{curves != 1, "-membrane_rest {-membrane_rest}: %.0f curves; allowed: one", {curves}},
                             {kind->material.modulus <= 0 && PetscAbsReal(length / kind->length - 1) >= SAME_LENGTH,
                              "-membrane_rest {-membrane_rest}: the curve is %g long, a membrane that does not stretch "
                              "%g; allowed: the same length",
                              {length, kind->length}}};
  PetscCall(REFUSE(scene, rules));
  PetscCall(KindFitCurve(curve, length, CurveArea(curve), spectral, kind->M, &kind->rest));
  if (curve == &circle) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CurveDestroy(curve));
  PetscCall(PetscFree(curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode KindFit(Scene scene, Kind *kind) {
  const PetscBool spectral = scene->membrane.derivative == DERIVATIVE_SPECTRAL;
  PetscFunctionBeginUser;
  PetscCall(KindMarkerCount(scene, kind, spectral, &kind->M));
  PetscCall(KindFitCurve(&kind->curve, kind->length, kind->area, spectral, kind->M, &kind->X));
  PetscCall(KindFitRest(scene, spectral, kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The membrane by entry k of the lists. */
static Material KindMaterial(Scene scene, PetscInt k) {
  const SceneMembrane *m = &scene->membrane;
  Material o = {.bending = ListEntry(&m->stiffness, 1, k, 0),
                .modulus = ListEntry(&m->stretching, 1, k, 0),
                .memory = ListEntry(&m->memory, 1, k, 0)};
  if (o.modulus == 0) return o;
  o.law = (LawType)m->law.v[m->law.n > 1 ? k : 0];
  o.viscosity = ListEntry(&m->viscosity, 1, k, 0);
  return o;
}

/* Set what defines an ellipse or a biconcave outline, of vesicle v. */
static void KindGive(Scene scene, PetscInt v, Kind *kind) {
  const SceneVesicles *own = &scene->vesicles;
  const PetscBool by_area = SceneByArea(scene);
  const PetscInt k = SceneKindOf(scene, v);
  kind->given[0] = by_area ? own->area_scale * ListEntry(&own->area, 1, k, 0) : ListEntry(&own->axes, 2, k, 0);
  kind->given[1] = by_area ? ListEntry(&own->reduced_area, 1, k, 0) : ListEntry(&own->axes, 2, k, 1);
  kind->material = KindMaterial(scene, k);
}

static PetscErrorCode KindsOfEllipses(Scene scene, Kinds *all) {
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(all->vesicles, &all->kind));
  for (PetscInt v = 0; v < all->vesicles; v++) {
    Kind *next = &all->kind[all->kinds];
    const PetscReal *given = next->given;
    PetscInt k = 0;
    KindGive(scene, v, next);
    while (memcmp(all->kind[k].given, given, sizeof(next->given)) ||
           !MaterialsAlike(&all->kind[k].material, &next->material))
      k++;
    all->of[v] = k;
    if (k < all->kinds) continue;
    all->kinds++;
    if (scene->vesicles.shape == SHAPE_BICONCAVE)
      PetscCall(BiconcaveCurve(given[0], given[1], &next->curve));
    else if (SceneByArea(scene))
      PetscCall(EllipseAxes(given[0], given[1], next->curve.axes));
    else
      PetscCall(PetscArraycpy(next->curve.axes, given, 2));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* clang-format off */
static PetscErrorCode KindsOfFile(Scene scene, Kinds *all) {
  static const char *const lists[] = {"-vesicle_angle",       "-vesicle_bending",    "-membrane_law",
                                      "-membrane_stretching", "-membrane_viscosity", "-membrane_memory"};
  const SceneVesicles *own = &scene->vesicles;
  Curve *curve;
  PetscFunctionBeginUser;
  PetscCall(CurvesFromFile(scene->comm, "-vesicle_file", own->file, NULL, &all->vesicles, &curve, NULL));
  all->kinds = all->vesicles;
  PetscCall(PetscMalloc1(all->vesicles, &all->of));
  PetscCall(PetscCalloc1(all->kinds, &all->kind));
  for (PetscInt k = 0; k < all->kinds; k++) all->kind[k].curve = curve[k];
  PetscCall(PetscFree(curve));
  PetscCall(SCENE_REFUSE_IF(scene, SceneGiven(scene, "-vesicle_count") && own->count != all->vesicles,
    "-vesicle_count {-vesicle_count}: -vesicle_file {-vesicle_file} has %.0f curves; allowed: the same number", {all->vesicles}));
  PetscCall(SceneCheckList(scene, "-vesicle_center", 2, all->vesicles, "curves", "a curve"));
  for (size_t k = 0; k < sizeof(lists) / sizeof(lists[0]); k++)
    PetscCall(SceneCheckList(scene, lists[k], 1, all->vesicles, "curves", "a curve"));
  for (PetscInt k = 0; k < all->kinds; k++) {
    all->of[k] = k;
    all->kind[k].material = KindMaterial(scene, k);
    if (ListEntry(&own->angle, 1, k, 0) != 0) CurveCentroid(&all->kind[k].curve, all->kind[k].pivot);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mean area of a vesicle by the mixture. */
static PetscReal KindsMeanArea(Scene scene) {
  const SceneVesicles *own = &scene->vesicles;
  PetscReal mean = 0;
  for (PetscInt k = 0; k < own->mixture.n; k++) {
    const PetscReal part = own->mixture.n > 1 ? own->mixture.v[k] : 1;
    const PetscReal axes = PETSC_PI * ListEntry(&own->axes, 2, k, 0) * ListEntry(&own->axes, 2, k, 1);
    mean += part * (SceneByArea(scene) ? ListEntry(&own->area, 1, k, 0) : axes);
  }
  return mean;
}

/* How many vesicles a packing takes, or with -vesicle_count their area. */
static PetscErrorCode KindsCountPacked(Draft scene) {
  SceneVesicles *own = &scene->vesicles;
  const PetscReal *b = scene->domain.box.v, box = (b[1] - b[0]) * (b[3] - b[2]); /* the fluid is not described yet */
  const PetscReal mean = KindsMeanArea(scene), wanted = own->packing * box / mean;
  const PetscBool counted = SceneGiven(scene, "-vesicle_count");
  const SceneRule rules[] = {
    {FluidSpecIsFree(&scene->fluid),
     "-vesicle_packing {-vesicle_packing}: not with -domain_bc_x free, where the box holds nothing; allowed: walls or periodic boundaries"},
    {!counted && (wanted < 0.5 || wanted >= PETSC_MAX_INT / 64),
     "-vesicle_packing {-vesicle_packing}: %.3g vesicles of area %g in a box of area %g; allowed: a fraction of at least one vesicle, and as many as can be numbered", {wanted, mean, box}}};
  PetscFunctionBeginUser;
  if (own->shape != SHAPE_ELLIPSE || own->packing == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(REFUSE(scene, rules));
  if (counted)
    own->area_scale = wanted / own->count;
  else
    own->count = (PetscInt)PetscFloorReal(wanted + 0.5);
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

/* The entry of the lists that each of -vesicle_count vesicles takes with -vesicle_mixture: one after another the kind
   that is furthest behind its part, so that any row of vesicles has the mixture. */
static PetscErrorCode KindsMix(Draft scene) {
  const RealList *part = &scene->vesicles.mixture;
  const PetscInt n = scene->vesicles.count;
  PetscInt *have;
  PetscFunctionBeginUser;
  if (part->n < 2 || scene->vesicles.shape >= SHAPE_FILE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, &scene->vesicles.kind));
  PetscCall(PetscCalloc1(part->n, &have));
  for (PetscInt v = 0; v < n; v++) {
    PetscInt next = 0;
    for (PetscInt k = 1; k < part->n; k++)
      if (part->v[k] * (v + 1) - have[k] > part->v[next] * (v + 1) - have[next] + 1e-9) next = k;
    have[next]++;
    scene->vesicles.kind[v] = next;
  }
  PetscCall(PetscFree(have));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rate or peak velocity from -flow_chi, -flow_ca or -flow_ca_stretching:

     value = number modulus/(nu R0^power),   R0 of the largest vesicle, modulus c_b or E_s, the largest. */
static PetscErrorCode FlowChoose(Draft scene, PetscReal stretching) {
  Flow *flow = &scene->flow;
  const PetscBool channel = flow->type == FLOW_POISEUILLE,
                  strain = flow->type == FLOW_SHEAR || flow->type == FLOW_EXTENSION;
  const PetscReal R0 = scene->shape.longest / (2 * PETSC_PI), c_b = scene->membrane.bending;
  const struct {
    const char *name, *stands_for;
    PetscBool used;
    int power;
    PetscReal number, modulus, *value;
    const char *without, *needs;
  } rows[] = {{"-flow_chi", "-flow_rate", strain, 3, flow->chi, c_b, &flow->rate,
               "vesicles that bend there is no time nu R0^3/c_b", "vesicles with -vesicle_bending"},
              {"-flow_ca", "-flow_peak_velocity", channel, 2, flow->ca, c_b, &flow->peak,
               "vesicles that bend there is no time nu R0^3/c_b", "vesicles with -vesicle_bending"},
              {"-flow_ca_stretching", "-flow_rate", strain, 1, flow->ca_stretching, stretching, &flow->rate,
               "membranes that stretch there is no time nu R0/E_s", "vesicles with -membrane_stretching"}};
  const char *taken = NULL;
  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof(rows) / sizeof(rows[0]); k++) {
    const double number = (double)rows[k].number;
    if (!rows[k].used || !SceneGiven(scene, rows[k].name)) continue;
    const char *also = SceneGiven(scene, rows[k].stands_for) ? rows[k].stands_for : taken;
    PetvesCheck(!also, scene->comm, "%s %g: given together with %s; allowed: one of them", rows[k].name, number, also);
    PetvesCheck(R0 > 0 && rows[k].modulus > 0, scene->comm, "%s %g: without %s; allowed: %s above 0, or %s",
                rows[k].name, number, rows[k].without, rows[k].needs, rows[k].stands_for);
    *rows[k].value = rows[k].number * rows[k].modulus / (scene->fluid.nu * PetscPowRealInt(R0, rows[k].power));
    PetvesCheck(!PetscIsInfOrNanReal(*rows[k].value), scene->comm,
                "%s %g: stands for a %s of %g; allowed: a finite one", rows[k].name, number, rows[k].stands_for + 1,
                (double)*rows[k].value);
    taken = rows[k].name;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode KindsCreate(Draft scene, Kinds *all) {
  PetscReal stretching = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(all, sizeof(*all)));
  PetscCall(KindsCountPacked(scene));
  PetscCall(KindsMix(scene));
  if (scene->vesicles.shape == SHAPE_FILE) PetscCall(KindsOfFile(scene, all));
  if (scene->vesicles.shape < SHAPE_FILE) {
    all->vesicles = scene->vesicles.count;
    PetscCall(PetscMalloc1(all->vesicles, &all->of));
    PetscCall(KindsOfEllipses(scene, all));
  }
  for (PetscInt k = 0; k < all->kinds; k++) {
    Kind *kind = &all->kind[k];
    kind->length = CurveLength(&kind->curve);
    kind->area = CurveArea(&kind->curve);
    scene->membrane.bending = PetscMax(scene->membrane.bending, kind->material.bending);
    stretching = PetscMax(stretching, kind->material.modulus);
    scene->shape.longest = PetscMax(scene->shape.longest, kind->length);
  }
  PetscCall(FlowChoose(scene, stretching));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode KindsDestroy(Kinds *all) {
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < all->kinds; k++) {
    PetscCall(CurveDestroy(&all->kind[k].curve));
    PetscCall(PetscFree(all->kind[k].X));
    PetscCall(PetscFree(all->kind[k].rest));
  }
  PetscCall(PetscFree(all->kind));
  PetscCall(PetscFree(all->of));
  PetscFunctionReturn(PETSC_SUCCESS);
}
