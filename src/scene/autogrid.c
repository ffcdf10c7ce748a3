/* -scheme_auto: what grids leave, by what was measured (docs/speed_accuracy/calibration.csv). */
#include "scene/auto.h"

/* Worst errors over vesicles in shear, in a channel, between four walls, in pairs and with viscosity contrast, by R0/h;
   few: with markers 1.5 h apart, whose number is what fails first (tests/test_auto.py compares with the table). */
static const struct {
  PetscReal cells, error, few;
} grids[] = {{8, 6.5e-5, 7.3e-4},
             {6, 1.1e-4, 4.1e-3},
             {4, 2.1e-4, 4.3e-2},
             {3, 7.7e-4, PETSC_MAX_REAL},
             {2, 2.2e-3, PETSC_MAX_REAL}};
#define GRIDS ((int)(sizeof(grids) / sizeof(grids[0])))

/* Worst errors over the gap of a vesicle that begins so many cells from a wall. */
static const struct {
  PetscReal cells, error;
} walls[] = {{3.2, 2.3e-4}, {2.4, 1.1e-3}, {1.6, 5.8e-3}, {1.2, 0.027}, {0.8, 0.054}, {0.6, 0.14}, {0.4, 0.17}};
#define WALLS ((int)(sizeof(walls) / sizeof(walls[0])))

#define LEEWAY 0.01 /* of R0, by which markers fitted to a curve may miss it */

PetscReal SceneGridError(PetscReal cells, PetscBool many) {
  for (int k = 0; k < GRIDS; k++)
    if (cells >= grids[k].cells * (1 - LEEWAY)) return many ? grids[k].error : grids[k].few;
  return PETSC_MAX_REAL;
}

PetscReal SceneCellsFor(PetscReal error, PetscBool many) {
  for (int k = GRIDS - 1; k >= 0; k--)
    if ((many ? grids[k].error : grids[k].few) <= error) return grids[k].cells;
  return grids[0].cells;
}

PetscReal SceneWallError(PetscReal gap, PetscReal h) {
  if (gap > walls[0].cells * h * (1 + LEEWAY)) return 0;
  for (int k = 0; k < WALLS; k++)
    if (gap >= walls[k].cells * h * (1 - 1e-9)) return walls[k].error * gap;
  return PETSC_MAX_REAL;
}

/* Whether n has no prime factor above 5: what Fourier transforms like. */
static PetscBool IsSmooth(PetscInt n) {
  for (PetscInt prime = 2; prime <= 5; prime++)
    while (n % prime == 0) n /= prime;
  return n == 1 ? PETSC_TRUE : PETSC_FALSE;
}

/* The least whole numbers in proportion to the sides of a box; false: none up to the most cells across. */
static PetscBool Sides(const PetscReal box[4], PetscInt sides[2]) {
  const PetscReal ratio = (box[1] - box[0]) / (box[3] - box[2]);
  for (sides[1] = 1; sides[1] * PetscMax(ratio, 1) <= SCENE_MOST_ACROSS; sides[1]++) {
    sides[0] = (PetscInt)PetscFloorReal(sides[1] * ratio + 0.5);
    if (sides[0] > 0 && PetscAbsReal(sides[1] * ratio - sides[0]) <= 1e-11 * sides[0]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

#define LEAST_ACROSS 8

PetscBool SceneSquareCells(const PetscReal box[4], PetscReal h, PetscInt cells[2]) {
  PetscInt sides[2];
  if (!Sides(box, sides)) return PETSC_FALSE;
  const PetscReal wanted = PetscMax((box[1] - box[0]) / (h * sides[0]) * (1 - 1e-9),
                                    (PetscReal)LEAST_ACROSS / PetscMin(sides[0], sides[1]));
  if (wanted * PetscMax(sides[0], sides[1]) > SCENE_MOST_ACROSS) return PETSC_FALSE;
  PetscInt times = (PetscInt)PetscCeilReal(wanted);
  while (!IsSmooth(times)) times++;
  for (int d = 0; d < 2; d++) cells[d] = sides[d] * times;
  return PetscMax(cells[0], cells[1]) <= SCENE_MOST_ACROSS ? PETSC_TRUE : PETSC_FALSE;
}

/* What the wall errors were measured up to, in cells a R0. */
#define FINEST 16

PetscBool SceneWallCells(const PetscReal box[4], PetscReal h, PetscReal R0, PetscReal gap, PetscReal error,
                         PetscInt cells[2]) {
  PetscReal next = h;
  while (SceneSquareCells(box, next, cells)) {
    const PetscReal now = (box[1] - box[0]) / cells[0];
    if (SceneWallError(gap / R0, now / R0) <= error) return PETSC_TRUE;
    next = 0.999 * now;
    if (next < R0 / FINEST) break;
  }
  return PETSC_FALSE;
}

#define MARKERS 45

static PetscInt FewestMarkers(const Shape *shape) {
  PetscInt fewest = PETSC_MAX_INT;
  for (PetscInt v = 0; v < shape->vesicles; v++) fewest = PetscMin(fewest, shape->start[v + 1] - shape->start[v]);
  return fewest;
}

/* The least distance of a marker from a wall; PETSC_MAX_REAL without walls. */
static PetscReal WallGap(Scene scene) {
  const FluidSpec *f = &scene->fluid;
  const Shape *s = &scene->shape;
  PetscReal gap = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < s->start[s->vesicles]; k++)
    for (int d = 0; d < 2; d++)
      if (f->bc[d] == BC_WALL)
        gap = PetscMin(gap, PetscMin(s->X[2 * k + d] - f->box[2 * d], f->box[2 * d + 1] - s->X[2 * k + d]));
  return gap;
}

/* What walls leave that are so near that the grid is felt, and what it would take. */
static PetscErrorCode ReportWall(Scene scene) {
  const PetscReal R0 = SceneSmallestRadius(scene), h = FluidSpecCellSize(&scene->fluid), gap = WallGap(scene);
  const PetscReal error = gap < PETSC_MAX_REAL ? SceneWallError(gap / R0, h / R0) : 0;
  char what[128] = "enough";
  PetscInt cells[2];
  PetscFunctionBeginUser;
  if (error == 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (error > scene->scheme.wanted * (1 + 1e-9)) {
    if (scene->vesicles.packing > 0 && scene->vesicles.packing_gap == 0)
      PetscCall(PetscSNPrintf(what, sizeof(what), "TOO NEAR for %g, give -vesicle_packing_gap",
                              (double)scene->scheme.wanted));
    else if (SceneWallCells(scene->fluid.box, h, R0, gap, scene->scheme.wanted, cells))
      PetscCall(PetscSNPrintf(what, sizeof(what),
                              "TOO NEAR for %g, take -domain_cells %" PetscInt_FMT ",%" PetscInt_FMT,
                              (double)scene->scheme.wanted, cells[0], cells[1]));
    else
      PetscCall(PetscSNPrintf(what, sizeof(what), "TOO NEAR for %g, and for any grid up to R0/h = %d",
                              (double)scene->scheme.wanted, FINEST));
  }
  PetscCall(PetvesSay(scene->comm, "  nearest wall: %.3g cells, which leaves ", (double)(gap / h)));
  if (error < PETSC_MAX_REAL)
    PetscCall(PetvesSay(scene->comm, "up to %.2g of R0: %s\n", (double)error, what));
  else
    PetscCall(PetvesSay(scene->comm, "more than was measured: %s\n", what));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a grid that is too coarse would take. */
static PetscErrorCode SayFiner(Scene scene, PetscReal cells, PetscBool many) {
  const PetscReal wanted = scene->scheme.wanted, enough = SceneCellsFor(wanted, many);
  PetscInt finer[2];
  PetscFunctionBeginUser;
  if (SceneGridError(enough, many) > wanted ||
      !SceneSquareCells(scene->fluid.box, SceneSmallestRadius(scene) / enough, finer)) {
    PetscCall(PetvesSay(scene->comm, ": no grid up to R0/h = %g reached %g\n", (double)grids[0].cells, (double)wanted));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetvesSay(
      scene->comm, ": TOO COARSE for %g, take R0/h = %g, -domain_cells %" PetscInt_FMT ",%" PetscInt_FMT "%s\n",
      (double)wanted, (double)enough, finer[0], finer[1],
      !many && SceneGridError(cells, PETSC_TRUE) <= wanted ? ", or this grid and -vesicle_markers 45" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneReportGrid(Scene scene) {
  const PetscReal cells = SceneSmallestRadius(scene) / FluidSpecCellSize(&scene->fluid);
  const PetscBool many = FewestMarkers(&scene->shape) >= MARKERS ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal error = SceneGridError(cells, many);
  PetscFunctionBeginUser;
  if (FluidSpecIsFree(&scene->fluid)) {
    PetscCall(PetvesSay(scene->comm, "  grid: none, unbounded fluid: enough\n"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetvesSay(scene->comm, "  grid: R0/h = %.3g", (double)cells));
  if (error < PETSC_MAX_REAL)
    PetscCall(PetvesSay(scene->comm, ", which leaves up to %.2g", (double)error));
  else
    PetscCall(PetvesSay(scene->comm, ", coarser than any that was measured"));
  if (error <= scene->scheme.wanted * (1 + 1e-9))
    PetscCall(PetvesSay(scene->comm, ": enough\n"));
  else
    PetscCall(SayFiner(scene, cells, many));
  PetscCall(ReportWall(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
