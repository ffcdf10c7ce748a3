#include "scene/autostart.h"
#include "curve/contacts.h"
#include "numerics/spectral.h"
#include "scene/properties.h"
#include "scene/vesicles.h"

#define ALIGNED 1e-6 /* of the strain: none, but for rounding */
#define SQUEEZED 3   /* nu R0^3/c_b times the rate of compression from which on steps are those of wrinkles */
#define MOST_FINER 3 /* times the default's markers */
#define WIDE 2       /* spacings: wider films are resolved */
#define GROWTH 1.2   /* of the markers from one try to the next */

/* A first shape's tail (SpectralTail beyond two thirds of the modes) for an error of 1e-3, and the largest: .31 left
   7e-4 of R0 in a pair pressed together. */
#define TAIL 0.15
#define MOST_TAIL 0.3

/* What films leave of the thickness, by spacings (docs/settings.md, Films). */
static const struct {
  PetscReal spacings, error;
} films[] = {{WIDE, 1e-5}, {1.5, 2e-4}, {1, 4e-3}, {.7, 1e-2}, {.5, 4e-2}, {.3, 1}};

/* Rate at which the flow shortens vesicle v along its length; 0 if it does not, or is not known (1/time). */
static PetscReal Compression(Scene scene, PetscInt v) {
  const Shape *s = &scene->shape;
  const PetscInt n = s->start[v + 1] - s->start[v];
  PetscReal mean[2] = {0, 0}, xx = 0, yy = 0, xy = 0, G[2][2];
  if (scene->flow.type == FLOW_CUSTOM) return 0;
  for (PetscInt k = s->start[v]; k < s->start[v + 1]; k++)
    for (int c = 0; c < 2; c++) mean[c] += s->X[2 * k + c] / n;
  for (PetscInt k = s->start[v]; k < s->start[v + 1]; k++) {
    const PetscReal x = s->X[2 * k] - mean[0], y = s->X[2 * k + 1] - mean[1];
    xx += x * x;
    yy += y * y;
    xy += x * y;
  }
  const PetscReal angle = 0.5 * PetscAtan2Real(2 * xy, xx - yy), c = PetscCosReal(angle), d = PetscSinReal(angle);
  FlowGradient(&scene->flow, 0, mean[0], mean[1], G);
  const PetscReal rate = -(G[0][0] * c * c + (G[0][1] + G[1][0]) * c * d + G[1][1] * d * d);
  return rate > ALIGNED * (PetscAbsReal(G[0][0]) + PetscAbsReal(G[0][1] + G[1][0])) ? rate : 0;
}

PetscReal SceneSqueeze(Scene scene) {
  PetscReal largest = 0;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++)
    if (scene->membrane.each[v] > 0) largest = PetscMax(largest, Compression(scene, v) * SceneMembraneTime(scene, v));
  return largest > SQUEEZED ? largest : 0;
}

/* What a film so many spacings thick leaves of its thickness. */
static PetscReal FilmError(PetscReal spacings) {
  const int n = (int)(sizeof(films) / sizeof(films[0]));
  int k = 1;
  while (k < n - 1 && spacings < films[k].spacings) k++;
  const PetscReal part = (spacings - films[k].spacings) / (films[k - 1].spacings - films[k].spacings);
  return PetscExpReal((1 - part) * PetscLogReal(films[k].error) + part * PetscLogReal(films[k - 1].error));
}

/* The thinnest film of the start, in marker spacings (2: none is thinner), and the error that it leaves, of its
   thickness over R0. */
static PetscErrorCode ThinnestFilm(Scene scene, PetscReal *spacings, PetscReal *error) {
  const Shape *s = &scene->shape;
  const CurveRoom room = SceneRoom(scene);
  const PetscBool smooth = scene->membrane.derivative == DERIVATIVE_SPECTRAL ? PETSC_TRUE : PETSC_FALSE;
  CurveFilm film;
  PetscReal *ds;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->vesicles, &ds));
  for (PetscInt v = 0; v < s->vesicles; v++) ds[v] = 2 * PETSC_PI * ShapeRadius(s, v) / (s->start[v + 1] - s->start[v]);
  const CurveSet set = {s->vesicles, s->vesicles, s->start, NULL, s->X, room.period, smooth};
  PetscCall(CurveThinnestFilm(&set, ds, &room, WIDE, &film));
  PetscCall(PetscFree(ds));
  *spacings = film.spacings;
  *error = film.spacings < WIDE ? FilmError(film.spacings) * film.thickness / SceneSmallestRadius(scene) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneReportFilm(Scene scene) {
  PetscReal spacings, error;
  PetscFunctionBeginUser;
  PetscCall(ThinnestFilm(scene, &spacings, &error));
  if (error > 0)
    PetscCall(PetvesSay(scene->comm, "  thinnest film: %.2g marker spacings, which leaves up to %.1g of R0: %s\n",
                        (double)spacings, (double)error,
                        error <= scene->scheme.wanted ? "enough" : "TOO THIN, take more -vesicle_markers"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the markers resolve the shapes and the films of the start. */
static PetscErrorCode Resolved(Scene scene, PetscBool *resolved) {
  const Shape *s = &scene->shape;
  const PetscReal tail = PetscMin(MOST_TAIL, TAIL * PetscSqrtReal(scene->scheme.wanted / 1e-3));
  PetscReal spacings, error;
  PetscFunctionBeginUser;
  PetscCall(ThinnestFilm(scene, &spacings, &error));
  *resolved = error < 0.5 * scene->scheme.wanted ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt v = 0; v < s->vesicles && *resolved; v++) {
    Spectral spectral;
    PetscCall(SpectralCreate(s->start[v + 1] - s->start[v], &spectral));
    if (SpectralTail(spectral, 2. / 3, s->X + 2 * s->start[v]) > tail) *resolved = PETSC_FALSE;
    PetscCall(SpectralDestroy(&spectral));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneChooseMarkers(Draft scene) {
  const PetscReal h = FluidSpecCellSize(&scene->fluid);
  PetscBool resolved = PETSC_FALSE;
  PetscInt n = 0, most = PETSC_MAX_INT;
  PetscFunctionBeginUser;
  if (scene->scheme.wanted == 0 || !scene->shape.vesicles || SceneGiven(scene, "-vesicle_markers") ||
      scene->vesicles.spacing > 0 || scene->coupling.near_field != NEAR_EXACT ||
      scene->membrane.derivative != DERIVATIVE_SPECTRAL)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) {
    const PetscReal length = 2 * PETSC_PI * ShapeRadius(&scene->shape, v);
    n = PetscMax(n, scene->shape.start[v + 1] - scene->shape.start[v]);
    most = PetscMin(most, (PetscInt)(length / (NEAR_LEAST_SPACING * h)));
  }
  most = PetscMin(most, MOST_FINER * n);
  const PetscInt least = SceneSqueeze(scene) > 0 ? PetscMin(most, 3 * n / 2) - 1 : 0;
  for (;;) {
    PetscCall(Resolved(scene, &resolved));
    if ((resolved && n >= least) || n >= most - 1) break;
    n = PetscMin((PetscInt)(GROWTH * n), most);
    n -= 1 - n % 2;
    scene->vesicles.markers = n;
    PetscCall(SceneDropShape(scene));
    PetscCall(SceneMakeShape(scene));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
