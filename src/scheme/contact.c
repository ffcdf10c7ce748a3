#include "scheme/statechecks.h"
#include "base/agree.h"
#include "curve/crossing.h"
#include "scheme/films.h"

#define CONTACT 2 /* cells between membranes below which a warning is due */
#define CLOSE_PARTS                                                                                                    \
  1.5 /* edges between parts of one membrane below which a warning is due, with the exact near field */

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

/* The first contact of an own vesicle with another or with itself; X begins with the vesicles' markers. */
static PetscErrorCode FindContact(Scheme s, const PetscScalar X[], PetscReal reach, PetscMPIInt pair[2]) {
  const Layout l = s->membrane->layout;
  ContactSearch search = {.scheme = s};
  const PetscInt own[2] = {l->first, l->first + l->n};
  PetscReal period[2];
  PetscFunctionBeginUser;
  FluidSpecPeriods(&s->scene->fluid, period);
  PetscCall(PairsWithin(l->M, X, own, period, reach, IsContact, &search));
  PetscCall(PetscArraycpy(pair, search.pair, 2));
  PetscFunctionReturn(PETSC_SUCCESS);
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

/* Each rank looks at the pairs whose first vesicle it owns; the first contact of all ranks counts. */
PetscErrorCode SchemeCheckContact(Scheme s) {
  const Layout l = s->membrane->layout;
  const PetscBool before = s->warnings.contact;
  PetscReal reach = 0, found;
  PetscMPIInt pair[2] = {0, 0}, whose;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < l->bodies; v++) reach = PetscMax(reach, Unresolved(s, v, v));
  PetscCall(SchemeCurves(s, s->state.t, s->state.X));
  if (s->scene->limits.crossing) PetscCall(CheckCrossing(s, s->work_all));
  PetscCall(FindContact(s, s->work_all, reach, pair));
  PetscCall(AgreeMessage(l->comm, s->report.failure));
  found = pair[0] ? 1 : 0;
  PetscCall(AgreeLargest(l->comm, &found, &whose));
  PetscCallMPI(MPI_Bcast(pair, 2, MPI_INT, whose, l->comm));
  s->warnings.contact = pair[0] ? PETSC_TRUE : PETSC_FALSE;
  if (!*s->report.failure && !s->policy.adaptive) PetscCall(FilmsCheck(s)); /* else judged before it was accepted */
  if (s->warnings.contact && !before && !*s->report.failure) PetscCall(WarnOfContact(s, pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}
