/* A dipole's part has weights b_x b_y. In each run of faces its column of weights is summed first, which leaves one
   line of the table's numbers, then its row; of the parts the second sums make the answers to J_x and J_y. */
#include "layers/dipolefaces.h"

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

/* A part's column of weights, and where its table has the entry that the first of them takes at a face (0, 0). */
static inline const PetscReal *Column(const int n, const OffsetTable *t, int part, const PaddedStencil *s,
                                      const PetscInt cells[2], Lanes w[KERNEL_MAX_POINTS]) {
  const PetscInt width = 2 * t->size[0] + 1, x = t->size[0] - s->first[0] - (s->n[0] - 1) + cells[0],
                 y = t->size[1] - s->first[1] + cells[1];
  for (int j = 0; j < n; j++) w[j] = s->weight[1][KERNEL_MAX_POINTS + j] + (Lanes){0};
  return t->value[part] + y * width + x;
}

/* So many numbers of a line: SUM w_j at[-j width]. */
static inline void ColumnSums(const int n, const Lanes w[], PetscInt width, const PetscReal *at, PetscInt count,
                              PetscReal *line) {
  for (PetscInt q = 0; q < count; q += LANES) {
    Lanes sum = w[0] * LanesAt(at + q);
    for (int j = 1; j < n; j++) sum += w[j] * LanesAt(at + q - j * width);
    LanesPut(sum, line + q);
  }
}

/* All runs' lines, with as much behind them as their rows of weights are long. */
static void SumColumns(const DipoleFaces *f, int c, const OffsetTable *t, const PaddedStencil dipole[DIPOLE_COUNT],
                       const PetscInt cells[2]) {
  const PetscInt width = 2 * t->size[0] + 1, runs = f->runs[c];
  PetscReal *const lx = f->line[DIPOLE_XX], *const ly = f->line[DIPOLE_YY], *const lxy = f->line[DIPOLE_XY];
  Lanes xx[KERNEL_MAX_POINTS], yy[KERNEL_MAX_POINTS], xy[KERNEL_MAX_POINTS];
  const PetscReal *tx = Column(4, t, DIPOLE_XX, &dipole[DIPOLE_XX], cells, xx);
  const PetscReal *ty = Column(6, t, DIPOLE_YY, &dipole[DIPOLE_YY], cells, yy);
  const PetscReal *txy = Column(5, t, DIPOLE_XY, &dipole[DIPOLE_XY], cells, xy);
  for (const FaceRun *run = f->run[c]; run < f->run[c] + runs; run++) {
    const PetscInt at = run->row * width + run->first, line = run->line, count = (run->vectors + 1) * LANES;
    if (!run->vectors) continue;
    ColumnSums(4, xx, width, tx + at, count + LANES, lx + line);
    ColumnSums(6, yy, width, ty + at, count, ly + line);
    ColumnSums(5, xy, width, txy + at, count, lxy + line);
  }
}

/* A part's row of weights times a factor, turned. */
static inline void Turned(const int n, PetscReal factor, const PaddedStencil *s, Lanes w[KERNEL_MAX_POINTS]) {
  for (int k = 0; k < n; k++) w[k] = factor * s->weight[0][KERNEL_MAX_POINTS + n - 1 - k] + (Lanes){0};
}

/* SUM w_k line[k] of a row of n weights. */
static inline Lanes RowSum(const int n, const Lanes w[], const PetscReal *line) {
  Lanes sum = w[0] * LanesAt(line);
  for (int k = 1; k < n; k++) sum += w[k] * LanesAt(line + k);
  return sum;
}

/* The answers to J_x and J_y, which share xy's sums. */
static void SumRows(const DipoleFaces *f, int c, const PaddedStencil dipole[DIPOLE_COUNT], const PetscReal N[2],
                    PetscReal scale) {
  Lanes xx[KERNEL_MAX_POINTS], yy[KERNEL_MAX_POINTS], xy[KERNEL_MAX_POINTS];
  Turned(6, 2 * scale * N[0], &dipole[DIPOLE_XX], xx);
  Turned(4, 2 * scale * N[1], &dipole[DIPOLE_YY], yy);
  Turned(5, scale, &dipole[DIPOLE_XY], xy);
  const PetscReal *const lx = f->line[DIPOLE_XX], *const ly = f->line[DIPOLE_YY], *const lxy = f->line[DIPOLE_XY];
  const PetscInt runs = f->runs[c];
  for (const FaceRun *run = f->run[c]; run < f->run[c] + runs; run++) {
    const PetscInt end = run->line + run->vectors * LANES;
    PetscReal *x = f->field[0] + run->at, *y = f->field[1] + run->at;
    for (PetscInt q = run->line; q < end; q += LANES, x += LANES, y += LANES) {
      const Lanes both = RowSum(5, xy, lxy + q);
      LanesPut(RowSum(6, xx, lx + q) + N[1] * both, x);
      LanesPut(RowSum(4, yy, ly + q) + N[0] * both, y);
    }
  }
}

/* What a marker reads of both fields, of rows of so many vectors. */
static inline void Read(const int rows, const int vectors, const DipoleFaces *f, int c, PetscInt k, const Lanes w[],
                        Lanes sum[2]) {
  const PetscInt stride = f->stride[c];
  const PetscReal *x = f->field[0] + f->at[c][k], *y = f->field[1] + f->at[c][k];
  sum[0] = sum[1] = (Lanes){0};
  for (int r = 0; r < rows * vectors; r++) {
    const PetscInt at = r / vectors * stride + r % vectors * LANES;
    const Lanes weight = w[r];
    sum[0] += weight * LanesAt(x + at);
    sum[1] += weight * LanesAt(y + at);
  }
}

void DipoleFacesAnswer(const DipoleFaces *f, const OffsetTable lattice[2], const PaddedStencil dipole[DIPOLE_COUNT],
                       const PetscInt cells[2], const PetscReal N[2], PetscReal scale, PetscReal *const free[4]) {
  for (int c = 0; c < 2; c++) {
    SumColumns(f, c, &lattice[c], dipole, cells);
    SumRows(f, c, dipole, N, scale);
    for (PetscInt k = 0; k < f->n; k++) {
      const Lanes *w = f->weight + DIPOLE_FACE_WEIGHTS * k;
      Lanes sum[2];
      if (c)
        Read(V_ROWS, 1, f, c, k, w + U_ROWS * U_VECTORS, sum);
      else
        Read(U_ROWS, U_VECTORS, f, c, k, w, sum);
      LanesTwoSums(sum[0], sum[1], &free[c ? 3 : 0][k], &free[c ? 1 : 2][k]);
    }
  }
}
