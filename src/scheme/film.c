#include "scheme/film.h"
#include "curve/gap.h"
#include "scheme/parts.h"

/* Marker spacings below which a film's thickness is off by 1 % or will be as it thins (measured: from .3 to .65,
   docs/choosing.md), and those at which it is off by .1 to .4 %. */
#define THIN 0.6
#define RESOLVED 1.0

static PetscErrorCode Warn(Scheme s, PetscInt v, PetscInt w, PetscReal spacings) {
  static const char *const walls[] = {"the wall x_min", "the wall x_max", "the wall y_min", "the wall y_max"};
  const Membrane m = s->membrane;
  const PetscInt coarse = w < 0 || m->ds[v] >= m->ds[w] ? v : w;
  const PetscReal wanted = RESOLVED / spacings * LayoutCount(m->layout, coarse);
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
                       v + 1, other, (double)spacings, s->state.step, (double)s->state.t, THIN,
                       2 * (PetscInt)PetscCeilReal((PetscMin(wanted, 1e4) - 1) / 2) + 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0 looks and tells the others. */
PetscErrorCode SchemeWarnOfFilm(Scheme s) {
  const Layout l = s->membrane->layout;
  const Grid g = s->fluid->grid;
  Film film = {.spacings = THIN};
  PetscReal found[3];
  PetscFunctionBeginUser;
  if (!s->coupling->near || s->warnings.film) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LayoutGatherVec(l, s->state.X, s->work_all));
  if (!l->rank) {
    const PetscReal box[4] = {g->lo[0], g->hi[0], g->lo[1], g->hi[1]};
    PetscReal period[2];
    PetscBool wall[2];
    for (int dir = 0; dir < 2; dir++) {
      wall[dir] = g->wall[dir] && !g->free ? PETSC_TRUE : PETSC_FALSE;
      period[dir] = g->wall[dir] ? 0 : g->hi[dir] - g->lo[dir];
    }
    PetscCall(CurvesFilm(l->bodies, l->start, s->work_all, s->membrane->ds, period, box, wall, THIN, &film));
  }
  found[0] = film.spacings;
  found[1] = film.pair[0];
  found[2] = film.pair[1];
  PetscCallMPI(MPI_Bcast(found, 3, MPIU_REAL, 0, l->comm));
  s->warnings.film = found[0] < THIN ? PETSC_TRUE : PETSC_FALSE;
  if (s->warnings.film) PetscCall(Warn(s, (PetscInt)found[1], (PetscInt)found[2], found[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
