/* The initial markers of a scene: equal edges on an ellipse or on a curve from a file. */
#include "scene/scene.h"

/* Number of markers of a curve: the even number nearest to length/(spacing h), or the user's own. */
static PetscErrorCode MarkerCount(Scene scene, PetscReal length, PetscReal spacing, PetscReal least, PetscInt *M) {
  const PetscReal h = SceneCellSize(scene);
  PetscReal s;
  PetscFunctionBeginUser;
  if (scene->spacing > 0) spacing = scene->spacing;
  *M = scene->markers ? scene->markers : 2 * (PetscInt)PetscFloorReal(length / (2 * spacing * h) + 0.5);
  PetscCheck(*M >= 8, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_spacing %g: %" PetscInt_FMT
             " markers on a membrane of length %g at h = %g; allowed: at least 8, so a finer -domain_cells",
             (double)spacing, *M, (double)length, (double)h);
  s = length / (*M * h);
  /* rounding to an even number of markers may go one marker below the limit that the user asked for */
  PetscCheck(scene->allow_close_markers || (scene->markers ? s : spacing) >= least * (1 - 1e-12), scene->comm,
             PETSC_ERR_USER_INPUT,
             "-vesicle_%s %g: markers %g h apart with -delta_type %s; allowed: at least %g h "
             "(-vesicle_allow_close_markers goes on)",
             scene->markers ? "markers" : "spacing", scene->markers ? (double)scene->markers : (double)spacing,
             (double)s, scene->delta, (double)least);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ShapeCreate(Scene scene, PetscReal default_spacing, PetscReal least_spacing, Shape *shape) {
  Curve curve = {0};
  PetscInt M;
  const PetscReal turn = scene->angle.v[0] * PETSC_PI / 180, c = PetscCosReal(turn), s = PetscSinReal(turn);
  PetscFunctionBeginUser;
  shape->vesicles = scene->shape == SHAPE_NONE ? 0 : 1;
  PetscCall(PetscCalloc1(shape->vesicles + 1, &shape->start));
  shape->X = NULL;
  if (!shape->vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  if (scene->shape == SHAPE_FILE)
    PetscCall(CurveFromFile(scene->comm, scene->file, &curve));
  else if (SceneGiven(scene, "-vesicle_area") || SceneGiven(scene, "-vesicle_reduced_area"))
    PetscCall(EllipseAxes(scene->area, scene->reduced_area, curve.axes));
  else
    PetscCall(PetscArraycpy(curve.axes, scene->axes.v, 2));
  PetscCall(MarkerCount(scene, CurveLength(&curve), default_spacing, least_spacing, &M));
  shape->start[1] = M;
  PetscCall(PetscMalloc1(2 * M, &shape->X));
  PetscCall(CurveEqualChords(&curve, M, shape->X));
  PetscCall(CurveDestroy(&curve));
  for (PetscInt k = 0; k < M; k++) {
    const PetscReal x = shape->X[2 * k], y = shape->X[2 * k + 1];
    shape->X[2 * k] = scene->center.v[0] + c * x - s * y;
    shape->X[2 * k + 1] = scene->center.v[1] + s * x + c * y;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ShapeDestroy(Shape *shape) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(shape->start));
  PetscCall(PetscFree(shape->X));
  shape->vesicles = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
