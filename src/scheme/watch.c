/* Watching for trouble: the state before a step, and what is looked at after it. */
#include "scheme/scheme.h"

#define CONTACT 2 /* cells between membranes below which a warning is due */

/* Copy a state; without `fields` the velocity and the pressure stay where they are. */
static PetscErrorCode CopyState(const State *from, State *to, PetscBool fields) {
  const Vec source[] = {from->w, from->p, from->sigma, from->X, from->U, from->walls};
  Vec *target[] = {&to->w, &to->p, &to->sigma, &to->X, &to->U, &to->walls};
  PetscFunctionBeginUser;
  for (int k = fields ? 0 : 2; k < 6 && source[k]; k++) {
    if (!*target[k]) PetscCall(VecDuplicate(source[k], target[k]));
    PetscCall(VecCopy(source[k], *target[k]));
  }
  to->step = from->step;
  to->t = from->t;
  to->dt = from->dt;
  to->dt_last = from->dt_last;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeKeep(Scheme s) {
  Snapshot *b = &s->before;
  PetscFunctionBeginUser;
  b->fields = s->undo && s->has_old ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(CopyState(&s->state, &b->state, b->fields));
  if (s->has_old) PetscCall(CopyState(s->old, &b->old, b->fields));
  b->has_old = s->has_old;
  if (s->level) b->level = *s->level;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeReturn(Scheme s) {
  const Snapshot *b = &s->before;
  PetscFunctionBeginUser;
  if (!b->fields && s->state.step > b->state.step) PetscCall(s->undo(s));
  PetscCall(CopyState(&b->state, &s->state, b->fields));
  if (b->has_old) PetscCall(CopyState(&b->old, s->old, b->fields));
  s->has_old = b->has_old;
  if (s->level) *s->level = b->level;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeFreeSnapshot(Scheme s) {
  State *both[2] = {&s->before.state, &s->before.old};
  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) {
    Vec *all[] = {&both[i]->w, &both[i]->p, &both[i]->sigma, &both[i]->X, &both[i]->U, &both[i]->walls};
    for (int k = 0; k < 6; k++) PetscCall(VecDestroy(all[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What to try goes behind what is wrong. */
static PetscErrorCode Advise(Scheme s, const char advice[]) {
  char *text = s->report.failure;
  const size_t used = strlen(text), room = sizeof(s->report.failure) - used;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(text + used, room, " after step %" PetscInt_FMT ", time %g; try %s", s->state.step,
                          (double)s->state.t, advice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckFinite(Scheme s) {
  static const char *const names[] = {"velocity", "pressure", "tension", "marker velocity"};
  const Vec all[] = {NULL, s->state.p, s->state.sigma, s->state.U};
  PetscFunctionBeginUser;
  for (int k = 0; k < (s->coupling ? 4 : 2); k++) {
    PetscReal norm = s->report.div_max; /* of the velocity */
    if (k) PetscCall(VecNorm(all[k], NORM_2, &norm));
    if (!PetscIsInfOrNanReal(norm)) continue;
    PetscCall(PetscSNPrintf(s->report.failure, sizeof(s->report.failure), "the %s is not finite", names[k]));
    PetscCall(Advise(s, "a smaller -time_step, or tighter solver tolerances"));
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Edge ratio, area and length of every vesicle. */
static PetscErrorCode CheckLimits(Scheme s, const PetscScalar X[]) {
  const Membrane m = s->membrane;
  const Scene scene = s->scene;
  const char *const names[] = {"-limit_edge_ratio", "-limit_area_error", "-limit_length_error"};
  const char *const what[] = {"edge ratio", "area error", "length error"};
  const char *const advice[] = {
      "a smaller -time_step, more markers (-vesicle_spacing, with finer -domain_cells) or a larger limit",
      "a smaller -time_step, finer -domain_cells or a larger limit",
      "a smaller -time_step, finer -domain_cells with more markers, -scheme_type coupled or a larger limit"};
  const PetscReal limit[] = {scene->limits.edge_ratio, scene->limits.area_error, scene->limits.length_error};
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < m->vesicles; v++) {
    Measures measures;
    MembraneMeasure(m, v, X, &measures);
    const PetscReal found[] = {measures.edge_ratio, measures.area / m->A0[v] - 1, measures.length / m->L0[v] - 1};
    for (int k = 0; k < 3; k++) {
      if (limit[k] == 0 || PetscAbsReal(found[k]) <= limit[k]) continue;
      PetscCall(PetscSNPrintf(s->report.failure, sizeof(s->report.failure),
                              "vesicle %" PetscInt_FMT ": %s %.3g beyond %s %g", v + 1, what[k], (double)found[k],
                              names[k], (double)limit[k]));
      PetscCall(Advise(s, advice[k]));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Distance of two coordinates, through a periodic boundary where that is shorter. */
static PetscReal Apart(Grid g, int dir, PetscReal a, PetscReal b) {
  const PetscReal box = g->hi[dir] - g->lo[dir], d = PetscAbsReal(a - b);
  return g->wall[dir] ? d : PetscAbsReal(d - box * PetscFloorReal(d / box + 0.5));
}

/* Markers closer than 2 h that are no neighbours: on two vesicles, or more than 4 h apart along one. */
static PetscBool FindContact(Scheme s, const PetscScalar X[], PetscInt pair[2]) {
  const Membrane m = s->membrane;
  const Grid g = s->fluid->grid;
  const PetscReal near = CONTACT * g->h;
  for (PetscInt v = 0; v < m->vesicles; v++)
    for (PetscInt w = v; w < m->vesicles; w++)
      for (PetscInt k = m->start[v]; k < m->start[v + 1]; k++)
        for (PetscInt l = v == w ? k + 1 : m->start[w]; l < m->start[w + 1]; l++) {
          const PetscInt n = m->start[v + 1] - m->start[v];
          if (v == w && PetscMin(l - k, n - (l - k)) * m->ds[v] <= 2 * near) continue;
          const PetscReal dx = Apart(g, 0, X[2 * k], X[2 * l]);
          if (dx >= near) continue;
          const PetscReal dy = Apart(g, 1, X[2 * k + 1], X[2 * l + 1]);
          if (dx * dx + dy * dy >= near * near) continue;
          pair[0] = v;
          pair[1] = w;
          return PETSC_TRUE;
        }
  return PETSC_FALSE;
}

/* Once when a contact begins. */
static PetscErrorCode WarnOfContact(Scheme s, const PetscScalar X[]) {
  PetscInt pair[2] = {0, 0};
  char who[64];
  const PetscBool before = s->contact;
  PetscFunctionBeginUser;
  s->contact = FindContact(s, X, pair);
  if (!s->contact || before) PetscFunctionReturn(PETSC_SUCCESS);
  if (pair[0] == pair[1])
    PetscCall(PetscSNPrintf(who, sizeof(who), "parts of vesicle %" PetscInt_FMT, pair[0] + 1));
  else
    PetscCall(
        PetscSNPrintf(who, sizeof(who), "vesicles %" PetscInt_FMT " and %" PetscInt_FMT, pair[0] + 1, pair[1] + 1));
  PetscCall(PetscPrintf(s->scene->comm,
                        "petves: warning: %s are closer than %d cells after step %" PetscInt_FMT
                        ", time %g; the grid does not resolve the fluid between them: try finer -domain_cells\n",
                        who, CONTACT, s->state.step, (double)s->state.t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeCheck(Scheme s) {
  const PetscScalar *X;
  char *failure = s->report.failure;
  PetscFunctionBeginUser;
  PetscCall(CheckFinite(s));
  if (*failure || !s->coupling) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(s->state.X, &X));
  PetscCall(CouplingCheckMarkers(s->coupling, X, failure, sizeof(s->report.failure)));
  if (*failure) PetscCall(Advise(s, "a larger -domain_box, or a smaller -time_step if it should not have come there"));
  if (!*failure) PetscCall(CheckLimits(s, X));
  if (!*failure) PetscCall(WarnOfContact(s, X));
  PetscCall(VecRestoreArrayRead(s->state.X, &X));
  PetscFunctionReturn(PETSC_SUCCESS);
}
