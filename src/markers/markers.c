#include "markers/markers.h"
#include "base/agree.h"
#include "markers/wallfold.h"

/* The message of a marker of body b at X that is too near a wall or beyond it; distance in cells. */
static PetscErrorCode MarkerReject(PetscInt b, const PetscReal X[2], PetscReal distance, const char wall[],
                                   PetscReal at, const char needs[], char message[PETVES_MAX_MESSAGE]) {
  char where[64] = "beyond", need[64] = "";
  PetscFunctionBeginUser;
  if (distance >= 0) {
    PetscCall(PetscSNPrintf(where, sizeof(where), "%g cells from", (double)distance));
    PetscCall(PetscSNPrintf(need, sizeof(need), "; the kernel needs %s", needs));
  }
  PetscCall(PetscSNPrintf(message, PETVES_MAX_MESSAGE,
                          "vesicle %" PetscInt_FMT ": a marker at (%g, %g) is %s the wall %s = %g%s", b + 1,
                          (double)X[0], (double)X[1], where, wall, (double)at, need));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The message of the first wrong marker of X[2n], those of one of this rank's bodies, b. */
static PetscErrorCode MarkersCheckBody(Markers m, PetscInt b, PetscInt n, const PetscScalar X[],
                                       char message[PETVES_MAX_MESSAGE]) {
  static const char *const names[2][2] = {{"x_min", "x_max"}, {"y_min", "y_max"}};
  const Grid g = m->grid;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++)
    for (int dir = 0; dir < 2; dir++) {
      const PetscReal x = X[2 * k + dir];
      if (!(PetscAbsReal(x) <= PETSC_MAX_REAL)) {
        PetscCall(PetscSNPrintf(message, PETVES_MAX_MESSAGE,
                                "vesicle %" PetscInt_FMT ": marker positions are not finite", b + 1));
        PetscFunctionReturn(PETSC_SUCCESS);
      }
      for (int side = 0; side < 2 && g->wall[dir] && !g->free; side++) {
        const PetscReal distance = side ? g->hi[dir] - x : x - g->lo[dir];
        if (distance >= m->least * g->h * (1 - 1e-12)) continue;
        PetscCall(MarkerReject(b, X + 2 * k, distance / g->h, names[dir][side], side ? g->hi[dir] : g->lo[dir],
                               m->needs, message));
        PetscFunctionReturn(PETSC_SUCCESS);
      }
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MarkersCheck(Markers m, Layout layout, Vec X, char message[PETVES_MAX_MESSAGE]) {
  const PetscScalar *x;
  PetscFunctionBeginUser;
  message[0] = 0;
  PetscCall(VecGetArrayRead(X, &x));
  for (PetscInt b = layout->own; b < layout->end && !*message; b++)
    PetscCall(MarkersCheckBody(m, b, LayoutCount(layout, b), x + 2 * LayoutOffset(layout, b), message));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscCall(AgreeMessage(layout->comm, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define BESIDE 2 /* rows and columns next to the stencils that G, G^T and dipoles reach */

/* window: the part of entries low .. high of a grid row or column of n that this rank owns, counted from the rank's
   first entry; the rank has `own` entries from `first` on. Entries across a periodic seam give all of the rank's. */
static void WindowClip(PetscBool wall, PetscInt n, PetscInt first, PetscInt own, PetscInt low, PetscInt high,
                       PetscInt window[2]) {
  const PetscBool seam = !wall && (low < 0 || high > n);
  window[0] = seam ? 0 : PetscMin(PetscMax(low - first, 0), own);
  window[1] = seam ? own : PetscMax(PetscMin(high - first, own), window[0]);
}

/* Markers and points. */
static PetscInt MarkersCount(Markers m) {
  return m->layout->M + m->points;
}

static void MarkersSetWindow(Markers m) {
  const Grid g = m->grid;
  PetscInt low[2] = {PETSC_MAX_INT / 2, PETSC_MAX_INT / 2}, high[2] = {-1, -1};
  for (PetscInt k = 0; k < 2 * MarkersCount(m); k++)
    for (int d = 0; d < 2; d++) {
      low[d] = PetscMin(low[d], m->stencil[k].first[d]);
      high[d] = PetscMax(high[d], m->stencil[k].first[d] + m->stencil[k].n[d]);
    }
  WindowClip(g->wall[0], g->n[0], 0, g->n[0], low[0] - BESIDE, high[0] + BESIDE, m->window.columns);
  WindowClip(g->wall[1], g->n[1], g->first, g->rows[FIELD_P], low[1] - BESIDE, high[1] + BESIDE, m->window.rows);
}

/* Fold and scale the stencil of one component of a marker at X at the walls. */
static void MarkerFoldStencil(Markers m, int comp, const PetscReal X[2], Stencil *s) {
  const Grid g = m->grid;
  for (int dir = 0; dir < 2; dir++) {
    const PetscBool normal = comp == dir;
    if (!g->wall[dir]) continue;
    if (normal && m->scaled) {
      const PetscReal y = (X[dir] - g->lo[dir]) / g->h;
      const PetscReal scale = WallScale(m->kernel, y) * WallScale(m->kernel, g->n[dir] - y);
      for (PetscInt k = 0; k < s->n[dir]; k++) s->weight[dir][k] *= scale;
    }
    FoldLow(normal ? FOLD_EVEN : FOLD_ODD, &s->first[dir], &s->n[dir], s->weight[dir]);
    FoldHigh(normal ? FOLD_EVEN : FOLD_ODD, g->n[dir] - (normal ? 2 : 1), &s->first[dir], &s->n[dir], s->weight[dir]);
  }
}

PetscErrorCode MarkersPlace(Markers m, Vec X) {
  const Grid g = m->grid;
  const PetscInt n = MarkersCount(m);
  PetscFunctionBeginUser;
  PetscCall(LayoutGatherVec(m->layout, X, m->X));
  PetscCall(PetscArraycpy(m->X + 2 * m->layout->M, m->point, 2 * m->points));
  if (g->free) PetscFunctionReturn(PETSC_SUCCESS); /* without stencils the window is empty and E = 0 */
  for (PetscInt k = 0; k < n; k++)
    for (int comp = 0; comp < 2; comp++)
      for (int dir = 0; dir < 2; dir++) {
        Stencil *s = &m->plain[2 * k + comp];
        /* entry 0 of a component lies on the right or top face of the first cell along it, and in the cell's middle
         * across */
        const PetscReal r = (m->X[2 * k + dir] - g->lo[dir]) / g->h - (comp == dir ? 1.0 : 0.5);
        s->n[dir] = (comp == dir ? m->kernel->along : m->kernel->across)(r, &s->first[dir], s->weight[dir]);
        if (!g->wall[dir] && (s->first[dir] < 0 || s->first[dir] >= g->n[dir]))
          s->first[dir] = ((s->first[dir] % g->n[dir]) + g->n[dir]) % g->n[dir];
      }
  if (m->folded) {
    PetscCall(PetscArraycpy(m->stencil, m->plain, 2 * n));
    for (PetscInt k = 0; k < 2 * n; k++) MarkerFoldStencil(m, k % 2, m->X + k - k % 2, &m->stencil[k]);
  }
  for (PetscInt k = 0; k < 2 * n; k++) /* weights are padded to whole vectors */
    for (PetscInt a = m->stencil[k].n[0]; a < STENCIL_POINTS; a++) m->stencil[k].weight[0][a] = 0;
  MarkersSetWindow(m);
  PetscCall(StencilRowsPlace(m->rows, n, m->stencil));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal MarkersShortfall(Markers m, PetscInt k, int comp, int dir) {
  const Grid g = m->grid;
  const PetscReal middle = 0.5 * (g->lo[dir] + g->hi[dir]), x = m->X[2 * k + dir];
  const Stencil *s = &m->stencil[2 * k + comp];
  PetscReal short_of = x - middle;
  if (!m->folded || !g->wall[dir] || PetscMin(x - g->lo[dir], g->hi[dir] - x) >= KERNEL_WALL_CELLS * g->h) return 0;
  for (PetscInt q = 0; q < s->n[dir]; q++)
    short_of -= s->weight[dir][q] * (g->lo[dir] + (s->first[dir] + q + (comp == dir ? 1 : 0.5)) * g->h - middle);
  return short_of;
}

PetscErrorCode MarkersSpread(Markers m, PetscReal alpha, Vec F, Vec w) {
  PetscScalar *wa;
  PetscFunctionBeginUser;
  if (m->grid->free) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(m->spread, 0, 0, 0, 0));
  PetscCall(LayoutGatherVec(m->layout, F, m->force));
  PetscCall(VecGetArray(w, &wa));
  for (int f = FIELD_U; f <= FIELD_V; f++)
    for (PetscInt j = m->window.rows[0]; j < PetscMin(m->window.rows[1], m->grid->rows[f]); j++)
      StencilRowSpread(m->rows, (Field)f, j, alpha, m->force, wa + GridRowStart(m->grid, (Field)f, j));
  PetscCall(VecRestoreArray(w, &wa));
  PetscCall(PetscLogEventEnd(m->spread, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MarkersInterpolate(Markers m, Vec w, Vec U) {
  const PetscScalar *wa;
  PetscScalar *own;
  PetscFunctionBeginUser;
  if (m->grid->free) {
    PetscCall(VecSet(U, 0));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscLogEventBegin(m->interpolate, 0, 0, 0, 0));
  PetscCall(VecGetArrayRead(w, &wa));
  PetscCall(PetscArrayzero(m->part, 2 * MarkersCount(m)));
  for (int f = FIELD_U; f <= FIELD_V; f++)
    for (PetscInt j = m->window.rows[0]; j < PetscMin(m->window.rows[1], m->grid->rows[f]); j++)
      StencilRowInterpolate(m->rows, (Field)f, j, wa + GridRowStart(m->grid, (Field)f, j), m->part);
  PetscCall(VecRestoreArrayRead(w, &wa));
  if (U) {
    PetscCall(VecGetArray(U, &own));
    PetscCall(LayoutSum(m->layout, 2, m->part, own));
    PetscCall(VecRestoreArray(U, &own));
  }
  PetscCall(PetscLogEventEnd(m->interpolate, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcingSpread(Forcing *f, Markers m, PetscReal alpha, Vec F) {
  PetscFunctionBeginUser;
  ForcingNote(f, &m->window);
  PetscCall(MarkersSpread(m, alpha, F, f->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Mult_E(Mat E, Vec w, Vec U) {
  Markers m;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(E, &m));
  PetscCall(MarkersInterpolate(m, w, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MultTranspose_E(Mat E, Vec F, Vec w) {
  Markers m;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(E, &m));
  PetscCall(VecSet(w, 0));
  PetscCall(MarkersSpread(m, 1, F, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const StencilForm marker_form = {.stencils = 2, .parts = 2, .of = {{FIELD_U, 0}, {FIELD_V, 1}}};

PetscErrorCode MarkersCreate(Grid g, Layout l, const char kernel[], PetscBool folded, PetscInt points,
                             const PetscReal point[], Markers *out) {
  Markers m;
  const PetscInt slab = GridLocalU(g) + g->columns[FIELD_V] * g->rows[FIELD_V];
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->grid = g;
  m->layout = l;
  m->kernel = KernelFind(kernel);
  PetscCheck(m->kernel, g->comm, PETSC_ERR_USER_INPUT, "-delta_type %s: unknown kernel", kernel);
  m->points = points;
  m->point = point;
  const PetscInt n = 2 * MarkersCount(m);
  PetscCall(PetscCalloc4(n + 2 * LANES, &m->X, n, &m->plain, n, &m->force, n, &m->part));
  m->folded = m->scaled = folded && (g->wall[0] || g->wall[1]);
  m->least =
      folded ? KERNEL_FOLDED_CELLS
             : KERNEL_WALL_CELLS; /* within the kernels' reach the mobility with the near field may not be positive */
  m->needs = folded ? "0.25" : "3";
  m->stencil = m->plain;
  if (m->folded) PetscCall(PetscMalloc1(n, &m->stencil));
  PetscCall(StencilRowsCreate(g, &marker_form, 0, 1, &m->rows));
  PetscCall(MatCreateShell(g->comm, 2 * l->n, slab, 2 * l->M, PETSC_DETERMINE, m, &m->E));
  PetscCall(MatShellSetOperation(m->E, MATOP_MULT, (void (*)(void))Mult_E));
  PetscCall(MatShellSetOperation(m->E, MATOP_MULT_TRANSPOSE, (void (*)(void))MultTranspose_E));
  PetscCall(PetvesEvent("Spread", &m->spread));
  PetscCall(PetvesEvent("Interpolate", &m->interpolate));
  PetscCall(PetvesEvent("Respond", &m->respond));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void MarkersLeaveUnscaled(Markers m) {
  m->scaled = PETSC_FALSE;
}

PetscErrorCode MarkersDestroy(Markers *markers) {
  Markers m = *markers;
  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  if (m->folded) PetscCall(PetscFree(m->stencil));
  PetscCall(PetscFree4(m->X, m->plain, m->force, m->part));
  PetscCall(StencilRowsDestroy(&m->rows));
  PetscCall(MatDestroy(&m->E));
  PetscCall(PetscFree(*markers));
  PetscFunctionReturn(PETSC_SUCCESS);
}
