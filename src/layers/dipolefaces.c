#include "layers/dipolefaces.h"

PetscErrorCode DipoleFacesCreate(PetscInt n, const PaddedStencil stencil[], DipoleFaces *f) {
  PetscInt room = 0;
  PetscFunctionBeginUser;
  *f = (DipoleFaces){.n = n, .stencil = stencil};
  for (int c = 0; c < 2; c++) {
    PetscInt *low = f->first[c], high[2] = {PETSC_MIN_INT, PETSC_MIN_INT};
    low[0] = low[1] = PETSC_MAX_INT;
    for (PetscInt k = 0; k < 2 * n; k++) {
      const PaddedStencil *s = &stencil[k - k % 2 + c];
      low[k % 2] = PetscMin(low[k % 2], s->first[k % 2]);
      high[k % 2] = PetscMax(high[k % 2], s->first[k % 2] + s->n[k % 2]);
    }
    f->rows[c] = high[1] - low[1];
    f->columns[c] = (high[0] - low[0] + LANES - 1) / LANES * LANES;
    f->stride[c] = f->columns[c] + LANES;
    room = PetscMax(room, f->stride[c] * (f->rows[c] + 1));
  }
  PetscCall(PetscCalloc2(room, &f->field[0], room, &f->field[1])); /* behind the last face weights are zero */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DipoleFacesDestroy(DipoleFaces *f) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(f->field[0], f->field[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a unit part gives on `count` faces from `face` on along x, whole vectors: its column of weights is summed first,
   which leaves one line of the table's numbers, then its row. */
static inline void PartRow(const int part, const OffsetTable *t, const PaddedStencil dipole[DIPOLE_COUNT],
                           const PetscInt face[2], PetscInt count, PetscReal sum[]) {
  const int nx = part == DIPOLE_XX ? 6 : part == DIPOLE_YY ? 4 : 5, ny = 10 - nx;
  const PaddedStencil *s = &dipole[part];
  const PetscInt width = 2 * t->size[0] + 1, x = t->size[0] + face[0] - s->first[0] - (nx - 1),
                 y = t->size[1] + face[1] - s->first[1];
  const PetscReal *at = t->value[part] + y * width + x, *wx = s->weight[0] + KERNEL_MAX_POINTS,
                  *wy = s->weight[1] + KERNEL_MAX_POINTS;
  PetscReal line[STENCIL_ROW + 2 * LANES];
  for (PetscInt q = 0; q < count + (nx + LANES - 2) / LANES * LANES; q += LANES) {
    Lanes all = wy[0] * LanesAt(at + q);
    for (int j = 1; j < ny; j++) all += wy[j] * LanesAt(at + q - j * width);
    LanesPut(all, line + q);
  }
  for (PetscInt q = 0; q < count; q += LANES) {
    Lanes all = wx[nx - 1] * LanesAt(line + q);
    for (int k = 1; k < nx; k++) all += wx[nx - 1 - k] * LanesAt(line + q + k);
    LanesPut(all, sum + q);
  }
}

/* The answers to J_x and J_y on a component's faces, which share the part xy. */
static void DipoleFacesFill(const DipoleFaces *f, int c, const OffsetTable *t, const PaddedStencil dipole[DIPOLE_COUNT],
                            const PetscInt cells[2], const PetscReal N[2]) {
  PetscReal xx[STENCIL_ROW], yy[STENCIL_ROW], xy[STENCIL_ROW];
  for (PetscInt r = 0; r < f->rows[c]; r++) {
    const PetscInt face[2] = {f->first[c][0] + cells[0], f->first[c][1] + cells[1] + r}, at = r * f->stride[c];
    PartRow(DIPOLE_XX, t, dipole, face, f->columns[c], xx);
    PartRow(DIPOLE_YY, t, dipole, face, f->columns[c], yy);
    PartRow(DIPOLE_XY, t, dipole, face, f->columns[c], xy);
    for (PetscInt i = 0; i < f->columns[c]; i += LANES) {
      LanesPut(2 * N[0] * LanesAt(xx + i) + N[1] * LanesAt(xy + i), f->field[0] + at + i);
      LanesPut(2 * N[1] * LanesAt(yy + i) + N[0] * LanesAt(xy + i), f->field[1] + at + i);
    }
  }
}

void DipoleFacesAnswer(const DipoleFaces *f, const OffsetTable lattice[2], const PaddedStencil dipole[DIPOLE_COUNT],
                       const PetscInt cells[2], const PetscReal N[2], PetscReal scale, PetscReal *const free[4]) {
  for (int c = 0; c < 2; c++) {
    DipoleFacesFill(f, c, &lattice[c], dipole, cells, (PetscReal[]){scale * N[0], scale * N[1]});
    for (PetscInt k = 0; k < f->n; k++) {
      const PaddedStencil *s = &f->stencil[2 * k + c];
      const PetscReal *wx = s->weight[0] + KERNEL_MAX_POINTS, *wy = s->weight[1] + KERNEL_MAX_POINTS;
      PetscInt at = (s->first[1] - f->first[c][1]) * f->stride[c] + s->first[0] - f->first[c][0];
      Lanes sum[2] = {{0}, {0}};
      for (PetscInt j = 0; j < s->n[1]; j++, at += f->stride[c])
        for (int q = 0; q < 2; q++)
          sum[q] += wy[j] *
                    (LanesAt(wx) * LanesAt(f->field[q] + at) + LanesAt(wx + LANES) * LanesAt(f->field[q] + at + LANES));
      free[c ? 3 : 0][k] = LanesSum(sum[0]);
      free[c ? 1 : 2][k] = LanesSum(sum[1]);
    }
  }
}
