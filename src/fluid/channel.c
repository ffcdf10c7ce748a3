/* A channel, periodic in x with walls in y: the exact Stokes solve from the projection.

   At a wall L_u continues u with a minus, G continues the potential with a plus. So they do not commute there, and the
   projection leaves
       H u + G p = r_u + kappa g,      kappa = -2 nu/h^2,  g = G_x psi,
   on the rows of u next to the walls, and nothing elsewhere. A force delta on those rows is projected too and leaves
   kappa M delta of its own, M delta being the g of its projection. It cancels the rest when
       (I + kappa M) delta = -kappa g.
   In Fourier modes along x this is a 2 x 2 system, one unknown a wall. With s = (e^{i theta} - 1)/h the symbol of G_x
   and lambda = |s|^2, the projection of a unit force on the bottom row is, with the real profiles w and psi of
   WallProfile, u = w + lambda psi,      v = conj(s) G_y psi,      p = -conj(s) (alpha psi - nu w). The top wall's
   profiles are their mirror images, and M's entries are -lambda psi in the first and in the last row. */
#include "fluid/channel.h"
#include "fluid/wallprofile.h"
#include <complex.h>
#include <fftw3.h>

typedef double complex Complex;

#define DECAY 40 /* e^-40 = 4e-18: a mode that has decayed so far is not felt */

struct _p_Channel {
  Fluid fluid;
  PetscReal alpha;             /* coefficient that the profiles are for; -1 none yet */
  PetscInt modes;              /* n_x/2 + 1 */
  PetscReal *profile;          /* [3][2][rows][modes]: u, v, p; bottom, top wall; this rank's rows */
  PetscReal *inverse;          /* [2][modes] diagonal and off-diagonal entry of -kappa (I + kappa M)^-1 */
  Complex *delta;              /* [2][modes] force on the bottom and top rows */
  Complex *symbol;             /* [modes] of G_x */
  PetscInt *reach;             /* [rows of all] modes that are felt this many rows from a wall */
  PetscReal *walls;            /* [2][modes] complex: the potential in the bottom and the top row */
  PetscReal *work[3];          /* [n_y] */
  Complex *line;               /* [modes] */
  double *row;                 /* [n_x] */
  fftw_plan forward, backward; /* between row and line */
};

PetscErrorCode ChannelCreate(Fluid fluid, Channel *out) {
  const Grid g = fluid->grid;
  const size_t n = (size_t)g->n[0];
  Channel c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->fluid = fluid;
  c->alpha = -1;
  c->modes = g->n[0] / 2 + 1;
  PetscCall(PetscMalloc4(6 * g->rows[FIELD_P] * c->modes, &c->profile, 2 * c->modes, &c->inverse, 2 * c->modes,
                         &c->delta, c->modes, &c->symbol));
  for (PetscInt k = 0; k < c->modes; k++) c->symbol[k] = (cexp(I * 2 * PETSC_PI * k / (double)n) - 1) / g->h;
  PetscCall(PetscMalloc5(g->n[1], &c->reach, 4 * c->modes, &c->walls, g->n[1], &c->work[0], g->n[1], &c->work[1],
                         g->n[1], &c->work[2]));
  for (PetscInt j = 0, reach = c->modes; j < g->n[1]; j++) { /* e^{-sqrt(lambda) y} */
    while (reach > 1 && 2 * PetscSinReal(PETSC_PI * (reach - 1) / (PetscReal)n) * j > DECAY) reach--;
    c->reach[j] = reach;
  }
  c->line = (Complex *)fftw_alloc_real(2 * (size_t)c->modes);
  c->row = fftw_alloc_real(n);
  c->forward = fftw_plan_dft_r2c_1d((int)n, c->row, (fftw_complex *)c->line, FFTW_ESTIMATE);
  c->backward = fftw_plan_dft_c2r_1d((int)n, (fftw_complex *)c->line, c->row, FFTW_ESTIMATE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ChannelDestroy(Channel *channel) {
  Channel c = *channel;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  fftw_destroy_plan(c->forward);
  fftw_destroy_plan(c->backward);
  fftw_free(c->line);
  fftw_free(c->row);
  PetscCall(PetscFree5(c->reach, c->walls, c->work[0], c->work[1], c->work[2]));
  PetscCall(PetscFree4(c->profile, c->inverse, c->delta, c->symbol));
  PetscCall(PetscFree(*channel));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row j (v: the face above it) of the profiles of both walls in mode k, from the bottom wall's w and psi. */
static void StoreRow(Channel c, PetscInt k, PetscInt j, PetscReal lambda, const PetscReal w[], const PetscReal psi[]) {
  const Grid g = c->fluid->grid;
  const PetscInt n = g->n[1], rows = g->rows[FIELD_P];
  const PetscReal alpha = c->fluid->alpha, nu = c->fluid->nu;
  for (int top = 0; top < 2; top++) {
    const PetscInt m = top ? n - 1 - j : j, next = top ? m - 1 : m + 1; /* mirrored row, and the row above it */
    const PetscReal v = next >= 0 && next < n ? (psi[next] - psi[m]) / g->h : 0;
    const PetscReal value[3] = {w[m] + lambda * psi[m], v, alpha * psi[m] - nu * w[m]};
    for (int f = 0; f < 3; f++) c->profile[((f * 2 + top) * rows + j - g->first) * c->modes + k] = value[f];
  }
}

PetscErrorCode ChannelSetUp(Channel c) {
  const Grid g = c->fluid->grid;
  const PetscInt n = g->n[1];
  const PetscReal alpha = c->fluid->alpha, h2 = PetscSqr(g->h), kappa = -2 * c->fluid->nu / h2;
  PetscReal *w = c->work[0], *psi = c->work[1];
  PetscFunctionBeginUser;
  if (c->alpha == alpha) PetscFunctionReturn(PETSC_SUCCESS);
  c->alpha = alpha;
  c->inverse[0] = c->inverse[c->modes] = 0;
  PetscCall(PetscArrayzero(c->profile, 6 * g->rows[FIELD_P] * c->modes));
  for (PetscInt k = 1; k < c->modes; k++) { /* mode 0 has no slip: G_x psi = 0 */
    const PetscReal lambda = 4 / h2 * PetscSqr(PetscSinReal(PETSC_PI * k / g->n[0]));
    WallProfile(c->fluid, n, lambda, c->work[2], w, psi);
    const PetscReal own = 1 - kappa * lambda * psi[0], other = -kappa * lambda * psi[n - 1];
    const PetscReal determinant = PetscSqr(own) - PetscSqr(other);
    c->inverse[k] = -kappa * own / determinant;
    c->inverse[c->modes + k] = kappa * other / determinant;
    for (PetscInt j = g->first; j < g->first + g->rows[FIELD_P]; j++) StoreRow(c, k, j, lambda, w, psi);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ChannelForces(Channel c, const PetscReal bottom[], const PetscReal top[]) {
  const Complex *b = (const Complex *)bottom, *t = (const Complex *)top;
  for (PetscInt k = 0; k < c->modes; k++) {
    const PetscReal own = c->inverse[k], other = c->inverse[c->modes + k];
    const Complex one = c->symbol[k] * b[k], two = c->symbol[k] * t[k]; /* slips */
    c->delta[k] = own * one + other * two;
    c->delta[c->modes + k] = other * one + own * two;
  }
}

/* Add to the modes of local row j what the force on one wall does there, delta times its profile: as it is for u, with
   conj(symbol) for v and -conj(symbol) for p. Modes that do not reach the row are left out. */
static void AddWall(Channel c, int f, int top, PetscInt j, Complex line[]) {
  const PetscInt rows = c->fluid->grid->rows[FIELD_P], global = j + c->fluid->grid->first;
  const PetscInt distance = top ? c->fluid->grid->n[1] - 2 - global : global;
  const PetscInt reach = PetscMin(c->modes, c->reach[PetscMax(distance, 0)]);
  const PetscReal *restrict profile = c->profile + ((f * 2 + top) * rows + j) * c->modes;
  const PetscReal *restrict delta = (const PetscReal *)(c->delta + top * c->modes);
  const PetscReal *restrict symbol = (const PetscReal *)c->symbol;
  const PetscReal sign = f == FIELD_V ? 1 : -1;
  PetscReal *restrict out = (PetscReal *)line;
  if (f == FIELD_U)
    for (PetscInt k = 0; k < reach; k++) {
      out[2 * k] += profile[k] * delta[2 * k];
      out[2 * k + 1] += profile[k] * delta[2 * k + 1];
    }
  else
    for (PetscInt k = 0; k < reach; k++) {
      const PetscReal weight = sign * profile[k];
      out[2 * k] += weight * (symbol[2 * k] * delta[2 * k] + symbol[2 * k + 1] * delta[2 * k + 1]);
      out[2 * k + 1] += weight * (symbol[2 * k] * delta[2 * k + 1] - symbol[2 * k + 1] * delta[2 * k]);
    }
}

void ChannelAddRow(Channel c, Field f, PetscInt j, PetscReal line[]) {
  for (int top = 0; top < 2; top++) AddWall(c, f, top, j, (Complex *)line);
}

/* Modes of the potential in a wall row, normalised: its rank transforms it and tells the others. */
static PetscErrorCode WallRow(Channel c, const PetscScalar psi[], int top, PetscReal modes[]) {
  const Grid g = c->fluid->grid;
  const PetscInt n = g->n[0], last = g->rows[FIELD_P] - 1;
  const PetscMPIInt owner = top ? g->size - 1 : 0;
  PetscFunctionBeginUser;
  if (g->rank == owner) {
    for (PetscInt i = 0; i < n; i++) c->row[i] = psi[(top ? last : 0) * n + i] / (PetscReal)n;
    fftw_execute(c->forward);
    PetscCall(PetscMemcpy(modes, c->line, (size_t)c->modes * sizeof(Complex)));
  }
  PetscCallMPI(MPI_Bcast(modes, (PetscMPIInt)(2 * c->modes), MPI_DOUBLE, owner, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add a field's correction to its local rows. */
static void AddField(Channel c, Field f, PetscScalar a[]) {
  const Grid g = c->fluid->grid;
  const PetscInt n = g->n[0];
  for (PetscInt j = 0; j < g->rows[f]; j++) {
    for (PetscInt k = 0; k < c->modes; k++) c->line[k] = 0;
    ChannelAddRow(c, f, j, (PetscReal *)c->line);
    fftw_execute(c->backward);
    for (PetscInt i = 0; i < n; i++) a[j * n + i] += c->row[i];
  }
}

PetscErrorCode ChannelCorrect(Channel c, Vec psi, Vec u, Vec p) {
  const PetscScalar *psia;
  PetscScalar *a;
  PetscReal *bottom = c->walls, *top = c->walls + 2 * c->modes;
  PetscFunctionBeginUser;
  PetscCall(ChannelSetUp(c));
  PetscCall(VecGetArrayRead(psi, &psia));
  PetscCall(WallRow(c, psia, 0, bottom));
  PetscCall(WallRow(c, psia, 1, top));
  ChannelForces(c, bottom, top);
  PetscCall(VecRestoreArrayRead(psi, &psia));
  PetscCall(VecGetArray(u, &a));
  AddField(c, FIELD_U, a);
  AddField(c, FIELD_V, a + GridLocalU(c->fluid->grid));
  PetscCall(VecRestoreArray(u, &a));
  PetscCall(VecGetArray(p, &a));
  AddField(c, FIELD_P, a);
  PetscCall(VecRestoreArray(p, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
