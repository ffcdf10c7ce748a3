/* A dipole's part has weights b_x b_y. In each run of faces its column of weights is summed first, which leaves one
   line of the table's numbers, then its row; of the parts the second sums make the answers to J_x and J_y. */
#include "coupling/dipolefaces.h"

enum { U_ROWS = 4, U_VECTORS = 2, V_ROWS = 5 };

/* From the first to the last face that is read in each row, a component's runs. */
static PetscErrorCode MakeRuns(PetscInt n, const PaddedStencil stencil[], int c, DipoleFaces *f) {
  PetscInt low[2] = {PETSC_MAX_INT, PETSC_MAX_INT}, high[2] = {PETSC_MIN_INT, PETSC_MIN_INT}, *end;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++)
    for (int dir = 0; dir < 2; dir++) {
      const PaddedStencil *s = &stencil[2 * k + c];
      low[dir] = PetscMin(low[dir], s->first[dir]);
      high[dir] = PetscMax(high[dir], s->first[dir] + s->n[dir]);
    }
  f->stride[c] = high[0] - low[0] + 2 * LANES;
  f->runs[c] = high[1] - low[1];
  PetscCall(PetscMalloc2(f->runs[c], &f->run[c], n, &f->at[c]));
  PetscCall(PetscCalloc1(f->runs[c], &end));
  for (PetscInt r = 0; r < f->runs[c]; r++) f->run[c][r] = (FaceRun){.row = low[1] + r, .first = high[0]};
  for (PetscInt k = 0; k < n; k++) {
    const PaddedStencil *s = &stencil[2 * k + c];
    const PetscInt row = s->first[1] - low[1];
    f->at[c][k] = row * f->stride[c] + s->first[0] - low[0];
    for (PetscInt r = row; r < row + s->n[1]; r++) {
      f->run[c][r].first = PetscMin(f->run[c][r].first, s->first[0]);
      end[r] = PetscMax(end[r], s->first[0] + s->n[0] - low[0]);
    }
  }
  for (PetscInt r = 0, line = 0; r < f->runs[c]; r++) {
    FaceRun *run = &f->run[c][r];
    run->at = r * f->stride[c] + run->first - low[0];
    run->vectors = PetscMax(0, (end[r] - (run->first - low[0]) + LANES - 1) / LANES);
    run->line = line;
    line += (run->vectors + 2) * LANES;
    f->vectors += run->vectors;
  }
  PetscCall(PetscFree(end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DipoleFacesCreate(PetscInt n, const PaddedStencil stencil[], DipoleFaces *f) {
  PetscInt room = 0, lines = 0;
  PetscFunctionBeginUser;
  *f = (DipoleFaces){.n = n};
  for (int c = 0; c < 2; c++) PetscCall(MakeRuns(n, stencil, c, f));
  for (int c = 0; c < 2; c++) {
    const FaceRun *last = &f->run[c][f->runs[c] - 1];
    room = PetscMax(room, (f->runs[c] + 1) * f->stride[c]);
    lines = PetscMax(lines, last->line + (last->vectors + 2) * LANES);
  }
  PetscCall(
      PetscMalloc4(DIPOLE_FACE_WEIGHTS * n, &f->weight, lines, &f->line[0], lines, &f->line[1], lines, &f->line[2]));
  PetscCall(PetscCalloc2(room, &f->field[0], room, &f->field[1])); /* beside the runs weights are zero */
  for (PetscInt k = 0; k < n; k++) {
    const PaddedStencil *u = &stencil[2 * k], *v = &stencil[2 * k + 1];
    Lanes *w = f->weight + DIPOLE_FACE_WEIGHTS * k;
    for (int r = 0; r < U_ROWS * U_VECTORS; r++)
      w[r] = u->weight[1][KERNEL_MAX_POINTS + r / U_VECTORS] *
             LanesAt(u->weight[0] + KERNEL_MAX_POINTS + r % U_VECTORS * LANES);
    for (int r = 0; r < V_ROWS; r++)
      w[U_ROWS * U_VECTORS + r] = v->weight[1][KERNEL_MAX_POINTS + r] * LanesAt(v->weight[0] + KERNEL_MAX_POINTS);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DipoleFacesDestroy(DipoleFaces *f) {
  PetscFunctionBeginUser;
  for (int c = 0; c < 2; c++) PetscCall(PetscFree2(f->run[c], f->at[c]));
  PetscCall(PetscFree4(f->weight, f->line[0], f->line[1], f->line[2]));
  PetscCall(PetscFree2(f->field[0], f->field[1]));
  *f = (DipoleFaces){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A part's columns of weights, `rows` each, summed for all runs, in so many vectors more than they have. */
static inline void SumColumns(const int rows, const int more, const DipoleFaces *f, int c, const OffsetTable *t,
                              int part, const PaddedStencil *s, const PetscInt cells[2]) {
  const PetscInt width = 2 * t->size[0] + 1, x = t->size[0] - s->first[0] - (s->n[0] - 1) + cells[0],
                 y = t->size[1] - s->first[1] + cells[1];
  Lanes b[KERNEL_MAX_POINTS];
  for (int j = 0; j < rows; j++) b[j] = s->weight[1][KERNEL_MAX_POINTS + j] + (Lanes){0};
  for (PetscInt r = 0; r < f->runs[c]; r++) {
    const FaceRun *run = &f->run[c][r];
    const PetscReal *at = t->value[part] + (run->row + y) * width + run->first + x;
    PetscReal *line = f->line[part] + run->line;
    const PetscInt end = run->vectors ? (run->vectors + more) * LANES : 0;
    for (PetscInt q = 0; q < end; q += LANES) {
      Lanes sum = b[0] * LanesAt(at + q);
      for (int j = 1; j < rows; j++) sum += b[j] * LanesAt(at + q - j * width);
      LanesPut(sum, line + q);
    }
  }
}

/* A part's row of weights times a factor, turned. */
static inline void Turned(const int n, PetscReal factor, const PaddedStencil *s, Lanes w[KERNEL_MAX_POINTS]) {
  for (int k = 0; k < n; k++) w[k] = factor * s->weight[0][KERNEL_MAX_POINTS + n - 1 - k] + (Lanes){0};
}

/* The answer to J along one direction: of a part with n points along x and of xy, which has five. */
static inline void SumRows(const int n, const DipoleFaces *f, int c, int J, const PaddedStencil dipole[DIPOLE_COUNT],
                           const PetscReal N[2], PetscReal scale) {
  const int part = J ? DIPOLE_YY : DIPOLE_XX;
  PetscReal *field = f->field[J];
  Lanes a[KERNEL_MAX_POINTS], b[KERNEL_MAX_POINTS];
  Turned(n, 2 * scale * N[J], &dipole[part], a);
  Turned(5, scale * N[1 - J], &dipole[DIPOLE_XY], b);
  for (PetscInt r = 0; r < f->runs[c]; r++) {
    const FaceRun *run = &f->run[c][r];
    const PetscReal *own = f->line[part] + run->line, *xy = f->line[DIPOLE_XY] + run->line;
    PetscReal *to = field + run->at;
    const PetscInt end = run->vectors * LANES;
    for (PetscInt q = 0; q < end; q += LANES) {
      Lanes sum = a[0] * LanesAt(own + q), other = b[0] * LanesAt(xy + q);
      for (int k = 1; k < n; k++) sum += a[k] * LanesAt(own + q + k);
      for (int k = 1; k < 5; k++) other += b[k] * LanesAt(xy + q + k);
      LanesPut(sum + other, to + q);
    }
  }
}

/* Both of a component. */
static void MakeFields(const DipoleFaces *f, int c, const OffsetTable *t, const PaddedStencil dipole[DIPOLE_COUNT],
                       const PetscInt cells[2], const PetscReal N[2], PetscReal scale) {
  SumColumns(4, 2, f, c, t, DIPOLE_XX, &dipole[DIPOLE_XX], cells);
  SumColumns(6, 1, f, c, t, DIPOLE_YY, &dipole[DIPOLE_YY], cells);
  SumColumns(5, 1, f, c, t, DIPOLE_XY, &dipole[DIPOLE_XY], cells);
  SumRows(6, f, c, 0, dipole, N, scale);
  SumRows(4, f, c, 1, dipole, N, scale);
}

/* What a marker reads of both fields, of rows of so many vectors. */
static inline void Read(const int rows, const int vectors, const DipoleFaces *f, int c, PetscInt k, const Lanes w[],
                        Lanes sum[2]) {
  const PetscInt stride = f->stride[c];
  for (int J = 0; J < 2; J++) {
    const PetscReal *at = f->field[J] + f->at[c][k];
    sum[J] = (Lanes){0};
    for (int r = 0; r < rows * vectors; r++) sum[J] += w[r] * LanesAt(at + r / vectors * stride + r % vectors * LANES);
  }
}

void DipoleFacesAnswer(const DipoleFaces *f, const OffsetTable lattice[2], const PaddedStencil dipole[DIPOLE_COUNT],
                       const PetscInt cells[2], const PetscReal N[2], PetscReal scale, PetscReal *const free[4]) {
  for (int c = 0; c < 2; c++) {
    MakeFields(f, c, &lattice[c], dipole, cells, N, scale);
    for (PetscInt k = 0; k < f->n; k++) {
      const Lanes *w = f->weight + DIPOLE_FACE_WEIGHTS * k;
      Lanes sum[2];
      if (c)
        Read(V_ROWS, 1, f, c, k, w + U_ROWS * U_VECTORS, sum);
      else
        Read(U_ROWS, U_VECTORS, f, c, k, w, sum);
      LanesTwoSums(sum[0], sum[1], &free[c][k], &free[2 + c][k]);
    }
  }
}
