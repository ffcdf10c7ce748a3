#include "scheme/films.h"
#include "base/agree.h"
#include "curve/contacts.h"
#include "curve/crossing.h"
#include "scheme/stepcommon.h"

#define THIN 0.5 /* edges below which a film that loses much is drained by the step's error */

/* Films thinner than SCENE_FILM marker spacings have a thickness that is off by 1 %, now or as they thin (measured:
   from 0.3 to 0.65 spacings, docs/settings.md). At RESOLVED spacings the thickness is off by 0.1 to 0.4 %. */
#define RESOLVED 1.0

#define FAR 4 /* longest mean edges up to which the distance of each vesicle is measured */

/* The film that has lost most in a step. */
typedef struct {
  PetscReal loss; /* lost part of its thickness, over what is allowed */
  CurveGap before, after;
} Drained;

static PetscReal Thin(Scheme s) {
  PetscReal ds = 0;
  if (!s->coupling->mobility->near) return s->fluid->grid->h;
  for (PetscInt v = 0; v < s->coupling->bodies->layout->bodies; v++) ds = PetscMax(ds, s->coupling->bodies->ds[v]);
  return THIN * ds;
}

/* The pairs of curves that a rank looks at: those whose first vesicle it owns. */
typedef struct {
  CurveRoom room;
  PetscInt own[2];
  CurveSet set;
} View;

/* Fill in a view of the curves X[2(M + W)]. The set points into the view, which must not be moved in memory. */
static void SeeCurves(Scheme s, const PetscReal X[], View *view) {
  const Bodies b = s->coupling->bodies;
  view->room = SceneRoom(s->scene);
  view->own[0] = s->membrane->layout->own;
  view->own[1] = s->membrane->layout->end;
  view->set = (CurveSet){b->layout->bodies, b->vesicles,       b->layout->start, b->kind, X,
                         view->room.period, SchemeIsSmooth(s), view->own};
}

/* The films of own vesicles thinner than reach at the curves X[2(M + W)], in the order of the pairs, then those at
   walls, whose first curve is the number of bodies. The caller frees them. */
static PetscErrorCode FindFilms(Scheme s, const PetscScalar X[], PetscReal reach, PetscInt *n, CurveGap **films) {
  const Layout l = s->coupling->bodies->layout;
  const PetscInt vesicles = s->coupling->bodies->vesicles;
  CurveGap *between;
  PetscInt count, side;
  View view;
  PetscFunctionBeginUser;
  SeeCurves(s, X, &view);
  PetscCall(CurveGaps(&view.set, reach, &count, &between));
  PetscCall(PetscMalloc1(count + vesicles, films));
  PetscCall(PetscArraycpy(*films, between, count));
  PetscCall(PetscFree(between));
  for (PetscInt v = view.own[0]; v < view.own[1]; v++) {
    const PetscReal gap = CurveWallGap(LayoutCount(l, v), X + 2 * l->start[v], &view.room, &side);
    if (gap < reach) (*films)[count++] = (CurveGap){.curve = {l->bodies, v}, .distance = gap};
  }
  *n = count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Compare the films that are thin now with the films before the step. A film that is not among those before was thicker
   than reach. */
static void CompareFilms(PetscInt n, const CurveGap now[], PetscInt m, const CurveGap before[], PetscReal reach,
                         PetscReal limit, Drained *worst) {
  for (PetscInt k = 0, j = 0; k < n; k++) {
    CurveGap old = {.curve = {now[k].curve[0], now[k].curve[1]}, .distance = reach};
    while (j < m && (before[j].curve[0] < old.curve[0] ||
                     (before[j].curve[0] == old.curve[0] && before[j].curve[1] < old.curve[1])))
      j++;
    if (j < m && before[j].curve[0] == old.curve[0] && before[j].curve[1] == old.curve[1]) old = before[j];
    if (old.distance <= 0) continue; /* the two crossed before this step */
    const PetscReal loss = (1 - now[k].distance / old.distance) / limit;
    if (loss > worst->loss) *worst = (Drained){loss, old, now[k]};
  }
}

/* The film that has lost most in the step to an instant, of all ranks. */
static PetscErrorCode FindDrained(Scheme s, Instant at, PetscReal limit, Drained *worst) {
  const Layout l = s->membrane->layout;
  const PetscReal thin = Thin(s), thick = thin / PetscMax(1 - limit, 0.25);
  CurveGap *now, *before = NULL;
  PetscMPIInt whose;
  PetscInt n, m;
  PetscBool any;
  PetscFunctionBeginUser;
  *worst = (Drained){0};
  PetscCall(SchemeCurves(s, at, s->state.X));
  PetscCall(FindFilms(s, s->work_all, thin, &n, &now));
  PetscCall(AgreeFlag(l->comm, n ? PETSC_TRUE : PETSC_FALSE, &any));
  if (any) PetscCall(SchemeCurves(s, StateInstant(&s->before.state), s->before.state.X));
  if (n) {
    PetscCall(FindFilms(s, s->work_all, thick, &m, &before));
    CompareFilms(n, now, m, before, thick, limit, worst);
  }
  PetscCall(PetscFree(now));
  PetscCall(PetscFree(before));
  PetscReal loss = worst->loss;
  PetscCall(AgreeLargest(l->comm, &loss, &whose));
  PetscCallMPI(MPI_Bcast(worst, sizeof(*worst), MPI_BYTE, whose, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FilmsCross(Scheme s, const PetscScalar X[], PetscInt pair[2]) {
  CurveGap *gaps;
  PetscInt n;
  View view;
  PetscFunctionBeginUser;
  SeeCurves(s, X, &view);
  PetscCall(CurvesCross(&view.set, pair));
  if (pair[0] >= 0 || !view.set.smooth) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CurveGaps(&view.set, 0, &n, &gaps));
  if (n) PetscCall(PetscArraycpy(pair, gaps[0].curve, 2));
  PetscCall(PetscFree(gaps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FilmsLoss(Scheme s, Instant at, PetscReal *loss) {
  PetscInt pair[2] = {-1, -1};
  PetscBool cross;
  PetscFunctionBeginUser;
  *loss = 0;
  if (s->scene->limits.gap_loss > 0) {
    Drained worst;
    PetscCall(FindDrained(s, at, s->scene->limits.gap_loss, &worst));
    *loss = worst.loss;
  }
  if (!s->scene->limits.crossing) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SchemeCurves(s, at, s->state.X));
  PetscCall(FilmsCross(s, s->work_all, pair));
  PetscCall(AgreeFlag(s->membrane->layout->comm, pair[0] >= 0 ? PETSC_TRUE : PETSC_FALSE, &cross));
  if (cross) *loss = PetscMax(*loss, 2);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FilmsCheck(Scheme s) {
  char who[64];
  Drained worst;
  PetscFunctionBeginUser;
  if (!(s->scene->limits.gap_loss > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindDrained(s, StateInstant(&s->state), s->scene->limits.gap_loss, &worst));
  if (worst.loss <= 1) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt v = worst.after.curve[0], w = worst.after.curve[1];
  if (v == s->coupling->bodies->layout->bodies)
    PetscCall(PetscSNPrintf(who, sizeof(who), "vesicle %" PetscInt_FMT " and a wall", w + 1));
  else
    PetscCall(SchemeNamePair(s, v, w, "vesicle %" PetscInt_FMT " and its image", sizeof(who), who));
  PetscCall(PetscSNPrintf(s->report.failure, sizeof(s->report.failure),
                          "the film between %s went from %s%.3g to %.3g in one step, which is more than "
                          "-limit_gap_loss %g allows",
                          who, worst.before.distance < Thin(s) ? "" : "more than ", (double)worst.before.distance,
                          (double)worst.after.distance, (double)s->scene->limits.gap_loss));
  PetscCall(SchemeAdvise(s, "a smaller -time_step, -time_adapt error or -contact_repulsion"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the films that this rank looks at and that are thinner than FAR edges: each[v], the thickness of vesicle v's
   thinnest film, and the thinnest film that is not at a wall. PETSC_MAX_REAL where there is none. */
static PetscErrorCode ThinnestOfEach(Scheme s, const PetscScalar X[], PetscReal each[], CurveGap *thinnest) {
  const Membrane m = s->membrane;
  const PetscInt vesicles = m->layout->bodies, bodies = s->coupling->bodies->layout->bodies;
  PetscReal edge = 0;
  CurveGap *films;
  PetscInt n;
  PetscFunctionBeginUser;
  *thinnest = (CurveGap){.distance = PETSC_MAX_REAL};
  for (PetscInt v = 0; v < vesicles; v++) {
    each[v] = PETSC_MAX_REAL;
    edge = PetscMax(edge, m->ds[v]);
  }
  PetscCall(FindFilms(s, X, FAR * edge, &n, &films));
  for (PetscInt k = 0; k < n; k++) {
    if (films[k].curve[0] < bodies && films[k].distance < thinnest->distance) *thinnest = films[k];
    for (int side = 0; side < 2; side++) {
      const PetscInt v = films[k].curve[side];
      if (v < vesicles) each[v] = PetscMin(each[v], films[k].distance);
    }
  }
  PetscCall(PetscFree(films));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The least distance between two vesicles or a vesicle and an obstacle: that of the two curves of the thinnest film,
   measured by their owner, or, where there is no film, that of all curves, measured by rank 0. */
static PetscErrorCode LeastGap(Scheme s, const PetscScalar X[], const CurveGap *thinnest, PetscReal *least) {
  const Layout l = s->membrane->layout;
  const PetscInt *pair = thinnest->curve;
  PetscReal nearness = -thinnest->distance;
  PetscMPIInt whose;
  CurveFine two;
  View view;
  PetscFunctionBeginUser;
  SeeCurves(s, X, &view);
  PetscCall(AgreeLargest(l->comm, &nearness, &whose));
  if (nearness == -PETSC_MAX_REAL && !l->rank) {
    view.set.part = NULL;
    PetscCall(CurveLeastGap(&view.set, least));
  } else if (nearness > -PETSC_MAX_REAL && l->rank == whose) {
    PetscCall(CurveFineCreate(&view.set, pair[0] == pair[1] ? 1 : 2, pair, 1, &two));
    two.set.moving = 1;
    two.set.smooth = view.set.smooth;
    PetscCall(CurveLeastGap(&two.set, least));
    PetscCall(CurveFineDestroy(&two));
  }
  PetscCallMPI(MPI_Bcast(least, 1, MPIU_REAL, whose, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FilmsGaps(Scheme s, PetscReal *least, PetscReal each[]) {
  const Layout l = s->membrane->layout;
  const CurveRoom room = SceneRoom(s->scene);
  PetscMPIInt vesicles;
  CurveGap thinnest;
  PetscInt side;
  PetscFunctionBeginUser;
  *least = NAN;
  if (!l->bodies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMPIIntCast(l->bodies, &vesicles));
  PetscCall(SchemeCurves(s, StateInstant(&s->state), s->state.X));
  PetscCall(ThinnestOfEach(s, s->work_all, each, &thinnest));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, each, vesicles, MPIU_REAL, MPI_MIN, l->comm));
  for (PetscInt v = 0; v < l->bodies; v++)
    if (each[v] == PETSC_MAX_REAL) each[v] = NAN;
  PetscCall(LeastGap(s, s->work_all, &thinnest, least));
  const PetscReal wall = CurveWallGap(l->M, s->work_all, &room, &side);
  if (wall < PETSC_MAX_REAL && !(*least < wall)) *least = wall;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The option that makes the markers of a body `times` closer. */
static PetscErrorCode Remedy(Scheme s, PetscInt body, PetscReal times, size_t room, char text[]) {
  const Bodies b = s->coupling->bodies;
  const PetscReal wanted = times * LayoutCount(b->layout, body);
  PetscFunctionBeginUser;
  if (body < b->vesicles)
    PetscCall(PetscSNPrintf(text, room, "-vesicle_markers %" PetscInt_FMT,
                            2 * (PetscInt)PetscCeilReal((PetscMin(wanted, 1e4) - 1) / 2) + 1));
  else
    PetscCall(PetscSNPrintf(text, room, "-obstacle_spacing %.2g",
                            (double)PetscMax(NEAR_LEAST_SPACING, s->scene->obstacles.spacing / times)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WarnOfFilm(Scheme s, const CurveFilm *film) {
  static const char *const walls[] = {"the wall x_min", "the wall x_max", "the wall y_min", "the wall y_max"};
  const Bodies b = s->coupling->bodies;
  const PetscInt v = film->pair[0], w = film->pair[1], coarse = w < 0 || b->ds[v] >= b->ds[w] ? v : w;
  char other[64], remedy[64];
  PetscFunctionBeginUser;
  if (w < 0)
    PetscCall(PetscStrncpy(other, walls[-1 - w], sizeof(other)));
  else if (v == w)
    PetscCall(PetscStrncpy(other, "its periodic image", sizeof(other)));
  else
    PetscCall(PetscSNPrintf(other, sizeof(other), "%s %" PetscInt_FMT, w < b->vesicles ? "vesicle" : "obstacle",
                            (w < b->vesicles ? w : w - b->vesicles) + 1));
  PetscCall(Remedy(s, coarse, RESOLVED / film->spacings, sizeof(remedy), remedy));
  PetscCall(SchemeWarn(s,
                       "the film between vesicle %" PetscInt_FMT " and %s is %.2g marker spacings thick after "
                       "step %" PetscInt_FMT ", time %g; below %g its thickness is off by 1 %% or more: try %s",
                       v + 1, other, (double)film->spacings, s->state.step, (double)s->state.t, SCENE_FILM, remedy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FilmsWarn(Scheme s) {
  const Layout l = s->membrane->layout;
  PetscMPIInt whose;
  CurveFilm film;
  View view;
  PetscFunctionBeginUser;
  if (!s->coupling->mobility->near || s->warnings.film) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SchemeCurves(s, StateInstant(&s->state), s->state.X));
  SeeCurves(s, s->work_all, &view);
  PetscCall(CurveThinnestFilm(&view.set, s->coupling->bodies->ds, &view.room, SCENE_FILM, &film));
  PetscReal thinness = -film.spacings;
  PetscCall(AgreeLargest(l->comm, &thinness, &whose));
  PetscCallMPI(MPI_Bcast(&film, sizeof(film), MPI_BYTE, whose, l->comm));
  s->warnings.film = film.spacings < SCENE_FILM ? PETSC_TRUE : PETSC_FALSE;
  if (s->warnings.film) PetscCall(WarnOfFilm(s, &film));
  PetscFunctionReturn(PETSC_SUCCESS);
}
