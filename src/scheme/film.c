#include "scheme/film.h"
#include "curve/crossing.h"
#include "scheme/parts.h"

/* Marker spacings below which a film's thickness is off by 1 % or will be as it thins (measured: from .3 to .65,
   docs/choosing.md), and those at which it is off by .1 to .4 %. */
#define THIN 0.6
#define RESOLVED 1.0

typedef struct {
  Scheme scheme;
  const PetscScalar *X; /* [2M] of all vesicles */
  PetscReal least;      /* gap over the larger of both marker spacings */
  PetscInt pair[2];     /* of vesicles; the second one is -1 - 2 direction - side for a wall */
} FilmSearch;

/* Distance of a point from the two edges beside marker k, which is at `at` from it. */
static PetscReal FromEdges(Layout l, const PetscScalar X[], PetscInt k, const PetscReal at[2]) {
  const PetscInt v = LayoutBody(l, k), first = l->start[v], n = LayoutCount(l, v);
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt side = 1; side < n; side += n - 2) {
    const PetscScalar *other = X + 2 * (first + (k - first + side) % n);
    const PetscReal e[2] = {other[0] - X[2 * k], other[1] - X[2 * k + 1]}, square = e[0] * e[0] + e[1] * e[1];
    const PetscReal along = -(at[0] * e[0] + at[1] * e[1]) / square, t = PetscMax(0, PetscMin(1, along));
    least = PetscMin(least, PetscHypotReal(at[0] + t * e[0], at[1] + t * e[1]));
  }
  return least;
}

/* Of two markers that are near, on two vesicles or on one and its image, the distances to the other's edges. */
static PetscBool Look(void *context, PetscInt i, PetscInt j, const PetscReal d[2]) {
  FilmSearch *f = (FilmSearch *)context;
  const Layout l = f->scheme->membrane->layout;
  const PetscInt v = LayoutBody(l, i), w = LayoutBody(l, j);
  const PetscReal ds = PetscMax(f->scheme->membrane->ds[v], f->scheme->membrane->ds[w]), back[2] = {-d[0], -d[1]};
  const PetscReal shift = PetscHypotReal(f->X[2 * i] + d[0] - f->X[2 * j], f->X[2 * i + 1] + d[1] - f->X[2 * j + 1]);
  if (v == w && shift < ds) return PETSC_FALSE; /* parts of one vesicle: SchemeCheckContact */
  const PetscReal gap = PetscMin(FromEdges(l, f->X, j, d), FromEdges(l, f->X, i, back)) / ds;
  if (gap < f->least) {
    f->least = gap;
    f->pair[0] = v;
    f->pair[1] = w;
  }
  return PETSC_FALSE;
}

static void LookAtWalls(FilmSearch *f) {
  const Grid g = f->scheme->fluid->grid;
  const Layout l = f->scheme->membrane->layout;
  for (PetscInt v = 0; v < l->bodies; v++)
    for (PetscInt k = l->start[v]; k < l->start[v + 1]; k++)
      for (int dir = 0; dir < 2; dir++)
        for (int side = 0; side < 2 && g->wall[dir]; side++) {
          const PetscReal gap = PetscAbsReal(f->X[2 * k + dir] - (side ? g->hi : g->lo)[dir]) /
                                f->scheme->membrane->ds[v];
          if (gap >= f->least) continue;
          f->least = gap;
          f->pair[0] = v;
          f->pair[1] = -1 - 2 * dir - side;
        }
}

/* The thinnest film. Curves that are THIN spacings apart have markers within sqrt(THIN^2 + 1/4) of one another. */
static PetscErrorCode Find(FilmSearch *f) {
  const Membrane m = f->scheme->membrane;
  const Grid g = f->scheme->fluid->grid;
  PetscReal period[2], reach = 0;
  PetscFunctionBeginUser;
  for (int dir = 0; dir < 2; dir++) period[dir] = g->wall[dir] ? 0 : g->hi[dir] - g->lo[dir];
  for (PetscInt v = 0; v < m->layout->bodies; v++) reach = PetscMax(reach, (THIN + 0.5) * m->ds[v]);
  PetscCall(PairsWithin(m->layout->M, f->X, period, reach, Look, f));
  if (!g->free) LookAtWalls(f);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Warn(Scheme s, PetscInt v, PetscInt w, PetscReal gap) {
  static const char *const walls[] = {"the wall x_min", "the wall x_max", "the wall y_min", "the wall y_max"};
  const Membrane m = s->membrane;
  const PetscInt coarse = w < 0 || m->ds[v] >= m->ds[w] ? v : w;
  const PetscReal wanted = RESOLVED / gap * LayoutCount(m->layout, coarse);
  char other[64];
  PetscFunctionBeginUser;
  if (w < 0)
    PetscCall(PetscStrncpy(other, walls[-1 - w], sizeof(other)));
  else if (v == w)
    PetscCall(PetscStrncpy(other, "its periodic image", sizeof(other)));
  else
    PetscCall(PetscSNPrintf(other, sizeof(other), "vesicle %" PetscInt_FMT, w + 1));
  PetscCall(SchemeWarn(s,
                       "the film between vesicle %" PetscInt_FMT " and %s is %.2g marker spacings thick after "
                       "step %" PetscInt_FMT ", time %g; below %g its thickness is off by 1 %% or more: try "
                       "-vesicle_markers %" PetscInt_FMT,
                       v + 1, other, (double)gap, s->state.step, (double)s->state.t, THIN,
                       2 * (PetscInt)PetscCeilReal((PetscMin(wanted, 1e4) - 1) / 2) + 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0 looks and tells the others. */
PetscErrorCode SchemeWarnOfFilm(Scheme s) {
  const Layout l = s->membrane->layout;
  FilmSearch f = {.scheme = s, .X = s->work_all, .least = THIN};
  PetscReal found[3];
  PetscFunctionBeginUser;
  if (!s->coupling->near || s->warnings.film) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LayoutGatherVec(l, s->state.X, s->work_all));
  if (!l->rank) PetscCall(Find(&f));
  found[0] = f.least;
  found[1] = f.pair[0];
  found[2] = f.pair[1];
  PetscCallMPI(MPI_Bcast(found, 3, MPIU_REAL, 0, l->comm));
  s->warnings.film = found[0] < THIN ? PETSC_TRUE : PETSC_FALSE;
  if (s->warnings.film) PetscCall(Warn(s, (PetscInt)found[1], (PetscInt)found[2], found[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
