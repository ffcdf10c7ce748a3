/* The places of vesicles: at the centres given, or packed into the box. */
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

/* Rank 0 packs and tells the others. */
static PetscErrorCode ScenePack(Scene scene, const Kinds *kinds, Pose pose[]) {
  const SceneVesicles *own = &scene->vesicles;
  const PetscBool lattice = own->packing_type == PACKING_LATTICE ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal cells = scene->coupling.near_field == NEAR_EXACT ? KERNEL_FOLDED_CELLS : KERNEL_WALL_CELLS;
  const PetscReal wall = (cells + LEEWAY) * FluidSpecCellSize(&scene->fluid);
  PackingSpec spec = {.seed = own->packing_seed};
  PetscReal *axes, part = 0, along[2];
  PetscMPIInt rank;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(scene->comm, &rank));
  PetscCall(PackedGap(scene, kinds, &spec.gap));
  spec.wall_gap = PetscMax(spec.gap, wall);
  PetscCall(PetscArraycpy(spec.box, scene->fluid.box, 4));
  for (int d = 0; d < 2; d++) spec.periodic[d] = scene->fluid.bc[d] == BC_PERIODIC ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscMalloc1(2 * kinds->vesicles, &axes));
  for (PetscInt v = 0; v < kinds->vesicles; v++)
    PetscCall(PetscArraycpy(axes + 2 * v, kinds->kind[kinds->of[v]].curve.axes, 2));
  VesicleDirection(scene, 0, along);
  if (!rank && lattice) PetscCall(PackLattice(&spec, kinds->vesicles, axes, along, pose, &part));
  if (!rank && !lattice) PetscCall(PackRandomly(&spec, kinds->vesicles, axes, pose, &part));
  if (!rank && !lattice && part >= 1) PetscCall(PackedNumber(kinds, pose));
  PetscCall(PetscFree(axes));
  PetscCallMPI(MPI_Bcast(&part, 1, MPIU_REAL, 0, scene->comm));
  PetscCallMPI(MPI_Bcast(pose, (PetscMPIInt)(sizeof(Pose) / sizeof(PetscReal) * (size_t)kinds->vesicles), MPIU_REAL, 0,
                         scene->comm));
  PetscCheck(part >= 1, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_packing %g: %" PetscInt_FMT
             " vesicles at least %.3g apart (-vesicle_packing_gap) %s reached %.3g; "
             "allowed: a lower fraction, a smaller gap, or shorter vesicles",
             (double)own->packing, kinds->vesicles, (double)spec.gap,
             lattice ? "on a lattice, turned by -vesicle_angle," : "at random places", (double)(part * own->packing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScenePlace(Scene scene, const Kinds *kinds, Pose pose[]) {
  PetscFunctionBeginUser;
  if (scene->vesicles.packing > 0 && scene->vesicles.shape == SHAPE_ELLIPSE) {
    PetscCall(ScenePack(scene, kinds, pose));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt v = 0; v < kinds->vesicles; v++) {
    for (int c = 0; c < 2; c++) pose[v].center[c] = ListEntry(&scene->vesicles.center, 2, v, c);
    VesicleDirection(scene, v, pose[v].along);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
