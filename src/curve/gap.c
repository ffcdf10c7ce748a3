#include "curve/gap.h"
#include "curve/crossing.h"

typedef struct {
  const PetscInt *start;
  const PetscInt *curve; /* of each point */
  const PetscReal *X, *ds;
  Film *film;
} FilmSearch;

/* Distance of a point from the two edges beside point k, which is at `at` from it. */
static PetscReal FromEdges(const FilmSearch *s, PetscInt k, const PetscReal at[2]) {
  const PetscInt v = s->curve[k], first = s->start[v], n = s->start[v + 1] - first;
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt side = 1; side < n; side += n - 2) {
    const PetscReal *here = s->X + 2 * k, *other = s->X + 2 * (first + (k - first + side) % n);
    const PetscReal e[2] = {other[0] - here[0], other[1] - here[1]}, square = e[0] * e[0] + e[1] * e[1];
    const PetscReal t = PetscMax(0, PetscMin(1, -(at[0] * e[0] + at[1] * e[1]) / square));
    least = PetscMin(least, PetscHypotReal(at[0] + t * e[0], at[1] + t * e[1]));
  }
  return least;
}

static void Take(Film *film, PetscReal gap, PetscReal ds, PetscInt v, PetscInt w) {
  if (gap >= film->spacings * ds) return;
  *film = (Film){.spacings = gap / ds, .gap = gap, .pair = {v, w}};
}

/* Of two points that are near, on two curves or on one and its image, the distances to the other's edges. */
static PetscBool Look(void *context, PetscInt i, PetscInt j, const PetscReal d[2]) {
  const FilmSearch *s = (FilmSearch *)context;
  const PetscInt v = s->curve[i], w = s->curve[j];
  const PetscReal back[2] = {-d[0], -d[1]}, ds = PetscMax(s->ds[v], s->ds[w]);
  const PetscReal shift = PetscHypotReal(s->X[2 * i] + d[0] - s->X[2 * j], s->X[2 * i + 1] + d[1] - s->X[2 * j + 1]);
  if (v != w || shift > ds) /* else parts of one curve */
    Take(s->film, PetscMin(FromEdges(s, j, d), FromEdges(s, i, back)), ds, v, w);
  return PETSC_FALSE;
}

PetscErrorCode CurvesFilm(PetscInt curves, const PetscInt start[], const PetscReal X[], const PetscReal ds[],
                          const PetscReal period[2], const PetscReal box[4], const PetscBool wall[2], PetscReal most,
                          Film *film) {
  PetscInt *curve;
  PetscReal reach = 0;
  PetscFunctionBeginUser;
  *film = (Film){.spacings = most};
  PetscCall(PetscMalloc1(start[curves], &curve));
  for (PetscInt v = 0; v < curves; v++) {
    reach = PetscMax(reach, (most + 0.5) * ds[v]); /* of points of curves that are `most` apart */
    for (PetscInt k = start[v]; k < start[v + 1]; k++) curve[k] = v;
  }
  FilmSearch search = {.start = start, .curve = curve, .X = X, .ds = ds, .film = film};
  PetscCall(PairsWithin(start[curves], X, period, reach, Look, &search));
  for (PetscInt k = 0; k < start[curves]; k++)
    for (int side = 0; side < 4; side++)
      if (wall[side / 2]) Take(film, PetscAbsReal(X[2 * k + side / 2] - box[side]), ds[curve[k]], curve[k], -1 - side);
  PetscCall(PetscFree(curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}
