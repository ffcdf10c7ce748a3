#include "bodies/repulsion.h"

#define EDGES 1.5 /* longest mean edges: the range where none is given */

/* How far the law reaches. */
static PetscReal RepulsionReach(const SceneRepulsion *law) {
  return law->range + (law->adhesion > 0 ? law->band : 0);
}

/* SUM weight normal.x, x[2(M + W)]. */
static PetscReal SpringStretch(const Spring *s, const PetscScalar x[]) {
  PetscReal along = 0;
  for (PetscInt i = 0; i < s->n; i++)
    for (int c = 0; c < 2; c++) along += s->weight[i] * s->normal[c] * x[2 * s->marker[i] + c];
  return along;
}

/* The law on a length `size` of membrane, into a spring whose geometry is known; X[2(M + W)]. With P = p size the force
   is P + stiffness (distance - SUM weight normal.(x - X)) below D. */
static void SpringSetLaw(const SceneRepulsion *law, PetscReal size, const PetscReal X[], Spring *s) {
  const PetscReal x = (s->distance - law->range) / law->band;
  const PetscReal well = law->adhesion * size; /* depth of it */
  if (x < 0) {
    s->stiffness = law->stress * size / law->range;
    s->push = s->stiffness * (law->range - s->distance + SpringStretch(s, X));
    s->energy = 0.5 * s->stiffness * PetscSqr(law->range - s->distance) - well;
  } else { /* INT of 30 y^2 (1 - y)^2 from x to 1 is 1 - 10 x^3 + 15 x^4 - 6 x^5 */
    s->push = -30 * well / law->band * PetscSqr(x * (1 - x));
    s->energy = -well * (1 - x * x * x * (10 - x * (15 - 6 * x)));
  }
}

/* Whether contact moves a body: not an obstacle unless it moves freely. */
static PetscBool RepulsionMoves(Repulsion r, PetscInt body) {
  return body < r->bodies->vesicles || r->bodies->obstacles->motion[body - r->bodies->vesicles].free;
}

/* A marker and the edge nearest to it: half of what is between two membranes, as markers of both look for edges. */
static void SpringSetEdge(Repulsion r, const PetscReal X[], const CurveContact *c, Spring *s) {
  const PetscInt vesicles = r->bodies->vesicles, vesicle = c->curve[c->curve[0] < vesicles ? 0 : 1];
  const PetscInt marker[3] = {c->point, c->edge[0], c->edge[1]};
  const PetscReal weight[3] = {1, c->at - 1, -c->at};
  *s = (Spring){.normal = {c->normal[0], c->normal[1]}, .distance = c->distance};
  s->vesicle = vesicle < vesicles ? vesicle : -1;
  for (int k = 0; k < 3; k++) {
    if (!RepulsionMoves(r, c->curve[k > 0])) continue;
    s->marker[s->n] = marker[k];
    s->weight[s->n++] = weight[k];
  }
  SceneRepulsion law = r->law;
  if (c->type != CONTACT_BETWEEN) law.adhesion = 0;
  SpringSetLaw(&law, 0.5 * r->bodies->ds[c->curve[0]], X, s);
}

/* Markers of vesicles and free bodies near walls; room for 4 a marker. */
static PetscInt FindWallSprings(Repulsion r, const PetscReal X[], Spring spring[]) {
  const Grid g = r->grid;
  const Layout l = r->bodies->layout;
  PetscInt count = 0;
  for (PetscInt v = 0; v < l->bodies; v++) {
    if (!RepulsionMoves(r, v)) continue;
    for (PetscInt k = l->start[v]; k < l->start[v + 1]; k++)
      for (int side = 0; side < 4; side++) {
        const int d = side / 2;
        const PetscReal sign = side % 2 ? -1 : 1;
        const PetscReal distance = sign * (X[2 * k + d] - (side % 2 ? g->hi[d] : g->lo[d]));
        if (!g->wall[d] || g->free || distance >= RepulsionReach(&r->law)) continue;
        spring[count] = (Spring){.n = 1, .marker = {k}, .weight = {1}, .distance = distance};
        spring[count].vesicle = v < r->bodies->vesicles ? v : -1;
        spring[count].normal[d] = sign;
        SpringSetLaw(&r->law, r->bodies->ds[v], X, &spring[count++]);
      }
  }
  return count;
}

/* The springs at the curves X[2(M + W)]; to be freed. */
static PetscErrorCode FindSprings(Repulsion r, const PetscReal X[], PetscInt *count, Spring **springs) {
  const Grid g = r->grid;
  const Layout all = r->bodies->layout;
  const Obstacles o = r->bodies->obstacles;
  const PetscInt moving = o && o->free->M ? all->bodies : r->bodies->vesicles;
  PetscReal period[2];
  CurveContact *contact;
  PetscInt n;
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) period[d] = g->wall[d] || g->free ? 0 : g->hi[d] - g->lo[d];
  const CurveSet set = {all->bodies, moving, all->start, r->bodies->kind, X, period, PETSC_FALSE};
  PetscCall(CurveContacts(&set, RepulsionReach(&r->law), r->bodies->vesicles, r->bodies->ds, &n, &contact));
  PetscCall(PetscMalloc1(n + 4 * all->M, springs));
  for (PetscInt k = 0; k < n; k++) SpringSetEdge(r, X, &contact[k], &(*springs)[k]);
  PetscCall(PetscFree(contact));
  *count = n + FindWallSprings(r, X, *springs + n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RepulsionPlace(void *context, Instant at, const PetscReal X[]) {
  const Repulsion r = (Repulsion)context;
  PetscFunctionBeginUser;
  PetscCall(PetscFree(r->spring));
  PetscCall(BodiesSee(r->bodies, at, X, r->all));
  PetscCall(FindSprings(r, r->all, &r->count, &r->spring));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y += force weight normal of the own markers. */
static void SpringPull(const Spring *s, Layout l, PetscReal force, PetscScalar y[]) {
  for (PetscInt i = 0; i < s->n; i++) {
    const PetscInt own = s->marker[i] - l->first;
    if (own < 0 || own >= l->n) continue;
    for (int c = 0; c < 2; c++) y[2 * own + c] += force * s->weight[i] * s->normal[c];
  }
}

static PetscErrorCode RepulsionRate(void *context, PetscReal alpha, const PetscScalar x[], PetscScalar y[]) {
  const Repulsion r = (Repulsion)context;
  const Layout l = r->bodies->layout;
  PetscFunctionBeginUser;
  PetscCall(LayoutGather(l, 2, x, r->all));
  for (PetscInt k = 0; k < r->count; k++) {
    const Spring *s = &r->spring[k];
    if (s->stiffness > 0) SpringPull(s, l, alpha * s->stiffness * SpringStretch(s, r->all), y);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RepulsionKnown(void *context, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  const Repulsion r = (Repulsion)context;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < r->count; k++) SpringPull(&r->spring[k], r->bodies->layout, -alpha * r->spring[k].push, F);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RepulsionSeams(void *context, const PetscReal X[], const PetscScalar x[], PetscReal *sum) {
  const Repulsion r = (Repulsion)context;
  PetscFunctionBeginUser;
  PetscCall(LayoutGather(r->bodies->layout, 2, x, r->all));
  for (PetscInt k = 0; k < r->count; k++) {
    const Spring *s = &r->spring[k];
    PetscReal apart = -s->distance * s->normal[0];
    if (s->n < 3) continue; /* of a wall or of an obstacle that contact does not move */
    for (PetscInt i = 0; i < s->n; i++) apart += s->weight[i] * X[2 * s->marker[i]];
    *sum += (s->push - s->stiffness * SpringStretch(s, r->all)) * s->normal[0] * apart;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The energy of the films of each own vesicle has half of that of a film between two vesicles. Collective. */
static PetscErrorCode RepulsionAt(void *context, Instant at, const PetscScalar x[], PetscScalar y[], PetscReal E[]) {
  const Repulsion r = (Repulsion)context;
  const Layout l = r->bodies->membrane->layout;
  Spring *spring;
  PetscInt count;
  PetscFunctionBeginUser;
  PetscCall(LayoutGather(l, 2, x, r->all));
  PetscCall(BodiesSee(r->bodies, at, r->all, r->all));
  PetscCall(FindSprings(r, r->all, &count, &spring));
  for (PetscInt k = 0; k < count; k++) {
    const Spring *s = &spring[k];
    if (E && s->vesicle >= l->own && s->vesicle < l->end) E[s->vesicle] += s->energy;
    if (y) SpringPull(s, l, s->push - s->stiffness * SpringStretch(s, r->all), y);
  }
  PetscCall(PetscFree(spring));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RepulsionDestroy(void *context) {
  const Repulsion r = (Repulsion)context;
  PetscFunctionBeginUser;
  PetscCall(PetscFree(r->spring));
  PetscCall(PetscFree(r->all));
  PetscCall(PetscFree(context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForceCreate_Contact(Bodies bodies, Grid grid, Scene scene, Force *force) {
  Repulsion r;
  PetscFunctionBeginUser;
  if (!scene || scene->repulsion.stress <= 0 ||
      !(bodies->vesicles || (bodies->obstacles && bodies->obstacles->free->M)))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&r));
  r->bodies = bodies;
  r->grid = grid;
  r->law = scene->repulsion;
  for (PetscInt v = 0; v < bodies->layout->bodies && scene->repulsion.range <= 0; v++)
    r->law.range = PetscMax(r->law.range, EDGES * bodies->ds[v]);
  if (r->law.band <= 0) r->law.band = r->law.range;
  PetscCall(PetscMalloc1(2 * bodies->layout->M, &r->all));
  *force = (Force){.name = "contact",
                   .reach = FORCE_BETWEEN,
                   .context = r,
                   .place = RepulsionPlace,
                   .rate = RepulsionRate,
                   .known = RepulsionKnown,
                   .law = RepulsionAt,
                   .energy = RepulsionAt,
                   .seams = RepulsionSeams,
                   .destroy = RepulsionDestroy};
  PetscFunctionReturn(PETSC_SUCCESS);
}
