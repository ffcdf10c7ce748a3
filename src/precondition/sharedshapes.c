#include "precondition/sharedshapes.h"
#include "base/agree.h"
#include "precondition/age.h"
#include "precondition/interactions.h"

#define TOLERANCE 0.03 /* of a vesicle's distance from its shape */
#define STEP_RATIO 1.1 /* of two steps whose matrices are shared */

PetscErrorCode SharedShapesCreate(const FluidSpec *spec, Coupling c, SharedShapes *out) {
  const Membrane m = c->membrane;
  const Layout l = m->layout;
  PetscInt most = 0;
  SharedShapes s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->coupling = c;
  for (PetscInt v = 0; v < l->bodies; v++) most = PetscMax(most, LayoutCount(l, v));
  PetscCall(PetscMalloc4(l->bodies, &s->of, l->end - l->own, &s->order, l->end - l->own, &s->fit, 2 * most, &s->X));
  PetscCall(PetscMalloc2(3 * l->n, &s->from, 4 * l->n, &s->to));
  for (PetscInt v = 0; v < l->bodies; v++) s->of[v] = -1;
  PetscCall(CoarseGridCreate(spec, c->bodies, c->markers->kernel->name, &s->coarse));
  if (s->coarse) PetscCall(InteractionsCreate(s, &s->cross));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeShapeMatrices(SharedShape *q) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(q->inverse));
  PetscCall(PetscFree(q->sources));
  PetscCall(PetscFree(q->self));
  PetscCall(PetscFree(q->points));
  PetscCall(CurvePointsDestroy(&q->curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeShape(SharedShape *q) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(q->X));
  PetscCall(FreeShapeMatrices(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SharedShapesDestroy(SharedShapes *shapes) {
  SharedShapes s = *shapes;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < s->count; k++) PetscCall(FreeShape(&s->shape[k]));
  PetscCall(PetscFree(s->shape));
  PetscCall(InteractionsDestroy(&s->cross));
  PetscCall(CoarseGridDestroy(&s->coarse));
  PetscCall(PetscFree4(s->of, s->order, s->fit, s->X));
  PetscCall(PetscFree2(s->from, s->to));
  PetscCall(PetscFree(*shapes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether two vesicles have as many markers, as far apart, equal membranes and the same viscosity. */
static PetscBool AreAlike(Coupling c, PetscInt v, PetscInt w) {
  const Membrane m = c->membrane;
  if (c->mobility->contrast && c->mobility->contrast->ratio[v] != c->mobility->contrast->ratio[w]) return PETSC_FALSE;
  return LayoutCount(m->layout, v) == LayoutCount(m->layout, w) &&
         PetscAbsReal(m->ds[v] - m->ds[w]) < 1e-6 * m->ds[v] && MaterialsAlike(&m->material[v], &m->material[w]);
}

/* What of a shape's distance is due to its label speed, in the mode in which that counts most beside the I and the
   bending of N, 1 + c_b m^3/(4 nu R0^3 a0). */
static PetscReal TreadingDistance(Coupling c, PetscInt v, const SharedShape *q) {
  const Membrane m = c->membrane;
  const PetscReal R0 = m->L0[v] / (2 * PETSC_PI), a0 = c->fluid->a0;
  const PetscReal stiffness = m->part[v] * m->bending / (4 * c->fluid->nu * R0 * R0 * R0 * a0);
  PetscReal most = 0;
  for (PetscInt k = 1; 2 * k <= LayoutCount(m->layout, v); k++) {
    const PetscReal mode = (PetscReal)k;
    most = PetscMax(most, mode / (1 + stiffness * mode * mode * mode));
  }
  return most * PetscAbsReal(c->treading[v] - q->treading) / a0;
}

/* How far a shape's matrices are from those of own vesicle v, whose centred markers are s->X: its curve, part of R0,
   and its label speed. Where that is more than `limit` (what no fit can mend shows most of them) it may be any larger
   number. */
static PetscReal ShapeDistance(SharedShapes s, PetscInt v, const SharedShape *q, const PetscReal size[],
                               PetscReal limit, RigidFit *fit) {
  const Membrane m = s->coupling->membrane;
  const PetscReal R0 = m->L0[v] / (2 * PETSC_PI);
  if (!AreAlike(s->coupling, v, q->like)) return PETSC_MAX_REAL;
  const PetscReal treading = TreadingDistance(s->coupling, v, q);
  if (RigidFitLeast(size, q->size) / R0 + treading > limit) return PETSC_MAX_REAL;
  *fit = RigidFitCurves(LayoutCount(m->layout, v), PETSC_TRUE, s->X, q->X);
  return fit->distance / R0 + treading;
}

/* The shape that own vesicle v takes from here on: that of before while it is near enough, else the nearest of those
   from `first` on; false when it needs a new one. */
static PetscBool ChooseShape(SharedShapes s, PetscInt v, PetscInt first) {
  const Layout l = s->coupling->membrane->layout;
  PetscReal least = TOLERANCE, size[RIGIDFIT_SIZES];
  RigidFit *own = &s->fit[v - l->own], fit;
  RigidFitCentre(LayoutCount(l, v), s->coupling->markers->X + 2 * l->start[v], s->X);
  RigidFitSizes(LayoutCount(l, v), s->X, size);
  if (s->of[v] >= 0 && ShapeDistance(s, v, &s->shape[s->of[v]], size, least, own) <= least) return PETSC_TRUE;
  s->of[v] = -1;
  for (PetscInt k = first; k < s->count; k++) {
    const PetscReal distance = ShapeDistance(s, v, &s->shape[k], size, least, &fit);
    if (distance > least) continue;
    least = distance;
    s->of[v] = k;
    *own = fit;
  }
  return s->of[v] >= 0;
}

/* A shape, zero but for its X. */
static PetscErrorCode AddShape(SharedShapes s, PetscInt like, PetscReal treading, const PetscReal X[]) {
  const Membrane m = s->coupling->membrane;
  PetscFunctionBeginUser;
  PetscCall(ArrayReserve((size_t)s->count + 1, &s->room, &s->shape));
  const PetscInt n = LayoutCount(m->layout, like);
  const PetscBool jumps = s->coupling->mobility->contrast && s->coupling->mobility->contrast->ratio[like] != 1;
  SharedShape *q = &s->shape[s->count++];
  *q = (SharedShape){.like = like, .treading = treading, .rows = jumps ? 4 * n : 2 * n};
  PetscCall(PetscMalloc1(2 * n, &q->X));
  PetscCall(PetscArraycpy(q->X, X, 2 * n));
  RigidFitSizes(n, X, q->size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which vesicle takes which shape, told to all ranks; those that none takes any more are dropped. */
static PetscErrorCode TellShapes(SharedShapes s) {
  const Layout l = s->coupling->membrane->layout;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < l->bodies; v++)
    if (v < l->own || v >= l->end) s->of[v] = -1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->of, (PetscMPIInt)l->bodies, MPIU_INT, MPI_MAX, l->comm));
  for (PetscInt k = s->count - 1; k >= 0; k--) {
    PetscBool taken = PETSC_FALSE;
    for (PetscInt v = 0; v < l->bodies; v++)
      if (s->of[v] == k) taken = PETSC_TRUE;
    if (taken) continue;
    PetscCall(FreeShape(&s->shape[k]));
    PetscCall(PetscArraymove(s->shape + k, s->shape + k + 1, --s->count - k));
    for (PetscInt v = 0; v < l->bodies; v++) s->of[v] -= s->of[v] > k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* New shapes until every vesicle has one: each of the first vesicle of all ranks that needs one, so that they do not
   depend on the ranks. */
static PetscErrorCode ChooseShapes(SharedShapes s) {
  const Layout l = s->coupling->membrane->layout;
  PetscInt first = 0, found[2] = {0, 0}; /* the vesicle that needs one, minus whether any has changed */
  PetscFunctionBeginUser;
  for (PetscInt round = 0;; round++) {
    found[0] = l->bodies;
    for (PetscInt v = l->own; v < l->end; v++) {
      const PetscInt before = s->of[v];
      if (round && before >= 0) continue;
      if (!ChooseShape(s, v, first)) found[0] = PetscMin(found[0], v);
      if (s->of[v] != before) found[1] = -1;
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, found, 2, MPIU_INT, MPI_MIN, l->comm));
    if (found[0] == l->bodies) break;
    first = s->count;
    RigidFitCentre(LayoutCount(l, found[0]), s->coupling->markers->X + 2 * l->start[found[0]], s->X);
    PetscCall(AddShape(s, found[0], s->coupling->treading[found[0]], s->X));
  }
  if (found[1]) PetscCall(TellShapes(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Matrices of the shapes that own vesicles take, for the a0 in force. */
static PetscErrorCode MakeShapeMatrices(SharedShapes s, PetscBool *failed) {
  const PetscReal a0 = s->coupling->fluid->a0;
  PetscBool good = PETSC_TRUE;
  PetscFunctionBeginUser;
  if (AgeStepChanged(s->a0, a0, STEP_RATIO)) {
    s->a0 = a0;
    for (PetscInt k = 0; k < s->count; k++) PetscCall(FreeShapeMatrices(&s->shape[k]));
  }
  for (PetscInt k = 0; k < s->count && good; k++) {
    SharedShape *q = &s->shape[k];
    if (q->end > q->begin && !q->inverse) PetscCall(SharedShapeMake(s, q, &good));
  }
  PetscCall(AgreeFlag(s->coupling->membrane->layout->comm, good ? PETSC_FALSE : PETSC_TRUE, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SharedShapesFollow(SharedShapes s, PetscBool *failed) {
  const Layout l = s->coupling->membrane->layout;
  PetscLogEvent event;
  PetscInt at = 0;
  PetscFunctionBeginUser;
  PetscCall(PetvesEvent("FactorMobility", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  PetscCall(ChooseShapes(s));
  for (PetscInt k = 0; k < s->count; k++) { /* own vesicles by shape */
    s->shape[k].begin = at;
    for (PetscInt v = l->own; v < l->end; v++)
      if (s->of[v] == k) s->order[at++] = v;
    s->shape[k].end = at;
  }
  PetscCall(MakeShapeMatrices(s, failed));
  if (s->cross && !*failed) PetscCall(InteractionsPlace(s->cross));
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* B^-1 (r + (W, 0)). */
PetscErrorCode SharedShapesSolve(SharedShapes s, PetscScalar U[], PetscScalar sigma[]) {
  PetscFunctionBeginUser;
  if (s->cross) PetscCall(InteractionsAdd(s->cross, sigma, U));
  for (PetscInt k = 0; k < s->count; k++) PetscCall(SharedShapeSolve(s, &s->shape[k], U, sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Memory: a0; the curve of each shape in the place of the first vesicle that takes it; that vesicle's number for
   every vesicle; label speed and kin of each shape, in the place of that vesicle. */
void SharedShapesGetMemory(SharedShapes s, PetscReal memory[]) {
  const Layout l = s->coupling->membrane->layout;
  PetscReal *X = memory + 1, *first = X + 2 * l->M, *treading = first + l->bodies, *like = treading + l->bodies;
  (void)PetscArrayzero(memory, SharedShapesMemorySize(l));
  memory[0] = s->a0;
  for (PetscInt v = 0; v < l->bodies && s->a0 > 0; v++) {
    const SharedShape *q = &s->shape[s->of[v]];
    PetscInt w = 0;
    while (s->of[w] != s->of[v]) w++;
    first[v] = (PetscReal)w;
    if (w != v) continue;
    (void)PetscArraycpy(X + 2 * l->start[v], q->X, 2 * LayoutCount(l, v));
    treading[v] = q->treading;
    like[v] = (PetscReal)q->like;
  }
}

/* Whether a number from a file is that of a vesicle like v. */
static PetscBool IsNumberAlike(Coupling c, PetscInt v, PetscReal number) {
  return number >= 0 && number < (PetscReal)c->membrane->layout->bodies && AreAlike(c, v, (PetscInt)number);
}

PetscErrorCode SharedShapesSetMemory(SharedShapes s, const PetscReal memory[], PetscBool *valid) {
  const Coupling c = s->coupling;
  const Layout l = c->membrane->layout;
  const PetscReal *X = memory + 1, *first = X + 2 * l->M, *treading = first + l->bodies, *like = treading + l->bodies;
  PetscFunctionBeginUser;
  *valid = PETSC_TRUE;
  if (!(memory[0] > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < l->bodies; v++)
    if (!IsNumberAlike(c, v, first[v]) || first[v] > (PetscReal)v || !IsNumberAlike(c, v, like[(PetscInt)first[v]]) ||
        first[(PetscInt)first[v]] != first[v])
      *valid = PETSC_FALSE;
  if (!*valid) PetscFunctionReturn(PETSC_SUCCESS);
  s->a0 = memory[0];
  for (PetscInt v = 0; v < l->bodies; v++) {
    const PetscInt w = (PetscInt)first[v];
    s->of[v] = w == v ? s->count : s->of[w];
    if (w == v) PetscCall(AddShape(s, (PetscInt)like[v], treading[v], X + 2 * l->start[v]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
