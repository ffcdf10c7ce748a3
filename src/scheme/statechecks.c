#include "scheme/statechecks.h"
#include "base/agree.h"
#include "curve/crossing.h"
#include "scene/auto.h"
#include "scheme/films.h"

/* A shape's spectral tail is the part of its bending that is in the last third of its modes. With a tail above 0.15
   (SceneRoughTail) the steady angle or frequency is off by 0.05 % or more, with a tail below SMOOTH by less than 0.001
   % (reduced areas of 0.35 to 0.9, chi of 1 to 30, 17 to 91 markers, compared with 91 markers). */
#define SMOOTH 0.03
/* Above this |X - X*|/R0 of a fixed step, markers are off by 1 % of R0 or more (docs/time.md). It is looked at from
   step FIRST_JUDGED on: in the first steps the high modes of an ellipse die out, whatever the step. What a warning says
   of a shape before that may be true of the start only. */
#define COARSE_STEP 0.02
#define FIRST_JUDGED 4
#define CORNER                                                                                                         \
  3 /* cells from each of two walls that meet, below which the near field does not hold without the box part */

#define CONTACT 2 /* cells between membranes below which a warning is due */
#define CLOSE_PARTS                                                                                                    \
  1.5 /* edges between parts of one membrane below which a warning is due, with the exact near field */

static PetscErrorCode CheckFinite(Scheme s) {
  static const char *const names[] = {"velocity", "pressure", "tension", "marker velocity"};
  const Vec all[] = {NULL, s->state.p, s->state.sigma, s->state.U};
  PetscFunctionBeginUser;
  for (int k = 0; k < (CouplingHasMembrane(s->coupling) ? 4 : 2); k++) {
    PetscBool finite = PetscIsInfOrNanReal(s->report.div_max) ? PETSC_FALSE : PETSC_TRUE; /* the velocity */
    if (k == 1 && s->state.fields != FIELDS_MADE)
      continue; /* the pressure follows from the forces, which are checked by div_max */
    if (k) PetscCall(AgreeFinite(all[k], &finite));
    if (finite) continue;
    PetscCall(PetscSNPrintf(s->report.failure, sizeof(s->report.failure), "the %s is not finite", names[k]));
    PetscCall(SchemeAdvise(s, "a smaller -time_step, or tighter solver tolerances"));
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Check edge ratio, area and length of one own vesicle with markers X[2n]. */
static PetscErrorCode CheckLimits(Scheme s, PetscInt v, const PetscScalar X[], char failure[]) {
  const Membrane m = s->membrane;
  const Scene scene = s->scene;
  const char *const names[] = {"-limit_edge_ratio", "-limit_area_error", "-limit_length_error"};
  const char *const what[] = {"edge ratio", "area error", "length error"};
  const char *const advice[] = {
      "a smaller -time_step, more markers (-vesicle_spacing, with finer -domain_cells) or a larger limit",
      "a smaller -time_step, finer -domain_cells or a larger limit",
      "a smaller -time_step, finer -domain_cells with more markers, -scheme_type coupled or a larger limit"};
  const PetscReal limit[] = {scene->limits.edge_ratio, scene->limits.area_error, scene->limits.length_error};
  Measures measures;
  PetscFunctionBeginUser;
  MembraneMeasure(m, v, X, &measures);
  const PetscReal found[] = {measures.edge_ratio, measures.area / m->A0[v] - 1, measures.length / m->L0[v] - 1};
  for (int k = 0; k < 3; k++) {
    if (limit[k] == 0 || PetscAbsReal(found[k]) <= limit[k] || (k == 2 && MembraneStretches(m, v)) ||
        (k == 1 && m->permeability > 0))
      continue;
    PetscCall(PetscSNPrintf(failure, PETVES_MAX_MESSAGE, "vesicle %" PetscInt_FMT ": %s %.3g beyond %s %g", v + 1,
                            what[k], (double)found[k], names[k], (double)limit[k]));
    PetscCall(SchemeAdvise(s, advice[k]));
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A check of one own vesicle with markers X[2n]: text says what is wrong, and stays empty where nothing is. */
typedef PetscErrorCode VesicleCheck(Scheme s, PetscInt v, const PetscScalar X[], char text[PETVES_MAX_MESSAGE]);

/* The first text that a check has on any vesicle, each on its owner; the same on all ranks. */
static PetscErrorCode CheckVesicles(Scheme s, VesicleCheck check, char text[PETVES_MAX_MESSAGE]) {
  const Layout l = s->membrane->layout;
  const PetscScalar *X;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(s->state.X, &X));
  for (PetscInt v = l->own; v < l->end && !*text; v++) PetscCall(check(s, v, X + 2 * LayoutOffset(l, v), text));
  PetscCall(VecRestoreArrayRead(s->state.X, &X));
  PetscCall(AgreeMessage(l->comm, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warn, once a run, of the first vesicle that a check finds; warned: that it has. */
static PetscErrorCode WarnOfVesicle(Scheme s, VesicleCheck check, PetscBool *warned) {
  char text[PETVES_MAX_MESSAGE] = "";
  PetscFunctionBeginUser;
  if (*warned) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckVesicles(s, check, text));
  *warned = *text ? PETSC_TRUE : PETSC_FALSE;
  if (*warned) PetscCall(SchemeWarn(s, "%s", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An odd number of markers that is likely to resolve a shape that n markers do not resolve. The spectrum is assumed to
   decay further as it does from one third of the modes to two thirds; where it decays slowly, twice as many are
   returned. */
static PetscInt Resolving(PetscInt n, PetscReal third, PetscReal tail) {
  const PetscReal decay = PetscLogReal(third / tail), missing = PetscLogReal(tail / SMOOTH);
  const PetscReal more = missing < 2 * decay ? 1 + 0.5 * missing / decay : 2;
  return 2 * (PetscInt)PetscCeilReal((more * n - 1) / 2) + 1;
}

/* That markers resolve the vesicle; else a number of markers that may. */
static PetscErrorCode CheckSpectrum(Scheme s, PetscInt v, const PetscScalar X[], char text[]) {
  const Membrane m = s->membrane;
  const PetscInt n = LayoutCount(m->layout, v);
  const PetscReal tail = SpectralTail(m->spectral[v], 2. / 3, X);
  PetscFunctionBeginUser;
  if (tail < SceneRoughTail(s->scene)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(text, PETVES_MAX_MESSAGE,
                          "%" PetscInt_FMT " markers do not resolve vesicle %" PetscInt_FMT " after step %" PetscInt_FMT
                          ", time %g: %.2g of its bending is in the last third of its "
                          "modes, %g is good%s; try -vesicle_markers %" PetscInt_FMT,
                          n, v + 1, s->state.step, (double)s->state.t, (double)tail, SMOOTH,
                          s->state.step < FIRST_JUDGED ? ", though the flow may smooth a first shape" : "",
                          Resolving(n, SpectralTail(m->spectral[v], 1. / 3, X), tail)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells from n markers X[2n] to the nearest wall of a direction. */
static PetscReal FromWall(Grid g, int dir, PetscInt n, const PetscScalar X[]) {
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < n; k++)
    least = PetscMin(least, PetscMin(X[2 * k + dir] - g->lo[dir], g->hi[dir] - X[2 * k + dir]) / g->h);
  return least;
}

/* That the vesicle keeps away from two walls that meet. */
static PetscErrorCode CheckCorner(Scheme s, PetscInt v, const PetscScalar X[], char text[]) {
  const Grid g = s->fluid->grid;
  const PetscInt n = LayoutCount(s->membrane->layout, v);
  PetscFunctionBeginUser;
  if (PetscMax(FromWall(g, 0, n, X), FromWall(g, 1, n, X)) >= CORNER) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(text, PETVES_MAX_MESSAGE,
                          "vesicle %" PetscInt_FMT " is within %d cells of two walls that meet after "
                          "step %" PetscInt_FMT ", time %g; there its velocity is off by 1 to 20 %%: try finer "
                          "-domain_cells",
                          v + 1, CORNER, s->state.step, (double)s->state.t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warn, once a run, of a fixed step that is too long for the motion. The estimate falls with the square of the step or
   faster, which gives the step to try. */
static PetscErrorCode WarnOfStep(Scheme s) {
  const PetscReal found = s->report.estimate;
  PetscFunctionBeginUser;
  if (s->warnings.step || s->state.step < FIRST_JUDGED || found < COARSE_STEP) PetscFunctionReturn(PETSC_SUCCESS);
  s->warnings.step = PETSC_TRUE;
  PetscCall(SchemeWarn(s,
                       "a marker moved by %.2g R0 otherwise than the steps before foretold, in step %" PetscInt_FMT
                       ", time %g; above %g R0 markers are off by 1 %% of R0 or more: try -time_step %.2g, or "
                       "-time_adapt error",
                       (double)found, s->state.step, (double)s->state.t, COARSE_STEP,
                       (double)(s->state.dt * PetscSqrtReal(0.5 * COARSE_STEP / found))));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Distance of markers below which the fluid between vesicles v and w is not resolved: two cells. With the exact near
   field there is no such distance between two vesicles, as finer points resolve the fluid between them, and parts of
   one vesicle are resolved down to 1.5 edges. */
static PetscReal Unresolved(Scheme s, PetscInt v, PetscInt w) {
  if (!s->coupling->mobility->near) return CONTACT * s->fluid->grid->h;
  return v == w ? CLOSE_PARTS * s->membrane->ds[v] : 0;
}

typedef struct {
  Scheme scheme;
  PetscMPIInt pair[2]; /* vesicles in contact, numbered from 1; 0, 0: none */
} ContactSearch;

/* Whether two near markers are a contact: nearer than Unresolved, and on one vesicle farther apart along the membrane
   than twice that distance. */
static PetscBool IsContact(void *context, PetscInt k, PetscInt l, const PetscReal d[2]) {
  ContactSearch *c = (ContactSearch *)context;
  const Scheme s = c->scheme;
  const Layout layout = s->membrane->layout;
  const PetscInt v = LayoutBody(layout, k), w = LayoutBody(layout, l);
  const PetscReal near = Unresolved(s, v, w);
  if (v == w && PetscMin(l - k, LayoutCount(layout, v) - (l - k)) * s->membrane->ds[v] <= 2 * near) return PETSC_FALSE;
  if (d[0] * d[0] + d[1] * d[1] >= near * near) return PETSC_FALSE;
  c->pair[0] = (PetscMPIInt)v + 1;
  c->pair[1] = (PetscMPIInt)w + 1;
  return PETSC_TRUE;
}

static PetscErrorCode WarnOfContact(Scheme s, const PetscMPIInt pair[2]) {
  const PetscBool exact = s->coupling->mobility->near ? PETSC_TRUE : PETSC_FALSE;
  char who[64];
  PetscFunctionBeginUser;
  PetscCall(SchemeNamePair(s, pair[0] - 1, pair[1] - 1, "parts of vesicle %" PetscInt_FMT, sizeof(who), who));
  PetscCall(SchemeWarn(
      s,
      "%s are closer than %.3g %s after step %" PetscInt_FMT ", time %g; %s not resolve the fluid between them: try %s",
      who, exact ? CLOSE_PARTS : CONTACT, exact ? "edges" : "cells", s->state.step, (double)s->state.t,
      exact ? "their markers do" : "the grid does", exact ? "more -vesicle_markers" : "finer -domain_cells"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckCrossing(Scheme s, const PetscScalar X[]) {
  PetscInt pair[2];
  char who[64];
  PetscFunctionBeginUser;
  PetscCall(FilmsCross(s, X, pair));
  if (pair[0] < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SchemeNamePair(s, pair[0], pair[1], "parts of vesicle %" PetscInt_FMT, sizeof(who), who));
  PetscCall(PetscSNPrintf(s->report.failure, sizeof(s->report.failure), "%s cross", who));
  PetscCall(SchemeAdvise(s, "a smaller -time_step, more -vesicle_markers or finer -domain_cells"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A failure when membranes cross, one another or themselves, or when a fixed step has drained a film (films.h); a
   warning, once when it begins, when they are so close that the fluid between them is not resolved. In a time in
   proportion to the markers: each rank looks at the pairs whose first vesicle it owns, and the first contact of all
   ranks counts. */
static PetscErrorCode CheckContact(Scheme s) {
  const Layout l = s->membrane->layout;
  const PetscBool before = s->warnings.contact;
  const PetscInt own[2] = {l->first, l->first + l->n};
  ContactSearch search = {.scheme = s};
  PetscReal reach = 0, found, period[2];
  PetscMPIInt whose;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < l->bodies; v++) reach = PetscMax(reach, Unresolved(s, v, v));
  PetscCall(SchemeCurves(s, StateInstant(&s->state), s->state.X));
  if (s->scene->limits.crossing) PetscCall(CheckCrossing(s, s->work_all));
  FluidSpecPeriods(&s->scene->fluid, period);
  PetscCall(PairsWithin(l->M, s->work_all, own, period, reach, IsContact, &search));
  PetscCall(AgreeMessage(l->comm, s->report.failure));
  found = search.pair[0] ? 1 : 0;
  PetscCall(AgreeLargest(l->comm, &found, &whose));
  PetscCallMPI(MPI_Bcast(search.pair, 2, MPI_INT, whose, l->comm));
  s->warnings.contact = search.pair[0] ? PETSC_TRUE : PETSC_FALSE;
  if (!*s->report.failure && !s->policy.adaptive) PetscCall(FilmsCheck(s)); /* else judged before it was accepted */
  if (s->warnings.contact && !before && !*s->report.failure) PetscCall(WarnOfContact(s, search.pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Without scaled stencils the box part of the near field is right in corners too. */
PetscErrorCode SchemeCheck(Scheme s) {
  const Grid g = s->fluid->grid;
  const PetscBool corners = s->coupling->mobility->near && !g->free && g->wall[0] && g->wall[1] &&
                            s->coupling->markers->scaled;
  char *failure = s->report.failure;
  PetscFunctionBeginUser;
  PetscCall(CheckFinite(s));
  if (*failure || !CouplingHasMembrane(s->coupling)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MarkersCheck(s->coupling->markers, s->membrane->layout, s->state.X, failure));
  if (*failure)
    PetscCall(SchemeAdvise(s, "a larger -domain_box, or a smaller -time_step if it should not have come there"));
  if (!*failure) PetscCall(CheckVesicles(s, CheckLimits, failure));
  if (!*failure) PetscCall(CheckContact(s));
  if (!*failure && s->coupling->mobility->near) PetscCall(WarnOfVesicle(s, CheckSpectrum, &s->warnings.rough));
  if (!*failure && corners) PetscCall(WarnOfVesicle(s, CheckCorner, &s->warnings.corner));
  if (!*failure) PetscCall(FilmsWarn(s));
  if (!*failure) PetscCall(WarnOfStep(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
