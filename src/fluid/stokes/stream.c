/* With the decays r1 of -(d_xx + d_yy) and r2 of alpha - nu (d_xx + d_yy) from row to row (tridiagonal.h) and S the
   shift by one row, each Fourier mode of the stream function has

       (nu/(r1 r2 h^4)) (1 - r1 S)(1 - r2 S)(1 - r1 S^-1)(1 - r2 S^-1) chi = curl of the force,

   the recurrences of modefactors.h upwards and downwards, chi = (r1 r2 h^4/nu) z2. */
#include "fluid/stokes/stream.h"
#include "fluid/stokes/streamloops.h"

PetscErrorCode StreamCreate(Fluid f, Stream *out) {
  const Grid g = f->grid;
  const size_t n = (size_t)g->n[0];
  Stream s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->fluid = f;
  PetscCall(RowTransformCreate(g, g->wall[0] ? FIELD_U : FIELD_P, &s->t));
  PetscCall(RowTransformSort(s->t)); /* slow decays come first */
  s->alpha = s->profile_alpha = -1;
  if (f->zero_flux && !g->wall[0] && g->wall[1]) PetscCall(PetscMalloc1(2 * g->n[1], &s->profile));
  PetscCall(
      ModeFactorsCreate(g, FIELD_V, s->t->width, s->t->lambda, s->t->scale, &s->factors)); /* nodes are level with v */
  PetscCall(SlabsCreate(s->factors, &s->slabs));
  PetscCall(PetscCalloc2(g->rows[FIELD_U], &s->means, s->slabs->width / MODE_BLOCK, &s->last));
  for (int k = 0; k < 5; k++) {
    PetscScalar **line[] = {&s->row[0], &s->row[1], &s->row[2], &s->curl, &s->zero};
    *line[k] = fftw_alloc_real(n);
    PetscCall(PetscArrayzero(*line[k], (PetscInt)n));
  }
  if (g->wall[0]) PetscCall(SideWallsCreate(g, s->t, s->factors, &s->side));
  s->one[1] = 1 / (PetscReal)n;
  if (!g->wall[0]) PetscCall(TridiagonalCreate(g, FIELD_U, 1, &s->one[0], &s->one[1], &s->mean));
  PetscCall(StreamMeterCreate(g, s->t, &s->meter));
  PetscCall(StreamFlowsCreate(g, s->t, s->slabs->width, &s->flows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamDestroy(Stream *stream) {
  Stream s = *stream;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TridiagonalDestroy(&s->mean));
  PetscCall(SideWallsDestroy(&s->side));
  for (int k = 0; k < 3; k++) fftw_free(s->row[k]);
  fftw_free(s->curl);
  fftw_free(s->zero);
  PetscCall(PetscFree(s->profile));
  PetscCall(PetscFree2(s->means, s->last));
  PetscCall(StreamFlowsDestroy(&s->flows));
  PetscCall(StreamMeterDestroy(&s->meter));
  PetscCall(SlabsDestroy(&s->slabs));
  PetscCall(ModeFactorsDestroy(&s->factors));
  PetscCall(RowTransformDestroy(&s->t));
  PetscCall(PetscFree(*stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define NEGLIGIBLE 50. /* a mode that has decayed by e^-50 = 2e-22 is zero to rounding */

/* Walls, on which chi = 0, and chi is even: chi_{-1} = 0 and chi_{-2} = chi_0. Put into the recurrences,
       y1_{-1} = -r1 z1_0 - r2 (2 + r1 r2) z2_0,   y2_{-1} = -r1 z1_0 - r2 z2_0,
       z1_n = -r2/(1 + r1 r2) y2_{n-1},            z2_n = 0. */
static PetscErrorCode StreamSetUp(Stream s) {
  const ModeFactors factors = s->factors;
  const Fluid f = s->fluid;
  const PetscReal h2 = PetscSqr(f->grid->h), nu = f->nu;
  PetscFunctionBeginUser;
  PetscCall(SlabsReserve(s->slabs));
  if (s->mean) PetscCall(SlabsReserve(s->mean->slabs));
  if (s->alpha == f->alpha) PetscFunctionReturn(PETSC_SUCCESS);
  s->alpha = f->alpha;
  for (PetscInt k = s->side ? 0 : 2; k < factors->modes; k++) { /* where x is periodic mode 0 is the mean flow */
    const PetscReal theta[2] = {ModeTheta(factors->lambda[k]), ModeTheta(factors->lambda[k] + f->alpha * h2 / nu)};
    const PetscReal r1 = PetscExpReal(-theta[0]), r2 = PetscExpReal(-theta[1]);
    ModeFactorsSet(factors, k, theta, factors->scale[k] * r1 * r2 * h2 / nu,
                   (ModePair){{{-r1, -r2 * (2 + r1 * r2)}, {-r1, -r2}}},
                   (ModePair){{{0, -r2 / (1 + r1 * r2)}, {0, 0}}});
  }
  ModeFactorsReach(factors, NEGLIGIBLE, f->grid->n[1]); /* r1 is the slower decay */
  if (s->side) PetscCall(SideWallsSet(s->side, f->alpha, f->nu));
  if (s->mean) PetscCall(TridiagonalSetCoefficients(s->mean, f->alpha, f->nu, f->solver[FIELD_U]->singular));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (alpha - nu d_yy) b = 1 with b reflected in the walls to minus itself, by elimination. */
const PetscReal *StreamProfile(Stream s) {
  const PetscInt n = s->fluid->grid->n[1];
  const PetscReal alpha = s->fluid->alpha, off = -s->fluid->nu / PetscSqr(s->fluid->grid->h);
  PetscReal *b = s->profile, mean = 0;
  if (!b || s->profile_alpha == alpha) return b;
  PetscReal *c = b + n;
  s->profile_alpha = alpha;
  for (PetscInt j = 0; j < n; j++) {
    const PetscReal diagonal = alpha - off * (j == 0 || j == n - 1 ? 3 : 2);
    const PetscReal pivot = diagonal - (j ? off * c[j - 1] : 0);
    c[j] = off / pivot;
    b[j] = (1 - (j ? off * b[j - 1] : 0)) / pivot;
  }
  for (PetscInt j = n - 2; j >= 0; j--) b[j] -= c[j] * b[j + 1];
  for (PetscInt j = 0; j < n; j++) mean += b[j] / n;
  for (PetscInt j = 0; j < n; j++) b[j] /= mean;
  return b;
}

/* Mode 0: the row means of u, and v's, which is the same everywhere, from the sum of its force. Where the mean flow is
   held at zero its mean is taken off u, evenly or, in a channel, as the profile has it. */
static PetscErrorCode MeanFlow(Stream s, PetscReal sum) {
  const Grid g = s->fluid->grid;
  const PetscReal *profile = StreamProfile(s);
  PetscReal mean = 0;
  PetscFunctionBeginUser;
  PetscCall(TridiagonalEnd(s->mean));
  for (PetscInt j = g->rows[FIELD_U] - 1; j >= 0; j--) TridiagonalDown(s->mean, j, &s->means[j]);
  if (profile || s->fluid->held) {
    for (PetscInt j = 0; j < g->rows[FIELD_U]; j++) mean += s->means[j] / g->n[1];
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mean, 1, MPIU_REAL, MPI_SUM, g->comm));
    for (PetscInt j = 0; j < g->rows[FIELD_U]; j++) s->means[j] -= mean * (profile ? profile[g->first + j] : 1);
    sum = 0;
  }
  s->mean_v = s->fluid->alpha > 0 ? sum / ((PetscReal)g->n[0] * g->n[1] * s->fluid->alpha) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* v on the faces next to walls in x, in all own rows. */
static void SideVelocity(Stream s, const StreamRows *rows) {
  const PetscInt first = s->fluid->grid->first;
  StreamBeginDown(s);
  for (PetscInt j = s->slabs->rows - 1; j >= 0; j--) {
    PetscReal *chi;
    const PetscInt count = StreamNodeModes(s, j, PETSC_FALSE, NULL, &chi);
    for (int side = 0; side < 2; side++)
      s->side->v[side][first + j] = LanesDot(count, s->side->velocity[side], chi) +
                                    StreamGiven(rows, FIELD_V, first + j);
  }
}

/* y += that of the forces on these faces, with nothing coming in from below; `state` as after Gather. */
static void AddSideForces(Stream s, PetscBool measured) {
  const Slabs q = s->slabs;
  const SideWalls side = s->side;
  const PetscInt w = q->width, first = s->fluid->grid->first;
  (void)PetscArrayzero(q->state, 2 * w);
  for (PetscInt j = 0; j < q->rows; j++) {
    const PetscReal force[2] = {side->d[0][first + j], side->d[1][first + j]};
    const PetscInt stored = q->stored[j] * MODE_BLOCK;
    if (measured) StreamMeterForce(s->meter, j, force[0] + force[1]);
    (void)PetscArrayzero(q->y + j * w + stored, w - stored);
    SlabsStore(q, j, w / MODE_BLOCK);
    StreamRowUpWalls(s->factors, force, side->curl, q->state, q->y + j * w);
  }
}

/* Walls in x hold the fluid: what came in is taken off y again, their forces are added, and all is closed anew. */
static PetscErrorCode HoldSides(Stream s, const StreamRows *rows, PetscBool measured) {
  const Slabs q = s->slabs;
  PetscReal none = 0;
  PetscFunctionBeginUser;
  SideVelocity(s, rows);
  PetscCall(SideWallsForces(s->side, s->fluid->nu));
  SlabsReopen(q);
  AddSideForces(s, measured);
  SlabsAddLast(q);
  PetscCall(SlabsClose(q, &none));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamSolve(Stream s, const StreamRows *rows, StreamMeasures *measures) {
  const StreamPast *past = rows->past && rows->past->count ? rows->past : NULL;
  const PetscBool measured = measures != NULL;
  StreamRows these = *rows;
  PetscReal sum;
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_FAST_SOLVE));
  these.past = past;
  PetscCall(StreamSetUp(s));
  StreamMeterBegin(s->meter);
  if (past) PetscCall(StreamFlowsBegin(s->flows, past));
  if (rows->flow) PetscCall(VecGetArray(rows->flow, &s->flow));
  StreamGather(s, &these, measured);
  sum = s->mean_v;
  PetscCall(SlabsClose(s->slabs, &sum));
  if (s->mean) PetscCall(MeanFlow(s, sum));
  if (s->side) PetscCall(HoldSides(s, &these, measured));
  StreamScatter(s, &these, measured);
  if (rows->flow) PetscCall(VecRestoreArray(rows->flow, &s->flow));
  s->flow = NULL;
  if (past) PetscCall(StreamFlowsEnd(s->flows, past, &s->meter->own.past));
  if (measures) PetscCall(StreamMeterEnd(s->meter, measures));
  FastSolverCount(s->fluid->solver[FIELD_P]);
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}
