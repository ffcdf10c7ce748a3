/* The loops of stream.c over one row, of entries or of modes. */
#pragma once
#include "base/lanes.h"
#include "fluid/transforms/modefactors.h"

/* h times the curl of a force on the nodes of a row: v of the row, u of the rows below and above it. Where the last
   node is on a wall it is left out. */
static inline void StreamRowCurl(PetscInt n, PetscBool wall, const PetscScalar *restrict low,
                                 const PetscScalar *restrict high, const PetscScalar *restrict v,
                                 PetscScalar *restrict curl) {
  for (PetscInt i = 0; i + 1 < n; i++) curl[i] = v[i + 1] - v[i] + low[i] - high[i];
  if (!wall) curl[n - 1] = v[0] - v[n - 1] + low[n - 1] - high[n - 1];
}

static inline PetscReal StreamRowSum(PetscInt n, const PetscScalar x[]) {
  Lanes sum[2] = {{0}, {0}};
  PetscReal rest = 0;
  PetscInt i = 0;
  for (; i + 2 * LANES <= n; i += 2 * LANES) {
    sum[0] += LanesAt(x + i);
    sum[1] += LanesAt(x + i + LANES);
  }
  for (; i < n; i++) rest += x[i];
  return LanesSum(sum[0] + sum[1]) + rest;
}

/* One row upwards: y of the row from its modes b and y of the row below; y1 is updated. */
static inline void StreamRowUp(PetscInt width, const PetscReal *restrict r1, const PetscReal *restrict r2,
                               const PetscReal *restrict b, const PetscReal *restrict below, PetscReal *restrict y1,
                               PetscReal *restrict y) {
  for (PetscInt k = 0; k < width; k++) {
    y1[k] = b[k] + r1[k] * y1[k];
    y[k] = y1[k] + r2[k] * below[k];
  }
}

/* One row upwards for forces on the faces next to two walls: y += y2, where curl has the modes of the curl of a unit
   force at either wall; Y = (y1, y2) is updated. */
static inline void StreamRowUpWalls(const ModeFactors f, const PetscReal force[2], PetscReal *const curl[2],
                                    PetscReal *restrict Y, PetscReal *restrict y) {
  const PetscReal *restrict a = curl[0], *restrict b = curl[1], *restrict r1 = f->r[0], *restrict r2 = f->r[1];
  PetscReal *restrict y1 = Y, *restrict y2 = Y + f->width;
  for (PetscInt k = 0; k < f->width; k++) {
    y1[k] = force[0] * a[k] + force[1] * b[k] + r1[k] * y1[k];
    y2[k] = y1[k] + r2[k] * y2[k];
    y[k] += y2[k];
  }
}

/* One row downwards: `count` modes of chi/h, of which y is zero from mode `forced` on; Z = (z1, z2) is updated. */
static inline void StreamRowDown(const ModeFactors f, PetscInt forced, PetscInt count, const PetscReal *restrict y,
                                 PetscReal *restrict Z, PetscReal *restrict chi) {
  const PetscReal *restrict r1 = f->r[0], *restrict r2 = f->r[1], *restrict factor = f->factor;
  PetscReal *restrict z1 = Z, *restrict z2 = Z + f->width;
  for (PetscInt k = 0; k < forced; k++) {
    z1[k] = y[k] + r1[k] * z1[k];
    z2[k] = z1[k] + r2[k] * z2[k];
    chi[k] = factor[k] * z2[k];
  }
  for (PetscInt k = forced; k < count; k++) {
    z1[k] *= r1[k];
    z2[k] = z1[k] + r2[k] * z2[k];
    chi[k] = factor[k] * z2[k];
  }
}

/* u = d_y chi and v = -d_x chi with the mean flow, from chi/h. */
static inline void StreamRowU(PetscInt n, const PetscScalar *restrict low, const PetscScalar *restrict high,
                              PetscReal mean, PetscScalar *restrict u) {
  for (PetscInt i = 0; i < n; i++) u[i] = high[i] - low[i] + mean;
}
static inline void StreamRowV(PetscInt n, const PetscScalar *restrict chi, PetscReal mean, PetscScalar *restrict v) {
  v[0] = chi[n - 1] - chi[0] + mean;
  for (PetscInt i = 1; i < n; i++) v[i] = chi[i - 1] - chi[i] + mean;
}
