/* The operators G, G^T and H on local arrays, row by row, and their MatShells. */
#include "fluid/grid/grid.h"

PetscErrorCode GridGradient(Grid g, PetscReal alpha, Vec p, PetscBool add, Vec w) {
  const PetscReal c = alpha / g->h;
  const PetscInt n = g->columns[FIELD_P], nu = g->columns[FIELD_U];
  const PetscScalar *pa;
  PetscScalar *wa, *va;
  Rows rows;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(p, &pa));
  PetscCall(VecGetArray(w, &wa));
  va = wa + GridLocalU(g);
  PetscCall(GridRows(g, FIELD_P, pa, &rows));
  for (PetscInt j = 0; j < g->rows[FIELD_P]; j++) {
    const PetscScalar *here = RowAt(&rows, j), *up = RowAt(&rows, j + 1);
    PetscScalar *u = wa + j * nu, *v = va + j * n;
    if (!add) {
      PetscCall(PetscArrayzero(u, nu));
      if (j < g->rows[FIELD_V]) PetscCall(PetscArrayzero(v, n));
    }
    for (PetscInt i = 0; i < n - 1; i++) u[i] += c * (here[i + 1] - here[i]);
    if (nu == n) u[n - 1] += c * (here[0] - here[n - 1]);
    if (j < g->rows[FIELD_V])
      for (PetscInt i = 0; i < n; i++) v[i] += c * (up[i] - here[i]);
  }
  PetscCall(VecRestoreArray(w, &wa));
  PetscCall(VecRestoreArrayRead(p, &pa));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridGradientTranspose(Grid g, PetscReal alpha, Vec w, Vec q) {
  const PetscReal c = alpha / g->h;
  const PetscInt n = g->columns[FIELD_P], nu = g->columns[FIELD_U];
  const PetscScalar *wa;
  PetscScalar *qa;
  Rows rows;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(w, &wa));
  PetscCall(VecGetArray(q, &qa));
  PetscCall(GridRows(g, FIELD_V, wa + GridLocalU(g), &rows));
  for (PetscInt j = 0; j < g->rows[FIELD_P]; j++) {
    const PetscScalar *u = wa + j * nu, *down = RowAt(&rows, j - 1), *up = RowAt(&rows, j);
    const PetscScalar seam = nu == n ? u[n - 1] : 0;
    PetscScalar *out = qa + j * n;
    out[0] = c * (seam - u[0] + down[0] - up[0]);
    for (PetscInt i = 1; i < n - 1; i++) out[i] = c * (u[i - 1] - u[i] + down[i] - up[i]);
    out[n - 1] = c * (u[n - 2] - seam + down[n - 1] - up[n - 1]);
  }
  PetscCall(VecRestoreArray(q, &qa));
  PetscCall(VecRestoreArrayRead(w, &wa));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridLargestDivergence(Grid g, Vec w, Vec bc2, PetscReal *largest) {
  PetscScalar sum;
  Vec q;
  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalVector(g->da[FIELD_P], &q));
  PetscCall(GridGradientTranspose(g, 1, w, q));
  if (bc2) PetscCall(VecAXPY(q, 1, bc2));
  PetscCall(VecNorm(q, NORM_INFINITY, largest));
  PetscCall(VecSum(q, &sum));
  if (PetscIsInfOrNanReal(sum)) *largest = NAN; /* a NaN may get lost in a maximum */
  PetscCall(DMRestoreGlobalVector(g->da[FIELD_P], &q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What of n rows or columns is in a window. */
static inline PetscInt Clip(const PetscInt window[2], PetscInt n, PetscInt *first) {
  const PetscInt end = PetscMin(window[1], n);
  *first = PetscMin(window[0], end);
  return end - *first;
}

PetscErrorCode GridClear(Grid g, const GridWindow *window, Vec w) {
  const PetscInt start[3] = {0, GridLocalU(g), 0};
  PetscScalar *a;
  PetscInt size, row, column;
  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(w, &size));
  PetscCall(VecGetArray(w, &a));
  const PetscBool pressure = size == g->columns[FIELD_P] * g->rows[FIELD_P];
  for (int f = pressure ? FIELD_P : FIELD_U; f <= (pressure ? FIELD_P : FIELD_V); f++) {
    const PetscInt rows = Clip(window->rows, g->rows[f], &row), n = Clip(window->columns, g->columns[f], &column);
    for (PetscInt j = row; j < row + rows; j++) PetscCall(PetscArrayzero(a + start[f] + j * g->columns[f] + column, n));
  }
  PetscCall(VecRestoreArray(w, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row by row; a missing neighbour in x is `factor` times the entry itself, or the row's other end where x is periodic.
 */
PetscErrorCode GridHelmholtzField(Grid g, Field f, PetscReal a0, PetscReal nu, const PetscScalar w[], PetscScalar y[]) {
  const PetscReal off = nu / PetscSqr(g->h), diagonal = a0 + 4 * off, factor = GridWallFactor(f, 0);
  const PetscInt n = g->columns[f];
  Rows rows;
  PetscFunctionBeginUser;
  PetscCall(GridRows(g, f, w, &rows));
  for (PetscInt j = 0; j < g->rows[f]; j++) {
    const PetscScalar *down = RowAt(&rows, j - 1), *here = RowAt(&rows, j), *up = RowAt(&rows, j + 1);
    const PetscScalar left = g->wall[0] ? factor * here[0] : here[n - 1];
    const PetscScalar right = g->wall[0] ? factor * here[n - 1] : here[0];
    PetscScalar *out = y + j * n;
    out[0] = diagonal * here[0] - off * (left + here[1] + down[0] + up[0]);
    for (PetscInt i = 1; i < n - 1; i++)
      out[i] = diagonal * here[i] - off * (here[i - 1] + here[i + 1] + down[i] + up[i]);
    out[n - 1] = diagonal * here[n - 1] - off * (here[n - 2] + right + down[n - 1] + up[n - 1]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridHelmholtz(Grid g, PetscReal a0, PetscReal nu, Vec w, Vec y) {
  const PetscInt v = GridLocalU(g);
  const PetscScalar *wa;
  PetscScalar *ya;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(w, &wa));
  PetscCall(VecGetArray(y, &ya));
  PetscCall(GridHelmholtzField(g, FIELD_U, a0, nu, wa, ya));
  PetscCall(GridHelmholtzField(g, FIELD_V, a0, nu, wa + v, ya + v));
  PetscCall(VecRestoreArray(y, &ya));
  PetscCall(VecRestoreArrayRead(w, &wa));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MultG(Mat A, Vec p, Vec w) {
  Grid g;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &g));
  PetscCall(GridGradient(g, 1, p, PETSC_FALSE, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MultTransposeG(Mat A, Vec w, Vec q) {
  Grid g;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &g));
  PetscCall(GridGradientTranspose(g, 1, w, q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StencilCreateShell(Grid g, PetscBool transpose, Mat *A) {
  const PetscInt n_p = g->columns[FIELD_P] * g->rows[FIELD_P];
  const PetscInt n_w = GridLocalU(g) + g->columns[FIELD_V] * g->rows[FIELD_V];
  const MatOperation mult = transpose ? MATOP_MULT_TRANSPOSE : MATOP_MULT;
  const MatOperation other = transpose ? MATOP_MULT : MATOP_MULT_TRANSPOSE;
  PetscFunctionBeginUser;
  PetscCall(
      MatCreateShell(g->comm, transpose ? n_p : n_w, transpose ? n_w : n_p, PETSC_DETERMINE, PETSC_DETERMINE, g, A));
  PetscCall(MatShellSetOperation(*A, mult, (void (*)(void))MultG));
  PetscCall(MatShellSetOperation(*A, other, (void (*)(void))MultTransposeG));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridCreateG(Grid g, Mat *G) {
  return StencilCreateShell(g, PETSC_FALSE, G);
}

PetscErrorCode GridCreateD(Grid g, Mat *D) {
  PetscFunctionBeginUser;
  PetscCall(StencilCreateShell(g, PETSC_TRUE, D));
  PetscCall(MatScale(*D, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridAssemble(Grid g, Field f, PetscReal a0, PetscReal nu, Mat *A) {
  const PetscInt n = g->columns[f], rows = g->rows[f], all = g->all_rows[f];
  const PetscReal off = nu / PetscSqr(g->h);
  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(g->comm, n * rows, n * rows, PETSC_DETERMINE, PETSC_DETERMINE, 5, NULL, 2, NULL, A));
  for (PetscInt j = g->first; j < g->first + rows; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscInt row = j * n + i, di[4] = {-1, 1, 0, 0}, dj[4] = {0, 0, -1, 1};
      PetscReal diagonal = a0 + 4 * off;
      for (int k = 0; k < 4; k++) {
        const int dir = k / 2;
        PetscInt c = i + di[k], r = j + dj[k];
        const PetscBool outside = c < 0 || c >= n || r < 0 || r >= all;
        if (outside && g->wall[dir]) {
          diagonal -= off * GridWallFactor(f, dir);
          continue;
        }
        c = (c + n) % n;
        r = (r + all) % all;
        PetscCall(MatSetValue(*A, row, r * n + c, -off, ADD_VALUES));
      }
      PetscCall(MatSetValue(*A, row, row, diagonal, ADD_VALUES));
    }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}
