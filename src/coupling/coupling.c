#include "coupling/coupling.h"

PetscErrorCode CouplingCheckMarkers(Coupling c, const PetscScalar X[], char message[], size_t length) {
  static const char *const names[2][2] = {{"x_min", "x_max"}, {"y_min", "y_max"}};
  const Grid g = c->grid;
  const Membrane m = c->membrane;
  PetscFunctionBeginUser;
  message[0] = 0;
  for (PetscInt v = 0; v < m->vesicles; v++)
    for (PetscInt k = m->start[v]; k < m->start[v + 1]; k++)
      for (int dir = 0; dir < 2; dir++) {
        const PetscReal x = X[2 * k + dir];
        if (PetscIsInfOrNanReal(x)) {
          PetscCall(
              PetscSNPrintf(message, length, "vesicle %" PetscInt_FMT ": marker positions are not finite", v + 1));
          PetscFunctionReturn(PETSC_SUCCESS);
        }
        for (int side = 0; side < 2 && g->wall[dir]; side++) {
          const PetscReal distance = side ? g->hi[dir] - x : x - g->lo[dir];
          if (distance >= 3 * g->h * (1 - 1e-12)) continue;
          PetscCall(PetscSNPrintf(message, length,
                                  "vesicle %" PetscInt_FMT ": a marker at (%g, %g) is %g cells from the wall %s = %g; "
                                  "the kernel needs 3",
                                  v + 1, (double)X[2 * k], (double)X[2 * k + 1], (double)(distance / g->h),
                                  names[dir][side], (double)(side ? g->hi[dir] : g->lo[dir])));
          PetscFunctionReturn(PETSC_SUCCESS);
        }
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's rows under the stencils, one more on either side for G and G^T; all of them across a seam. */
static void SetWindow(Coupling c) {
  const Grid g = c->grid;
  const PetscInt rows = g->rows[FIELD_P];
  PetscInt low = PETSC_MAX_INT, high = -1;
  for (PetscInt k = 0; k < 2 * c->membrane->M; k++) {
    low = PetscMin(low, c->stencil[k].first[1]);
    high = PetscMax(high, c->stencil[k].first[1] + c->stencil[k].n[1]);
  }
  low -= 2 + g->first;
  high += 2 - g->first;
  const PetscBool seam = !g->wall[1] && (low + g->first < 0 || high + g->first > g->n[1]) ? PETSC_TRUE : PETSC_FALSE;
  c->window[0] = seam ? 0 : PetscMin(PetscMax(low, 0), rows);
  c->window[1] = seam ? rows : PetscMax(PetscMin(high, rows), c->window[0]);
}

PetscErrorCode CouplingSetMarkers(Coupling c, Vec X) {
  const Grid g = c->grid;
  const PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(X, &x));
  for (PetscInt k = 0; k < c->membrane->M; k++)
    for (int comp = 0; comp < 2; comp++)
      for (int dir = 0; dir < 2; dir++) {
        Stencil *s = &c->stencil[2 * k + comp];
        /* entry 0 of a component sits on the first right (top) face along its direction, in a cell's middle across */
        const PetscReal r = (x[2 * k + dir] - g->lo[dir]) / g->h - (comp == dir ? 1.0 : 0.5);
        s->n[dir] = (comp == dir ? c->kernel->along : c->kernel->across)(r, &s->first[dir], s->weight[dir]);
        if (!g->wall[dir]) s->first[dir] = ((s->first[dir] % g->n[dir]) + g->n[dir]) % g->n[dir];
      }
  PetscCall(PetscArraycpy(c->X, x, 2 * c->membrane->M));
  MembraneTangents(c->membrane, x, c->tau);
  SetWindow(c);
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Local row of a component that is entry b of a stencil, or -1 when another rank holds it. Beyond a wall only zero
   weights can fall, as markers keep three cells away. */
static inline PetscInt LocalRow(const Grid g, int comp, const Stencil *s, PetscInt b) {
  PetscInt j = s->first[1] + b;
  if (!g->wall[1] && j >= g->n[1]) j -= g->n[1];
  j -= g->first;
  return j >= 0 && j < g->rows[comp] ? j : -1;
}

/* w += alpha E^T F on the slab's array. */
static void Spread(Coupling c, const PetscScalar F[], PetscScalar w[]) {
  const Grid g = c->grid;
  for (PetscInt k = 0; k < c->membrane->M; k++)
    for (int comp = 0; comp < 2; comp++) {
      const Stencil *s = &c->stencil[2 * k + comp];
      const PetscInt columns = g->columns[comp], i0 = s->first[0], n = s->n[0];
      const PetscBool inside = i0 >= 0 && i0 + n <= columns ? PETSC_TRUE : PETSC_FALSE;
      for (PetscInt b = 0; b < s->n[1]; b++) {
        const PetscInt j = LocalRow(g, comp, s, b);
        if (j < 0) continue;
        PetscScalar *row = w + (comp ? GridLocalU(g) : 0) + j * columns;
        const PetscScalar f = c->alpha * F[2 * k + comp] * s->weight[1][b];
        if (inside)
          for (PetscInt a = 0; a < n; a++) row[i0 + a] += f * s->weight[0][a];
        else
          for (PetscInt a = 0; a < n; a++) {
            const PetscInt i = g->wall[0] ? i0 + a : (i0 + a) % columns;
            if (i >= 0 && i < columns) row[i] += f * s->weight[0][a];
          }
      }
    }
}

/* U = E w: this rank's part, then the sum over ranks, whose bits one rank decides. */
static PetscErrorCode Interpolate(Coupling c, const PetscScalar w[], PetscScalar U[]) {
  const Grid g = c->grid;
  const PetscMPIInt n2 = (PetscMPIInt)(2 * c->membrane->M);
  PetscScalar *part = g->size > 1 ? c->sum : U;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->membrane->M; k++)
    for (int comp = 0; comp < 2; comp++) {
      const Stencil *s = &c->stencil[2 * k + comp];
      const PetscInt columns = g->columns[comp], i0 = s->first[0], n = s->n[0];
      const PetscBool inside = i0 >= 0 && i0 + n <= columns ? PETSC_TRUE : PETSC_FALSE;
      PetscScalar sum = 0;
      for (PetscInt b = 0; b < s->n[1]; b++) {
        const PetscInt j = LocalRow(g, comp, s, b);
        if (j < 0) continue;
        const PetscScalar *row = w + (comp ? GridLocalU(g) : 0) + j * columns;
        PetscScalar line = 0;
        if (inside)
          for (PetscInt a = 0; a < n; a++) line += row[i0 + a] * s->weight[0][a];
        else
          for (PetscInt a = 0; a < n; a++) {
            const PetscInt i = g->wall[0] ? i0 + a : (i0 + a) % columns;
            if (i >= 0 && i < columns) line += row[i] * s->weight[0][a];
          }
        sum += line * s->weight[1][b];
      }
      part[2 * k + comp] = sum;
    }
  if (g->size > 1) {
    PetscCallMPI(MPI_Reduce(part, U, n2, MPIU_SCALAR, MPI_SUM, 0, g->comm));
    PetscCallMPI(MPI_Bcast(U, n2, MPIU_SCALAR, 0, g->comm));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The shells: what acts on marker arrays before a spreading, or after an interpolation. */
typedef enum { FROM_MARKERS, FROM_TENSION, FROM_BENDING } Source;

static PetscErrorCode SpreadSource(Coupling c, Source source, Vec x, PetscBool add, Vec w) {
  const PetscReal h2 = PetscSqr(c->grid->h);
  const PetscInt n2 = 2 * c->membrane->M;
  const PetscScalar *xa;
  PetscScalar *wa;
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(c->spread, 0, 0, 0, 0));
  PetscCall(VecGetArrayRead(x, &xa));
  if (!add) PetscCall(VecSet(w, 0));
  PetscCall(VecGetArray(w, &wa));
  if (source != FROM_MARKERS) PetscCall(PetscArrayzero(c->force, n2));
  if (source == FROM_TENSION) MembraneStretchingTranspose(c->membrane, c->tau, 1 / h2, xa, c->force);
  if (source == FROM_BENDING) MembraneBending(c->membrane, c->membrane->bending / h2, xa, c->work, c->force);
  Spread(c, source == FROM_MARKERS ? xa : c->force, wa);
  PetscCall(VecRestoreArray(w, &wa));
  PetscCall(VecRestoreArrayRead(x, &xa));
  PetscCall(PetscLogEventEnd(c->spread, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode InterpolateSource(Coupling c, Source source, Vec w, Vec y) {
  const PetscReal h2 = PetscSqr(c->grid->h);
  const PetscScalar *wa;
  PetscScalar *ya;
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(c->interpolate, 0, 0, 0, 0));
  PetscCall(VecGetArrayRead(w, &wa));
  PetscCall(VecGetArray(y, &ya));
  PetscCall(Interpolate(c, wa, source == FROM_MARKERS ? ya : c->force));
  if (source == FROM_TENSION) {
    MembraneStretching(c->membrane, c->tau, c->force, ya);
    for (PetscInt k = 0; k < c->membrane->M; k++) ya[k] /= h2;
  }
  if (source == FROM_BENDING) {
    PetscCall(PetscArrayzero(ya, 2 * c->membrane->M));
    MembraneBending(c->membrane, c->membrane->bending / h2, c->force, c->work, ya);
  }
  PetscCall(VecRestoreArray(y, &ya));
  PetscCall(VecRestoreArrayRead(w, &wa));
  PetscCall(PetscLogEventEnd(c->interpolate, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define SHELL(name, source)                                                                                            \
  static PetscErrorCode Spread_##name(Mat A, Vec x, Vec w) {                                                           \
    Coupling c;                                                                                                        \
    PetscFunctionBeginUser;                                                                                            \
    PetscCall(MatShellGetContext(A, &c));                                                                              \
    PetscCall(SpreadSource(c, source, x, PETSC_FALSE, w));                                                             \
    PetscFunctionReturn(PETSC_SUCCESS);                                                                                \
  }                                                                                                                    \
  static PetscErrorCode SpreadAdd_##name(Mat A, Vec x, Vec v, Vec w) {                                                 \
    Coupling c;                                                                                                        \
    PetscFunctionBeginUser;                                                                                            \
    PetscCall(MatShellGetContext(A, &c));                                                                              \
    if (v != w) PetscCall(VecCopy(v, w));                                                                              \
    PetscCall(SpreadSource(c, source, x, PETSC_TRUE, w));                                                              \
    PetscFunctionReturn(PETSC_SUCCESS);                                                                                \
  }                                                                                                                    \
  static PetscErrorCode Interpolate_##name(Mat A, Vec w, Vec y) {                                                      \
    Coupling c;                                                                                                        \
    PetscFunctionBeginUser;                                                                                            \
    PetscCall(MatShellGetContext(A, &c));                                                                              \
    PetscCall(InterpolateSource(c, source, w, y));                                                                     \
    PetscFunctionReturn(PETSC_SUCCESS);                                                                                \
  }
SHELL(E, FROM_MARKERS)
SHELL(S, FROM_TENSION)
SHELL(B, FROM_BENDING)

typedef PetscErrorCode (*ShellMult)(Mat, Vec, Vec);
typedef PetscErrorCode (*ShellMultAdd)(Mat, Vec, Vec, Vec);

/* A shell whose spreading is its product, or (transposed) its transposed product. */
static PetscErrorCode CreateShell(Coupling c, PetscInt slab, PetscInt markers, PetscBool transposed, ShellMult spread,
                                  ShellMultAdd add, ShellMult interpolate, Mat *A) {
  const PetscInt rows = transposed ? markers : slab, columns = transposed ? slab : markers;
  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(PETSC_COMM_SELF, rows, columns, rows, columns, c, A));
  PetscCall(MatShellSetOperation(*A, transposed ? MATOP_MULT_TRANSPOSE : MATOP_MULT, (void (*)(void))spread));
  PetscCall(MatShellSetOperation(*A, transposed ? MATOP_MULT_TRANSPOSE_ADD : MATOP_MULT_ADD, (void (*)(void))add));
  PetscCall(MatShellSetOperation(*A, transposed ? MATOP_MULT : MATOP_MULT_TRANSPOSE, (void (*)(void))interpolate));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingCreate(Grid g, Membrane m, const char kernel[], Coupling *out) {
  Coupling c;
  const PetscInt slab = GridLocalU(g) + g->columns[FIELD_V] * g->rows[FIELD_V];
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->grid = g;
  c->membrane = m;
  c->alpha = 1;
  c->kernel = KernelFind(kernel);
  PetscCheck(c->kernel, g->comm, PETSC_ERR_USER_INPUT, "-delta_type %s: unknown kernel", kernel);
  PetscCall(PetscMalloc6(2 * m->M, &c->X, 2 * m->M, &c->stencil, 2 * m->M, &c->tau, 2 * m->M, &c->force, 2 * m->M,
                         &c->work, 2 * m->M, &c->sum));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, slab, NULL, &c->slab));
  PetscCall(CreateShell(c, slab, 2 * m->M, PETSC_TRUE, Spread_E, SpreadAdd_E, Interpolate_E, &c->E));
  PetscCall(CreateShell(c, slab, m->M, PETSC_FALSE, Spread_S, SpreadAdd_S, Interpolate_S, &c->S));
  PetscCall(CreateShell(c, slab, 2 * m->M, PETSC_FALSE, Spread_B, SpreadAdd_B, Interpolate_B, &c->B));
  PetscCall(PetvesEvent("Spread", &c->spread));
  PetscCall(PetvesEvent("Interpolate", &c->interpolate));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingDestroy(Coupling *coupling) {
  Coupling c = *coupling;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree6(c->X, c->stencil, c->tau, c->force, c->work, c->sum));
  PetscCall(VecDestroy(&c->slab));
  PetscCall(MatDestroy(&c->E));
  PetscCall(MatDestroy(&c->S));
  PetscCall(MatDestroy(&c->B));
  PetscCall(PetscFree(*coupling));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingSpreadAdd(Coupling c, PetscReal alpha, Mat A, Vec x, Vec w) {
  PetscFunctionBeginUser;
  c->alpha = alpha;
  PetscCall(VecGetLocalVector(w, c->slab));
  if (A == c->E)
    PetscCall(MatMultTransposeAdd(A, x, c->slab, c->slab));
  else
    PetscCall(MatMultAdd(A, x, c->slab, c->slab));
  PetscCall(VecRestoreLocalVector(w, c->slab));
  c->alpha = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingInterpolate(Coupling c, Mat A, Vec w, Vec y) {
  PetscFunctionBeginUser;
  PetscCall(VecGetLocalVectorRead(w, c->slab));
  if (A == c->E)
    PetscCall(MatMult(A, c->slab, y));
  else
    PetscCall(MatMultTranspose(A, c->slab, y));
  PetscCall(VecRestoreLocalVectorRead(w, c->slab));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplingClear(Coupling c, Vec w, PetscInt dirty[2]) {
  PetscFunctionBeginUser;
  PetscCall(GridClearRows(c->grid, dirty, w));
  for (int k = 0; k < 2; k++) dirty[k] = c->window[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}
