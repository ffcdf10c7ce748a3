/* A channel, periodic in x with walls in y: the exact Stokes solve from the projection.

   The projection leaves H u + G p = r_u + kappa g on the rows of u next to the walls, kappa = -2 nu/h^2 and g =
   G_x psi there: L_u mirrors with a minus at a wall, the gradient of a Neumann potential with a plus. A force delta on
   those rows, projected too, cancels it when (I + kappa M) delta = -kappa g, M delta being the g of delta's own
   projection. In x modes this is a 2 x 2 system, and the projection of a unit force on the bottom row is three real
   profiles in y: w = (alpha + nu lambda - nu d_yy)^-1 e_0,  psi = (d_yy - lambda)^-1 w, u = w + lambda psi,   v =
   conj(s) G_y psi,   p = -conj(s) (alpha psi - nu w), s = (e^{i theta} - 1)/h the symbol of G_x, lambda = |s|^2. The
   top wall's are their mirror images. */
#include "fluid/channel.h"
#include "fluid/wallprofile.h"
#include <complex.h>
#include <fftw3.h>

typedef double complex Complex;

#define DECAY 40 /* e^-40 = 4e-18 is not felt */

struct _p_Channel {
  Fluid fluid;
  PetscReal alpha;    /* coefficient the profiles are for */
  PetscInt modes;     /* n_x/2 + 1 */
  PetscReal *profile; /* [3][2][rows][modes]: u, v, p; bottom, top wall; this rank's rows */
  PetscReal *inverse; /* [2][modes] diagonal and off-diagonal entry of -kappa (I + kappa M)^-1 */
  Complex *delta;     /* [2][modes] force on the bottom and top rows */
  Complex *symbol;    /* [modes] of G_x */
  PetscInt *reach;    /* [rows of all] modes that are felt at a distance from a wall */
  Complex *line;      /* [modes] */
  double *row;        /* [n_x] */
  fftw_plan forward, backward;
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
  PetscCall(PetscMalloc1(g->n[1], &c->reach));
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
  PetscCall(PetscFree(c->reach));
  PetscCall(PetscFree4(c->profile, c->inverse, c->delta, c->symbol));
  PetscCall(PetscFree(*channel));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row j (v: the face above it) of the profiles of wall `top`, from the bottom wall's. */
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
  PetscReal *w, *psi, *work;
  PetscFunctionBeginUser;
  if (c->alpha == alpha) PetscFunctionReturn(PETSC_SUCCESS);
  c->alpha = alpha;
  PetscCall(PetscMalloc3(n, &w, n, &psi, n, &work));
  c->inverse[0] = c->inverse[c->modes] = 0;
  PetscCall(PetscArrayzero(c->profile, 6 * g->rows[FIELD_P] * c->modes));
  for (PetscInt k = 1; k < c->modes; k++) { /* mode 0 has no slip: G_x psi = 0 */
    const PetscReal lambda = 4 / h2 * PetscSqr(PetscSinReal(PETSC_PI * k / g->n[0]));
    WallProfile(c->fluid, n, lambda, work, w, psi);
    const PetscReal own = 1 - kappa * lambda * psi[0], other = -kappa * lambda * psi[n - 1];
    const PetscReal determinant = PetscSqr(own) - PetscSqr(other);
    c->inverse[k] = -kappa * own / determinant;
    c->inverse[c->modes + k] = kappa * other / determinant;
    for (PetscInt j = g->first; j < g->first + g->rows[FIELD_P]; j++) StoreRow(c, k, j, lambda, w, psi);
  }
  PetscCall(PetscFree3(w, psi, work));
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

/* Add wall `top`'s share to a row's modes, of those that reach it: delta profile, with -(+) conj(symbol) for p (v). */
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

/* Modes of the potential in a wall row, known to all ranks; normalised. */
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
  PetscReal *walls;
  PetscFunctionBeginUser;
  PetscCall(ChannelSetUp(c));
  PetscCall(VecGetArrayRead(psi, &psia));
  PetscCall(PetscMalloc1(4 * c->modes, &walls));
  for (int top = 0; top < 2; top++) PetscCall(WallRow(c, psia, top, walls + top * 2 * c->modes));
  ChannelForces(c, walls, walls + 2 * c->modes);
  PetscCall(PetscFree(walls));
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
