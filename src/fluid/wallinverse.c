/* The inverse of d -> d + slip(d) for wall forces d, mode by mode along the walls.

   One pair of walls: a force wave of eigenvalue -lambda on one wall leaves the slip kappa G psi, kappa = -2 nu/h^2, on
   both. With the potential's profile psi[0] .. psi[n-1] across the box (WallProfile) that is, in units of the force,
   -kappa lambda psi[0] on its own wall and -kappa lambda psi[n-1] on the facing one. So the modes of the two walls obey
       (1 - kappa lambda psi[0]) d_own - kappa lambda psi[n-1] d_other = r_own,
   and the same with the walls exchanged: a 2 x 2 system a mode.

   Two pairs: the forces of each also leave slip along the other pair's walls (CrossSlip). Gauss-Seidel sweeps take
   turns: invert one pair for what the other one has left. */
#include "fluid/walls.h"
#include "base/lanes.h"
#include "fluid/wallprofile.h"

/* Mode k of pair dir: its share in the slip along the other pair's walls. A force sin(pi (k + 1) x/L) has the potential
   sqrt(lambda) psi(y) cos(pi (k + 1) x/L), to be taken half a cell from the wall in x. */
static void FillCross(Walls w, int dir, PetscInt k, PetscReal lambda, const PetscReal psi[]) {
  const Grid g = w->fluid->grid;
  const CrossSlip *cross = &w->pair[dir].cross;
  const PetscReal c = -2 * w->fluid->nu / PetscSqr(g->h) / g->h * PetscSqrtReal(lambda) *
                      PetscCosReal(PETSC_PI * (k + 1) / (2.0 * g->n[1 - dir]));
  for (PetscInt j = 0; j < w->pair[1 - dir].length; j++)
    if (k < cross->row[j + 1] - cross->row[j]) cross->value[cross->row[j] + k] = c * (psi[j + 1] - psi[j]);
}

/* Flow of mode k of pair dir by the distance from its wall: along it (force + lambda psi) sin, half a cell off the
   wall, away from it -sqrt(lambda) psi' cos, on the rows' edges. */
static void FillProfile(Walls w, int dir, PetscInt k, PetscReal lambda, const PetscReal force[],
                        const PetscReal psi[]) {
  const PetscInt n = w->fluid->grid->n[dir], room = w->pair[dir].waves.room;
  const PetscReal slope = -PetscSqrtReal(lambda) / w->fluid->grid->h;
  PetscReal *along = w->pair[dir].waves.profile + k;
  for (PetscInt j = 0; j < n; j++, along += 2 * room) {
    along[0] = force[j] + lambda * psi[j];
    along[room] = j + 1 < n ? slope * (psi[j + 1] - psi[j]) : 0;
  }
}

/* All of pair dir that depends on alpha: the inverse 2 x 2 matrices, divided by the size of FFTW's transforms there and
   back, and what the modes do elsewhere. */
static void SetUpPair(Walls w, int dir) {
  const Grid g = w->fluid->grid;
  const PetscReal h2 = PetscSqr(g->h), kappa = -2 * w->fluid->nu / h2;
  const PetscInt m = w->pair[dir].length, n = g->n[dir], cells = g->n[1 - dir];
  const PetscReal size = g->wall[1 - dir] ? 2.0 * cells : m;
  WallPair *p = &w->pair[dir];
  PetscReal *force = w->work[0], *psi = w->work[1];
  for (PetscInt k = 0; k < m; k++) {
    const PetscReal argument = g->wall[1 - dir] ? PETSC_PI * (k + 1) / (2.0 * cells)
                                                : PETSC_PI * PetscMin(k, m - k) / m; /* R2HC's order */
    const PetscReal lambda = 4 / h2 * PetscSqr(PetscSinReal(argument));
    if (lambda == 0) { /* a uniform force has no slip */
      p->own[k] = 1 / size;
      p->other[k] = 0;
      continue;
    }
    WallProfile(w->fluid, n, lambda, w->work[2], force, psi);
    const PetscReal own = 1 - kappa * lambda * psi[0], other = -kappa * lambda * psi[n - 1];
    const PetscReal determinant = PetscSqr(own) - PetscSqr(other);
    p->own[k] = own / determinant / size;
    p->other[k] = -other / determinant / size;
    if (p->cross.value) FillCross(w, dir, k, lambda, psi);
    if (k < p->waves.modes) FillProfile(w, dir, k, lambda, force, psi);
  }
}

/* The walls in y of a square box do what those in x do. */
static PetscErrorCode CopyPair(Walls w) {
  const WallPair *from = &w->pair[0];
  WallPair *to = &w->pair[1];
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(to->own, from->own, from->length));
  PetscCall(PetscArraycpy(to->other, from->other, from->length));
  PetscCall(PetscArraycpy(to->cross.value, from->cross.value, from->cross.row[from->length]));
  PetscCall(PetscArraycpy(to->waves.profile, from->waves.profile, 2 * from->waves.room * w->fluid->grid->n[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp(Walls w) {
  const Grid g = w->fluid->grid;
  const PetscBool square = g->wall[0] && g->wall[1] && g->n[0] == g->n[1] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (w->alpha == w->fluid->alpha) PetscFunctionReturn(PETSC_SUCCESS);
  w->alpha = w->fluid->alpha;
  for (int dir = 0; dir < (square ? 1 : 2); dir++) SetUpPair(w, dir);
  if (square) PetscCall(CopyPair(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One line of a pair, there (way 0) or back. */
static void Transform(WallPair *p, int way, int side) {
  double *line = p->line[side];
  if (!p->sines.matrix[0]) {
    fftw_execute_r2r(way ? p->backward : p->forward, line, line);
    return;
  }
  SineMatrixApply(&p->sines, way, line, p->spare);
  p->line[side] = p->spare;
  p->spare = line;
}

/* The lines of a pair: from residuals to the modes of the forces that cancel them, not transformed back yet. */
static void Invert(WallPair *p) {
  for (int side = 0; side < 2; side++) Transform(p, 0, side);
  for (PetscInt k = 0; k < p->length; k++) {
    const PetscReal one = p->line[0][k], two = p->line[1][k];
    p->line[0][k] = p->own[k] * one + p->other[k] * two;
    p->line[1][k] = p->other[k] * one + p->own[k] * two;
  }
}

/* slip[2 n]: what the forces whose modes are in the lines of `pair` leave on the n faces of the other pair's first
   wall, then on those of its second wall. Take forces on the bottom wall, and slip along the left and the right one.
   The potential of wave number m is a cosine along the bottom wall, the same on the left and the right for even m,
   opposite for odd m. So the sums over even and over odd m are taken once and give both. Forces on the top wall are
   those on the bottom mirrored: face j changes place with n - 1 - j, and the slope along the wall its sign. */
static void SlipAcross(const WallPair *pair, PetscInt n, PetscScalar slip[]) {
  for (PetscInt j = 0; j < n; j++) slip[j] = slip[n + j] = 0;
  for (PetscInt j = 0; j < n; j++) {
    const PetscReal *row = pair->cross.value + pair->cross.row[j];
    const PetscInt reach = pair->cross.row[j + 1] - pair->cross.row[j];
    Lanes sum[2] = {{0}, {0}}; /* entry k has wave number k + 1 */
    for (PetscInt k = 0; k < reach; k += LANES)
      for (int side = 0; side < 2; side++) sum[side] += LanesAt(row + k) * LanesAt(pair->line[side] + k);
    for (int side = 0; side < 2; side++) {
      const PetscInt face = side ? n - 1 - j : j;
      const PetscReal sign = side ? -2 : 2; /* 2: FFTW's sine transforms are twice the sum */
      const PetscReal odd = sum[side][0] + sum[side][2], even = sum[side][1] + sum[side][3];
      slip[face] += sign * (even + odd);
      slip[n + face] += sign * (even - odd);
    }
  }
}

/* Forces from the modes in the lines of pair dir, into d; the long waves' amplitudes are kept. */
static void TakeForces(Walls w, int dir, PetscScalar d[]) {
  WallPair *p = &w->pair[dir];
  for (int side = 0; side < 2 && p->length; side++) {
    PetscScalar *to = d + p->start + side * p->length;
    for (PetscInt k = 0; k < p->waves.modes; k++) p->waves.amplitude[side][k] = 2 * p->line[side][k];
    Transform(p, 1, side);
    for (PetscInt i = 0; i < p->length; i++) to[i] = p->line[side][i];
  }
}

PetscErrorCode WallsInvert(Walls w, int sweeps, PetscScalar d[]) {
  const PetscBool two = w->pair[0].cross.value ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (!w->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SetUp(w));
  PetscCall(PetscArrayzero(w->slip, w->n));
  for (int sweep = 0; sweep < (two ? sweeps : 1); sweep++)
    for (int dir = 1; dir >= 0; dir--) {
      WallPair *p = &w->pair[dir];
      if (!p->length) continue;
      for (int side = 0; side < 2; side++)
        for (PetscInt i = 0; i < p->length; i++) {
          const PetscInt k = p->start + side * p->length + i;
          p->line[side][i] = d[k] - w->slip[k];
        }
      Invert(p);
      if (two) SlipAcross(p, w->pair[1 - dir].length, w->slip + w->pair[1 - dir].start);
    }
  for (int dir = 0; dir < 2; dir++) TakeForces(w, dir, d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where profiles whose rows j are j + offset cells from the wall are read at eta cells from it: linear between the rows
   and beyond the last, constant closer to the wall than the first. */
typedef struct {
  const PetscReal *row;
  PetscInt next;
  PetscReal part;
} ProfilePlace;

static ProfilePlace FindPlace(const LongWaves *w, PetscInt n, int component, PetscReal offset, PetscReal eta) {
  const PetscReal at = PetscMax(eta - offset, 0);
  const PetscInt j = PetscMin((PetscInt)at, n - 2);
  return (ProfilePlace){w->profile + (2 * j + component) * w->room, 2 * w->room, at - j};
}

static inline Lanes Interpolated(ProfilePlace at, PetscInt k) {
  const Lanes one = LanesAt(at.row + k);
  return one + at.part * (LanesAt(at.row + at.next + k) - one);
}

/* Velocity at X of all waves of pair dir for the amplitude 1: of the first wall, then of the second one. Sines by the
   angles' sum. */
static void WavesAtMarker(Walls w, int dir, const PetscScalar X[2], PetscReal U[]) {
  const Grid g = w->fluid->grid;
  const LongWaves *waves = &w->pair[dir].waves;
  const PetscInt n = g->n[dir], room = waves->room;
  const PetscReal angle = PETSC_PI * (X[1 - dir] - g->lo[1 - dir]) / (g->hi[1 - dir] - g->lo[1 - dir]);
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle), c2 = c * c - s * s, s2 = 2 * c * s;
  const PetscReal c4 = c2 * c2 - s2 * s2, s4 = 2 * c2 * s2;
  const PetscReal eta[2] = {(X[dir] - g->lo[dir]) / g->h, (g->hi[dir] - X[dir]) / g->h};
  const ProfilePlace along[2] = {FindPlace(waves, n, 0, 0.5, eta[0]), FindPlace(waves, n, 0, 0.5, eta[1])};
  const ProfilePlace away[2] = {FindPlace(waves, n, 1, 1, eta[0]), FindPlace(waves, n, 1, 1, eta[1])};
  PetscReal *one[2] = {U + (1 - dir) * room, U + dir * room};
  Lanes cosine = {c, c2, c * c2 - s * s2, c4}, sine = {s, s2, c * s2 + s * c2, s4};
  for (PetscInt k = 0; k < room; k += LANES) {
    LanesPut(sine * Interpolated(along[0], k), one[0] + k);
    LanesPut(cosine * Interpolated(away[0], k), one[1] + k);
    LanesPut(sine * Interpolated(along[1], k), one[0] + 2 * room + k);
    LanesPut(-cosine * Interpolated(away[1], k), one[1] + 2 * room + k);
    const Lanes before = cosine;
    cosine = cosine * c4 - sine * s4;
    sine = sine * c4 + before * s4;
  }
}

PetscErrorCode WallsSetMarkers(Walls w, PetscInt M, const PetscScalar X[]) {
  const PetscInt room[2] = {w->pair[0].waves.room, w->pair[1].waves.room};
  PetscFunctionBeginUser;
  if (!room[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SetUp(w));
  if (w->markers != M) PetscCall(PetscFree(w->flow));
  if (!w->flow) PetscCall(PetscMalloc1(4 * (room[0] + room[1]) * M, &w->flow));
  w->markers = M;
  PetscReal *flow = w->flow;
  for (PetscInt m = 0; m < M; m++)
    for (int dir = 0; dir < 2; dir++) {
      WavesAtMarker(w, dir, X + 2 * m, flow);
      flow += 4 * room[dir];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WallsMarkerVelocity(Walls w, PetscReal alpha, PetscScalar U[]) {
  const PetscReal *flow = w->flow;
  PetscFunctionBeginUser;
  if (!flow) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt m = 0; m < w->markers; m++) {
    Lanes sum[2] = {{0}, {0}};
    PetscReal u, v;
    for (int wall = 0; wall < 4; wall++) {
      const LongWaves *waves = &w->pair[wall / 2].waves;
      for (PetscInt k = 0; k < waves->room; k += LANES) {
        const Lanes amplitude = LanesAt(waves->amplitude[wall % 2] + k);
        sum[0] += amplitude * LanesAt(flow + k);
        sum[1] += amplitude * LanesAt(flow + waves->room + k);
      }
      flow += 2 * waves->room;
    }
    LanesTwoSums(sum[0], sum[1], &u, &v);
    U[2 * m] += alpha * u;
    U[2 * m + 1] += alpha * v;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
