#include "precondition/obstaclemodes.h"
#include "base/agree.h"
#include "numerics/blas.h"
#include "numerics/symmetric.h"
#include "precondition/curvepoints.h"

#define POINTS 11
#define POINT_MARKERS 6 /* of a curve with many: one point for so many */
#define SAME 1e-6       /* cells that markers of curves of one shape differ by, at most */

/* A curve that others are equal to but for their place. */
typedef struct {
  PetscInt like; /* the first of them */
  CurvePoints curve;
  PetscInt numbers; /* 2n, with q of a free body 3 more */
  float *inverse;   /* D^-1 (symmetric.h), on root */
  float *answer;    /* D^-1 Q, [2 points][numbers], on root */
  PetscReal *G;     /* [2 points][2 points], on root */
} CurveShape;

struct _p_ObstacleModes {
  const FluidSpec *spec; /* borrowed */
  Coupling coupling;     /* borrowed */
  PetscMPIInt root;
  PetscInt *of;    /* [curves] shape of each */
  PetscInt *start; /* [curves + 1] first number of each: two a point */
  PetscInt shapes;
  CurveShape *shape;
  float *K;                      /* (symmetric.h), on root */
  float *amplitude, *correction; /* [modes] work */
  float *x, *y;                  /* [most numbers of a curve] work */
};

/* How many points a curve has when one of few markers has `least`. */
static PetscInt CountPoints(PetscInt n, PetscInt least) {
  const PetscInt many = n * least / (POINT_MARKERS * POINTS);
  return PetscMin(n - 1 + n % 2, PetscMax(least, many - 1 + many % 2));
}

/* Points for every curve, as many as K has room for. */
static PetscErrorCode SharePoints(ObstacleModes s) {
  const Layout l = s->coupling->bodies->obstacles->layout;
  PetscFunctionBeginUser;
  for (PetscInt least = POINTS; least >= 1; least -= 2) {
    for (PetscInt v = 0; v < l->bodies; v++) s->start[v + 1] = s->start[v] + 2 * CountPoints(LayoutCount(l, v), least);
    if (s->start[l->bodies] <= OBSTACLE_MODES) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleModesCreate(const FluidSpec *spec, Coupling c, PetscMPIInt root, ObstacleModes *out) {
  const PetscInt curves = c->bodies->obstacles->layout->bodies;
  PetscInt most = 0;
  ObstacleModes s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->spec = spec;
  s->coupling = c;
  s->root = root;
  PetscCall(PetscCalloc3(curves, &s->of, curves + 1, &s->start, curves, &s->shape));
  PetscCall(SharePoints(s));
  const PetscInt n = s->start[curves];
  for (PetscInt v = 0; v < curves; v++) most = PetscMax(most, 2 * LayoutCount(c->bodies->obstacles->layout, v) + 3);
  PetscCall(PetscMalloc4(n, &s->amplitude, n, &s->correction, most, &s->x, most, &s->y));
  if (c->bodies->layout->rank == root) PetscCall(PetscMalloc1(SymmetricSize(n), &s->K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeShapes(ObstacleModes s) {
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->shapes; k++) {
    PetscCall(CurvePointsDestroy(&s->shape[k].curve));
    PetscCall(PetscFree3(s->shape[k].inverse, s->shape[k].answer, s->shape[k].G));
  }
  s->shapes = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleModesDestroy(ObstacleModes *modes) {
  ObstacleModes s = *modes;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeShapes(s));
  PetscCall(PetscFree(s->K));
  PetscCall(PetscFree4(s->amplitude, s->correction, s->x, s->y));
  PetscCall(PetscFree3(s->of, s->start, s->shape));
  PetscCall(PetscFree(*modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt ObstacleModesCount(ObstacleModes s) {
  return s->start[s->coupling->bodies->obstacles->layout->bodies];
}

/* Whether two curves are equal but for their place, and as far from the walls; free ones as heavy, in equal fluid. */
static PetscBool AreEqualCurves(ObstacleModes s, PetscInt v, PetscInt w) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const Grid g = s->coupling->fluid->grid;
  const PetscReal *X = o->X + 2 * o->layout->start[v], *Y = o->X + 2 * o->layout->start[w];
  const PetscInt free[2] = {o->motion[v].free, o->motion[w].free};
  if (LayoutCount(o->layout, v) != LayoutCount(o->layout, w) || o->kind[v].type != o->kind[w].type ||
      !free[0] != !free[1])
    return PETSC_FALSE;
  if (free[0] && (o->density[free[0] - 1] != o->density[free[1] - 1] || o->ratio[v] != o->ratio[w])) return PETSC_FALSE;
  for (PetscInt k = 0; k < 2 * LayoutCount(o->layout, v); k++) {
    const PetscReal apart = g->wall[k % 2] ? 0 : X[k % 2] - Y[k % 2];
    if (PetscAbsReal(X[k] - Y[k] - apart) > SAME * g->h) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static void FindShapes(ObstacleModes s) {
  const Layout l = s->coupling->bodies->obstacles->layout;
  for (PetscInt v = 0; v < l->bodies; v++) {
    PetscInt k = 0;
    while (k < s->shapes && !AreEqualCurves(s, v, s->shape[k].like)) k++;
    if (k == s->shapes) s->shape[s->shapes++] = (CurveShape){.like = v};
    s->of[v] = k;
  }
}

/* D^-1, D^-1 Q and G of a shape from D, on root. */
static PetscErrorCode InvertCurve(CurveShape *q, const PetscReal D[], PetscBool *done) {
  const PetscInt n = q->numbers, m = 2 * q->curve.points, markers = q->curve.n;
  float *single;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(SymmetricSize(n), &q->inverse, m * n, &q->answer, m * m, &q->G));
  PetscCall(PetscCalloc1(n, &single));
  PetscCall(SymmetricInvert(n, D, q->inverse, done));
  for (PetscInt j = 0; j < m && *done; j++) {
    float *answer = q->answer + j * n;
    for (PetscInt k = 0; k < 2 * markers; k++)
      single[k] = k % 2 == j % 2 ? (float)q->curve.to_markers[j / 2 * markers + k / 2] : 0;
    SymmetricMult(n, q->inverse, single, answer);
    for (PetscInt i = 0; i < m; i++) {
      q->G[j * m + i] = 0;
      for (PetscInt k = i % 2; k < 2 * markers; k += 2)
        q->G[j * m + i] += q->curve.to_markers[i / 2 * markers + k / 2] * answer[k];
    }
  }
  PetscCall(PetscFree(single));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeShapes(ObstacleModes s, PetscReal alpha, PetscBool *done) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const InnerFluid inner = s->coupling->mobility->inner;
  MeanMobility mobility;
  PetscReal *D;
  PetscFunctionBeginUser;
  *done = PETSC_TRUE;
  PetscCall(FreeShapes(s));
  FindShapes(s);
  PetscCall(MeanMobilityCreate(s->spec, s->coupling, PETSC_MAX_REAL, &mobility));
  PetscCall(MeanMobilitySetUp(mobility, alpha));
  for (PetscInt k = 0; k < s->shapes; k++) {
    CurveShape *q = &s->shape[k];
    const PetscInt n = LayoutCount(o->layout, q->like);
    const MarkerRange own = {o->all->M - o->layout->M + o->layout->start[q->like], n};
    PetscBool good = PETSC_TRUE;
    PetscCall(CurvePointsCreate(o->kind[q->like].type == CURVE_OPEN ? PETSC_TRUE : PETSC_FALSE, n,
                                (s->start[q->like + 1] - s->start[q->like]) / 2, &q->curve));
    q->numbers = 2 * n + (o->motion[q->like].free ? 3 : 0);
    PetscCall(PetscMalloc1(q->numbers * q->numbers, &D));
    PetscCall(MeanMobilityOnRoot(mobility, &own, &own, s->root, D));
    PetscCall(
        FreeBodiesBlock(o, q->like, q->like + 1, s->coupling->fluid->grid->h, alpha, inner ? inner->mass : NULL, D));
    if (o->layout->rank == s->root) PetscCall(InvertCurve(q, D, &good));
    if (!good) *done = PETSC_FALSE;
    PetscCall(PetscFree(D));
  }
  PetscCall(MeanMobilityDestroy(&mobility));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* M[modes][modes] on root, the grid's mobility between points of different curves: every rank makes a part. */
static PetscErrorCode AssembleModes(ObstacleModes s, PetscReal alpha, PetscReal M[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const Layout l = o->layout;
  const Grid g = s->coupling->fluid->grid;
  const PetscInt n = ObstacleModesCount(s);
  const PetscReal over = 1 / PetscSqr(g->h), period[2] = {g->hi[0] - g->lo[0], g->hi[1] - g->lo[1]};
  MobilityTable table;
  PetscReal *Y;
  PetscMPIInt size;
  PetscFunctionBeginUser;
  PetscCall(MobilityTableCreate(s->spec, s->coupling->markers->kernel, PETSC_MAX_REAL, &table));
  PetscCall(MobilityTableSetUp(table, alpha));
  PetscCall(PetscMalloc1(n, &Y));
  for (PetscInt v = 0; v < l->bodies; v++)
    CurvePointsPlace(&s->shape[s->of[v]].curve, o->kind[v].span, o->X + 2 * l->start[v], Y + s->start[v]);
  PetscCall(PetscArrayzero(M, n * n));
  for (PetscInt v = 0; v < l->bodies; v++)
    for (PetscInt i = s->start[v] + 2 * l->rank; i < s->start[v + 1]; i += 2 * l->size)
      for (PetscInt j = s->start[v + 1]; j < n; j += 2) {
        PetscReal d[2];
        for (int c = 0; c < 2; c++) {
          d[c] = Y[i + c] - Y[j + c];
          d[c] -= period[c] * PetscFloorReal(d[c] / period[c] + 0.5);
        }
        MobilityTableAdd(table, over, d, n, M + j * n + i);
        MobilityTableAdd(table, over, d, n, M + i * n + j);
      }
  PetscCall(PetscFree(Y));
  PetscCall(MobilityTableDestroy(&table));
  PetscCall(PetscMPIIntCast(n * n, &size));
  if (l->size > 1)
    PetscCallMPI(MPI_Reduce(l->rank == s->root ? MPI_IN_PLACE : M, M, size, MPIU_REAL, MPI_SUM, s->root, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K = (I + M G)^-1 M, on root; M is overwritten. */
static PetscErrorCode MakeK(ObstacleModes s, PetscReal M[], PetscBool *done) {
  const PetscInt n = ObstacleModesCount(s), curves = s->coupling->bodies->obstacles->layout->bodies;
  PetscBLASInt *pivot;
  PetscReal *B;
  float *single;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n, &B, n, &pivot));
  for (PetscInt v = 0; v < curves; v++) {
    const PetscInt first = s->start[v], m = s->start[v + 1] - first;
    PetscCall(DenseProduct(PETSC_FALSE, n, m, m, M + first * n, s->shape[s->of[v]].G, B + first * n));
  }
  for (PetscInt k = 0; k < n; k++) B[k * n + k] += 1;
  PetscCall(DenseFactor(n, B, pivot, done));
  if (*done) PetscCall(DenseSolve(n, B, pivot, PETSC_FALSE, n, M));
  PetscCall(PetscFree2(B, pivot));
  PetscCall(PetscMalloc1(n * n, &single));
  DenseSingle(n * n, M, single);
  SymmetricPack(n, single, s->K);
  PetscCall(PetscFree(single));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleModesSetUp(ObstacleModes s, PetscReal alpha, PetscBool *failed) {
  const Layout l = s->coupling->bodies->obstacles->layout;
  const PetscInt n = ObstacleModesCount(s);
  PetscBool done;
  PetscReal *M;
  PetscFunctionBeginUser;
  PetscCall(MakeShapes(s, alpha, &done));
  PetscCall(PetscMalloc1(n * n, &M));
  PetscCall(AssembleModes(s, alpha, M));
  if (l->rank == s->root && done) PetscCall(MakeK(s, M, &done));
  PetscCall(PetscFree(M));
  PetscCall(AgreeFlag(l->comm, done ? PETSC_FALSE : PETSC_TRUE, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copy the numbers of a curve out of those of all, or (back) into them. */
static void CopyCurve(ObstacleModes s, PetscInt v, PetscBool back, float all[], float one[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const PetscInt n = 2 * LayoutCount(o->layout, v), free = o->motion[v].free ? 3 : 0;
  float *markers = all + 2 * o->layout->start[v], *q = all + 2 * o->layout->M + 3 * (o->motion[v].free - 1);
  (void)PetscArraycpy(back ? markers : one, back ? one : markers, n);
  (void)PetscArraycpy(back ? q : one + n, back ? one + n : q, free);
}

PetscErrorCode ObstacleModesApply(ObstacleModes s, float x[], float y[]) {
  const Layout l = s->coupling->bodies->obstacles->layout;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->amplitude, ObstacleModesCount(s)));
  for (PetscInt v = 0; v < l->bodies; v++) {
    const CurveShape *q = &s->shape[s->of[v]];
    CopyCurve(s, v, PETSC_FALSE, x, s->x);
    PetscCall(DenseSingleMultAdd(PETSC_TRUE, q->numbers, 2 * q->curve.points, 1, q->answer, s->x,
                                 s->amplitude + s->start[v]));
  }
  SymmetricMult(ObstacleModesCount(s), s->K, s->amplitude, s->correction);
  for (PetscInt v = 0; v < l->bodies; v++) {
    const CurveShape *q = &s->shape[s->of[v]];
    CopyCurve(s, v, PETSC_FALSE, x, s->x);
    SymmetricMult(q->numbers, q->inverse, s->x, s->y);
    PetscCall(DenseSingleMultAdd(PETSC_FALSE, q->numbers, 2 * q->curve.points, -1, q->answer,
                                 s->correction + s->start[v], s->y));
    CopyCurve(s, v, PETSC_TRUE, y, s->y);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
