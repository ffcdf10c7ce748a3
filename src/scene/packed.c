/* The places of vesicles: at the centres given, or packed into the box together with posts. */
#include "scene/checks.h"
#include "scene/vesicles.h"
#include "kernel/kernel.h"
#include "scene/properties.h"

#define GAP_CELLS 1    /* cells of the default gap of a packing */
#define LEEWAY 0.25    /* cells that markers fitted to an ellipse may lie beside it */
#define GAP_RADII 0.05 /* the default gap over R0 of the smallest vesicle, at most, where its markers resolve that */

/* The gap of a packing: a cell, but at most a twentieth of R0; with the exact near field a film that markers resolve.
 */
static PetscErrorCode PackedGap(Scene scene, const Kinds *kinds, PetscReal *gap) {
  PetscReal R0 = PETSC_MAX_REAL, ds = 0;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < kinds->kinds; k++) {
    Kind *kind = &kinds->kind[k];
    if (!kind->M) PetscCall(KindFit(scene, kind));
    R0 = PetscMin(R0, kind->length / (2 * PETSC_PI));
    if (scene->coupling.near_field == NEAR_EXACT) ds = PetscMax(ds, kind->length / kind->M);
  }
  if (scene->obstacles.posts.count) ds = PetscMax(ds, scene->obstacles.spacing * FluidSpecCellSize(&scene->fluid));
  *gap = PetscMax(PetscMin(GAP_CELLS * FluidSpecCellSize(&scene->fluid), GAP_RADII * R0), SCENE_FILM * ds);
  if (scene->vesicles.packing_gap > 0) *gap = scene->vesicles.packing_gap;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void VesicleDirection(Scene scene, PetscInt v, PetscReal along[2]) {
  const PetscReal turn = ListEntry(&scene->vesicles.angle, 1, v, 0) * PETSC_PI / 180;
  along[0] = PetscCosReal(turn);
  along[1] = PetscSinReal(turn);
}

/* Number the vesicles of each kind from the bottom up: ranks own ranges of vesicles and of the grid's rows, so that
   vesicles that are near one another, and the rows that they are in, are mostly on one rank. */
static PetscErrorCode PackedNumber(const Kinds *kinds, Pose pose[]) {
  const PetscInt n = kinds->vesicles;
  PetscReal *height;
  PetscInt *from;
  Pose *old;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &height, n, &from, n, &old));
  PetscCall(PetscArraycpy(old, pose, n));
  for (PetscInt k = 0; k < kinds->kinds; k++) {
    PetscInt count = 0;
    for (PetscInt v = 0; v < n; v++) {
      if (kinds->of[v] != k) continue;
      height[count] = old[v].center[1];
      from[count++] = v;
    }
    PetscCall(PetscSortRealWithArrayInt(count, height, from));
    for (PetscInt v = n - 1; v >= 0; v--)
      if (kinds->of[v] == k) pose[v] = old[from[--count]];
  }
  PetscCall(PetscFree3(height, from, old));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* clang-format off */
static PetscErrorCode PackedCheckPosts(Scene s) {
  const SceneRule rules[] = {
    {s->vesicles.packing == 0 && s->vesicles.shape != SHAPE_NONE,
     "-obstacle_count {-obstacle_count}: posts are packed, and the vesicles are not; allowed: -vesicle_packing, -vesicle_shape none, or -obstacle_center"},
    {s->vesicles.packing > 0 && s->vesicles.packing_type == PACKING_LATTICE,
     "-obstacle_count {-obstacle_count}: not with -vesicle_packing_type lattice; allowed: random"}};
  PetscFunctionBeginUser;
  PetscCall(REFUSE(s, rules));
  PetscCall(SceneCheckList(s, "-obstacle_radius", 1, s->obstacles.posts.count, "obstacles", "each"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PackedCheckRoom(Scene s, PetscInt vesicles, PetscReal gap, PetscReal part) {
  const SceneRule rules[] = {
    {part < 1 && s->vesicles.packing_type == PACKING_LATTICE,
     "-vesicle_packing {-vesicle_packing}: %.0f vesicles at least %.3g apart (-vesicle_packing_gap) on a lattice, turned by -vesicle_angle, reached %.3g; allowed: a lower fraction, a smaller gap, or shorter vesicles", {vesicles, gap, part * s->vesicles.packing}},
    {part < 1 && !s->obstacles.posts.count,
     "-vesicle_packing {-vesicle_packing}: %.0f vesicles at least %.3g apart (-vesicle_packing_gap) at random places reached %.3g; allowed: a lower fraction, a smaller gap, or shorter vesicles", {vesicles, gap, part * s->vesicles.packing}},
    {part < 1,
     "-obstacle_count {-obstacle_count}: posts and %.0f vesicles at least %.3g apart (-vesicle_packing_gap) reached %.3g of their area; allowed: fewer posts, a smaller -obstacle_radius, -vesicle_packing or gap", {vesicles, gap, part}}};
  return REFUSE(s, rules);
}
/* clang-format on */

/* Rank 0 packs and tells the others. */
static PetscErrorCode ScenePack(Draft scene, const Kinds *kinds, PetscInt posts, Pose pose[]) {
  const SceneVesicles *own = &scene->vesicles;
  const PetscInt n = kinds->vesicles, all = n + posts;
  const PetscBool lattice = own->packing_type == PACKING_LATTICE;
  const PetscReal cells = scene->coupling.near_field == NEAR_EXACT ? KERNEL_FOLDED_CELLS : KERNEL_WALL_CELLS;
  const PetscReal wall = (cells + LEEWAY) * FluidSpecCellSize(&scene->fluid);
  PackingSpec spec = {.seed = own->packing_seed};
  PetscReal *axes, part = 0, along[2];
  PetscMPIInt rank;
  Pose *packed;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(scene->comm, &rank));
  PetscCall(PackedGap(scene, kinds, &spec.gap));
  spec.wall_gap = PetscMax(spec.gap, wall);
  PetscCall(PetscArraycpy(spec.box, scene->fluid.box, 4));
  for (int d = 0; d < 2; d++) spec.periodic[d] = scene->fluid.bc[d] == BC_PERIODIC;
  PetscCall(PetscMalloc2(2 * all, &axes, all, &packed));
  for (PetscInt v = 0; v < n; v++) PetscCall(PetscArraycpy(axes + 2 * v, kinds->kind[kinds->of[v]].curve.axes, 2));
  for (PetscInt k = 0; k < 2 * posts; k++) axes[2 * n + k] = ListEntry(&scene->obstacles.radius, 1, k / 2, 0);
  if (!rank && lattice && n) {
    VesicleDirection(scene, 0, along);
    PetscCall(PackLattice(&spec, n, axes, along, packed, &part));
  } else if (!rank)
    PetscCall(PackRandomly(&spec, all, axes, packed, &part));
  if (!rank && !lattice && part >= 1) PetscCall(PackedNumber(kinds, packed));
  PetscCallMPI(MPI_Bcast(&part, 1, MPIU_REAL, 0, scene->comm));
  PetscCallMPI(
      MPI_Bcast(packed, (PetscMPIInt)(sizeof(Pose) / sizeof(PetscReal) * (size_t)all), MPIU_REAL, 0, scene->comm));
  PetscCall(PackedCheckRoom(scene, n, spec.gap, part));
  PetscCall(PetscArraycpy(pose, packed, n));
  PetscCall(PetscFree(scene->obstacles.posts.packed)); /* of another number of markers */
  if (posts) PetscCall(PetscMalloc1(2 * posts, &scene->obstacles.posts.packed));
  for (PetscInt k = 0; k < 2 * posts; k++) scene->obstacles.posts.packed[k] = packed[n + k / 2].center[k % 2];
  PetscCall(PetscFree2(axes, packed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScenePlace(Draft scene, const Kinds *kinds, Pose pose[]) {
  const PetscInt posts = scene->obstacles.shape == OBSTACLE_POSTS ? scene->obstacles.posts.count : 0;
  const PetscBool packed = posts || (scene->vesicles.packing > 0 && scene->vesicles.shape == SHAPE_ELLIPSE);
  PetscFunctionBeginUser;
  if (posts) PetscCall(PackedCheckPosts(scene));
  if (packed) PetscCall(ScenePack(scene, kinds, posts, pose));
  for (PetscInt v = 0; v < kinds->vesicles && !packed; v++) {
    for (int c = 0; c < 2; c++) pose[v].center[c] = ListEntry(&scene->vesicles.center, 2, v, c);
    VesicleDirection(scene, v, pose[v].along);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
