/* The loops of stream.c over one row, of entries or of modes. */
#pragma once
#include "base/lanes.h"

/* h times the curl of a force on the nodes of a row: v of the row, u of the rows below and above it. Where the last
   node is on a wall it is left out. */
static inline void Curl(PetscInt n, PetscBool wall, const PetscScalar *restrict low, const PetscScalar *restrict high,
                        const PetscScalar *restrict v, PetscScalar *restrict curl) {
  for (PetscInt i = 0; i + 1 < n; i++) curl[i] = v[i + 1] - v[i] + low[i] - high[i];
  if (!wall) curl[n - 1] = v[0] - v[n - 1] + low[n - 1] - high[n - 1];
}

static inline PetscReal Sum(PetscInt n, const PetscScalar x[]) {
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
static inline void Up(PetscInt width, const PetscReal *restrict r1, const PetscReal *restrict r2,
                      const PetscReal *restrict b, const PetscReal *restrict below, PetscReal *restrict y1,
                      PetscReal *restrict y) {
  for (PetscInt k = 0; k < width; k++) {
    y1[k] = b[k] + r1[k] * y1[k];
    y[k] = y1[k] + r2[k] * below[k];
  }
}

/* One row upwards for forces on the faces next to two walls: y += y2, where a and b are the modes of the curl of a unit
   force at either wall; y1 and y2 are updated. */
static inline void UpWalls(PetscInt width, const PetscReal *restrict r1, const PetscReal *restrict r2,
                           const PetscReal force[2], const PetscReal *restrict a, const PetscReal *restrict b,
                           PetscReal *restrict y1, PetscReal *restrict y2, PetscReal *restrict y) {
  for (PetscInt k = 0; k < width; k++) {
    y1[k] = force[0] * a[k] + force[1] * b[k] + r1[k] * y1[k];
    y2[k] = y1[k] + r2[k] * y2[k];
    y[k] += y2[k];
  }
}

/* One row downwards: the modes of chi; z1 and z2 are updated. DownFree - for the modes in which y is zero. */
static inline void Down(PetscInt width, const PetscReal *restrict r1, const PetscReal *restrict r2,
                        const PetscReal *restrict factor, const PetscReal *restrict y, PetscReal *restrict z1,
                        PetscReal *restrict z2, PetscReal *restrict chi) {
  for (PetscInt k = 0; k < width; k++) {
    z1[k] = y[k] + r1[k] * z1[k];
    z2[k] = z1[k] + r2[k] * z2[k];
    chi[k] = factor[k] * z2[k];
  }
}
static inline void DownFree(PetscInt from, PetscInt width, const PetscReal *restrict r1, const PetscReal *restrict r2,
                            const PetscReal *restrict factor, PetscReal *restrict z1, PetscReal *restrict z2,
                            PetscReal *restrict chi) {
  for (PetscInt k = from; k < width; k++) {
    z1[k] *= r1[k];
    z2[k] = z1[k] + r2[k] * z2[k];
    chi[k] = factor[k] * z2[k];
  }
}

/* u = d_y chi and v = -d_x chi with the mean flow, from chi/h. */
static inline void VelocityU(PetscInt n, const PetscScalar *restrict low, const PetscScalar *restrict high,
                             PetscReal mean, PetscScalar *restrict u) {
  for (PetscInt i = 0; i < n; i++) u[i] = high[i] - low[i] + mean;
}
static inline void VelocityV(PetscInt n, const PetscScalar *restrict chi, PetscReal mean, PetscScalar *restrict v) {
  v[0] = chi[n - 1] - chi[0] + mean;
  for (PetscInt i = 1; i < n; i++) v[i] = chi[i - 1] - chi[i] + mean;
}
