/* -scheme_auto: what grids leave, by what was measured (docs/speed_accuracy/calibration.csv). */
#include "scene/auto.h"
#include "scene/checks.h"
#include "scene/properties.h"

/* Worst errors over vesicles in shear, in a channel, between four walls, in pairs and with viscosity contrast, by R0/h;
   few: with markers 1.5 h apart, whose number is what fails first; inertia: in unsteady and convective flow, up to
   Reynolds numbers of 1 (tests/program/test_auto.py compares with the table). */
static const struct {
  PetscReal cells, error, few, inertia;
} grids[] = {{24, 2.5e-5, 8.1e-4, 2.9e-4},       {16, 2.5e-5, 8.1e-4, 7.7e-4},      {12, 2.5e-5, 8.1e-4, 1.5e-3},
             {8, 2.5e-5, 8.1e-4, 3.3e-3},        {6, 4.1e-5, 4.0e-3, 5.5e-3},       {4, 4.4e-5, 4.3e-2, 0.013},
             {3, 1.1e-4, PETSC_MAX_REAL, 0.021}, {2, 1.8e-4, PETSC_MAX_REAL, 0.031}};
#define GRIDS ((int)(sizeof(grids) / sizeof(grids[0])))
#define FINEST_QUIET 3 /* row of the finest grid that was measured without inertia */

/* Worst errors over the gap of a vesicle that begins so many cells from a wall: where the box part takes the grid's
   error beside walls off, and where not. There it goes on beyond the last row as h^2 over the gap. */
static const struct {
  PetscReal cells, error, plain;
} walls[] = {{3.2, 1.5e-4, 0.0235}, {2.4, 3.4e-4, 0.041}, {1.6, 3.4e-4, 0.077}, {1.2, 1.5e-3, 0.102},
             {0.8, 1.5e-3, 0.17},   {0.6, 1.5e-3, 0.23},  {0.4, 1.5e-3, 0.41}};
#define WALLS ((int)(sizeof(walls) / sizeof(walls[0])))

#define LEEWAY 0.01 /* of R0, by which markers fitted to a curve may miss it */

AutoFluid SceneAutoFluid(Scene scene, PetscReal R0) {
  const char *why;
  if (SceneHasInertia(scene, R0, &why)) return AUTO_INERTIA;
  return SceneHasBoxPart(scene) ? AUTO_BOX_PART : AUTO_NO_BOX_PART;
}

/* Worst error, of markers or energy over R0, that the calibration has for so many cells a R0; many: with 45 markers a
   vesicle or more. PETSC_MAX_REAL on grids coarser than all that were measured. */
static PetscReal GridError(AutoFluid fluid, PetscReal cells, PetscBool many) {
  for (int k = 0; k < GRIDS; k++)
    if (cells >= grids[k].cells * (1 - LEEWAY))
      return PetscMax(many ? grids[k].error : grids[k].few, fluid == AUTO_INERTIA ? grids[k].inertia : 0);
  return PETSC_MAX_REAL;
}

PetscReal SceneCellsFor(AutoFluid fluid, PetscReal error, PetscBool many) {
  int k = GRIDS - 1;
  while (k > (fluid == AUTO_INERTIA ? 0 : FINEST_QUIET) && GridError(fluid, grids[k].cells, many) > error) k--;
  return grids[k].cells;
}

/* Error over R0 that a wall adds when a membrane begins `gap` from the wall (all lengths in R0). */
static PetscReal WallError(AutoFluid fluid, PetscReal gap, PetscReal h) {
  const PetscReal last = walls[0].cells * h;
  if (gap > last * (1 + LEEWAY)) return fluid == AUTO_BOX_PART ? 0 : walls[0].plain * last * last / gap;
  for (int k = 0; k < WALLS; k++)
    if (gap >= walls[k].cells * h * (1 - 1e-9)) return (fluid == AUTO_BOX_PART ? walls[k].error : walls[k].plain) * gap;
  return PETSC_MAX_REAL;
}

/* TRUE if n has no prime factor above 5, so that Fourier transforms are fast. */
static PetscBool CellsAreSmooth(PetscInt n) {
  for (PetscInt prime = 2; prime <= 5; prime++)
    while (n % prime == 0) n /= prime;
  return n == 1;
}

/* The least whole numbers in proportion to the sides of a box; false: none up to the most cells across. */
static PetscBool BoxSides(const PetscReal box[4], PetscInt sides[2]) {
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
  if (!BoxSides(box, sides)) return PETSC_FALSE;
  const PetscReal wanted = PetscMax((box[1] - box[0]) / (h * sides[0]) * (1 - 1e-9),
                                    (PetscReal)LEAST_ACROSS / PetscMin(sides[0], sides[1]));
  if (wanted * PetscMax(sides[0], sides[1]) > SCENE_MOST_ACROSS) return PETSC_FALSE;
  PetscInt times = (PetscInt)PetscCeilReal(wanted);
  while (!CellsAreSmooth(times)) times++;
  for (int d = 0; d < 2; d++) cells[d] = sides[d] * times;
  return PetscMax(cells[0], cells[1]) <= SCENE_MOST_ACROSS;
}

/* Cells a R0 up to which one is taken for a wall: what has the box part was measured to 12, the rest of second order.
 */
static int GridFinest(AutoFluid fluid) {
  return fluid == AUTO_BOX_PART ? 16 : 24;
}

PetscBool SceneWallCells(AutoFluid fluid, const PetscReal box[4], PetscReal h, PetscReal R0, PetscReal gap,
                         PetscReal error, PetscInt cells[2]) {
  PetscReal next = h;
  while (SceneSquareCells(box, next, cells)) {
    const PetscReal now = (box[1] - box[0]) / cells[0];
    if (WallError(fluid, gap / R0, now / R0) <= error) return PETSC_TRUE;
    next = 0.999 * now;
    if (next < R0 / GridFinest(fluid)) break;
  }
  return PETSC_FALSE;
}

#define MARKERS 45

/* clang-format off */
/* Print the error of walls that are near to a vesicle, and the grid that would be enough. */
static PetscErrorCode AutoReportWall(Scene scene, AutoFluid fluid) {
  const PetscReal R0 = SceneSmallestRadius(scene), h = FluidSpecCellSize(&scene->fluid), wanted = scene->scheme.wanted;
  const Shape *shape = &scene->shape;
  const CurveRoom room = SceneRoom(scene);
  char what[PETVES_MAX_MESSAGE], leaves[PETVES_MAX_MESSAGE];
  PetscInt side, cells[2] = {0, 0};
  const PetscReal gap = CurveWallGap(shape->start[shape->vesicles], shape->X, &room, &side);
  const PetscReal error = gap < PETSC_MAX_REAL ? WallError(fluid, gap / R0, h / R0) : 0;
  const PetscBool finer = SceneWallCells(fluid, scene->fluid.box, h, R0, gap, wanted, cells);
  const SceneRule errors[] = {
    {error < PETSC_MAX_REAL, "up to %.2g of R0", {error}},
    {1, "more than was measured"}};
  const SceneRule rows[] = {
    {error <= wanted * (1 + 1e-9), "enough"},
    {scene->vesicles.packing > 0 && scene->vesicles.packing_gap == 0, "TOO NEAR for %g, give -vesicle_packing_gap", {wanted}},
    {finer, "TOO NEAR for %g, take -domain_cells %.0f,%.0f", {wanted, cells[0], cells[1]}},
    {1, "TOO NEAR for %g, and for any grid up to R0/h = %.0f", {wanted, GridFinest(fluid)}}};
  PetscFunctionBeginUser;
  if (error == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SCENE_TEXT(scene, errors, leaves));
  PetscCall(SCENE_TEXT(scene, rows, what));
  PetscCall(PetvesSay(scene->comm, "  nearest wall: %.3g cells, which leaves %s: %s\n", (double)(gap / h), leaves, what));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneReportGrid(Scene scene) {
  const PetscReal R0 = SceneSmallestRadius(scene), cells = R0 / FluidSpecCellSize(&scene->fluid), wanted = scene->scheme.wanted;
  const AutoFluid fluid = SceneAutoFluid(scene, scene->shape.longest / (2 * PETSC_PI));
  char what[PETVES_MAX_MESSAGE], leaves[PETVES_MAX_MESSAGE];
  PetscBool many = PETSC_TRUE;
  PetscInt finer[2] = {0, 0};
  for (PetscInt v = 0; v < scene->shape.vesicles; v++)
    if (scene->shape.start[v + 1] - scene->shape.start[v] < MARKERS) many = PETSC_FALSE;
  const PetscReal error = GridError(fluid, cells, many), enough = SceneCellsFor(fluid, wanted, many);
  const PetscBool some = SceneSquareCells(scene->fluid.box, R0 / enough, finer) && GridError(fluid, enough, many) <= wanted;
  const char *const or_markers = !many && GridError(fluid, cells, PETSC_TRUE) <= wanted ? ", or this grid and -vesicle_markers 45" : "";
  const SceneRule errors[] = {
    {error == PETSC_MAX_REAL, "coarser than any that was measured"},
    {1, "which leaves up to %.2g%s", {error}, {fluid == AUTO_INERTIA ? " with inertia" : ""}}};
  const SceneRule rows[] = {
    {error <= wanted * (1 + 1e-9), "enough"},
    {some, "TOO COARSE for %g, take R0/h = %g, -domain_cells %.0f,%.0f%s", {wanted, enough, finer[0], finer[1]}, {or_markers}},
    {1, "no grid up to R0/h = %g reached %g", {enough, wanted}}};
  PetscFunctionBeginUser;
  if (FluidSpecIsFree(&scene->fluid)) {
    PetscCall(PetvesSay(scene->comm, "  grid: none, unbounded fluid: enough\n"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SCENE_TEXT(scene, errors, leaves));
  PetscCall(SCENE_TEXT(scene, rows, what));
  PetscCall(PetvesSay(scene->comm, "  grid: R0/h = %.3g, %s: %s\n", (double)cells, leaves, what));
  PetscCall(AutoReportWall(scene, fluid));
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */
