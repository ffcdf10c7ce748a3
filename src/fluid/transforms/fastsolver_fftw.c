/* Back end "fftw": a two-dimensional real-to-real transform diagonalises the second differences. FFTW's MPI part moves
   the data: its forward transform leaves columns on each rank where there were rows, which are divided by the
   eigenvalues and transformed back. The kinds of transform follow from the field's condition at the walls:

     periodic                         Fourier (half-complex)
     wall half a cell off, Neumann    cosines of half samples   REDFT10, REDFT01     p
     wall half a cell off, Dirichlet  sines of half samples     RODFT10, RODFT01     u in y, v in x
     wall on an entry, Dirichlet      sines                     RODFT00              u in x, v in y */
#include "fluid/transforms/fastsolver.h"
#include <fftw3-mpi.h>

typedef struct {
  ptrdiff_t columns, first_column; /* this rank's columns of the transposed array */
  double *buffer;
  fftw_plan forward, backward;
  PetscReal *lambda[2]; /* eigenvalues of the second difference in x and y, in transform order */
  PetscReal scale;      /* factor that makes a forward and a backward transform the identity */
} Transform;

/* Kinds of transform in one direction, and the size that a forward and a backward one multiply by. */
static void Kinds(Grid g, Field f, int dir, fftw_r2r_kind *forward, fftw_r2r_kind *backward, PetscReal *size) {
  const PetscReal c = GridWallFactor(f, dir);
  *size = 2.0 * g->n[dir];
  if (!g->wall[dir])
    *forward = FFTW_R2HC, *backward = FFTW_HC2R, *size = g->n[dir];
  else if (c > 0)
    *forward = FFTW_REDFT10, *backward = FFTW_REDFT01;
  else if (c < 0)
    *forward = FFTW_RODFT10, *backward = FFTW_RODFT01;
  else
    *forward = *backward = FFTW_RODFT00;
}

/* Eigenvalues -(4/h^2) sin^2(.) of the second difference, in the order of the transform's coefficients. */
static void Eigenvalues(Grid g, Field f, int dir, PetscInt n, PetscReal lambda[]) {
  for (PetscInt k = 0; k < n; k++) {
    PetscReal argument;
    if (!g->wall[dir])
      argument = PETSC_PI * (k <= n / 2 ? k : n - k) / n; /* half-complex order */
    else
      argument = PETSC_PI * (k + (GridWallFactor(f, dir) > 0 ? 0 : 1)) / (2.0 * g->n[dir]);
    lambda[k] = -4 / PetscSqr(g->h) * PetscSqr(PetscSinReal(argument));
  }
}

/* Sine transforms of N - 1 entries are as slow as N has large prime factors. */
static PetscErrorCode WarnSlow(Grid g, Field f, int dir) {
  PetscInt n = 2 * g->n[dir], largest = 1;
  PetscFunctionBeginUser;
  for (PetscInt p = 2; p <= n; p++)
    while (n % p == 0) {
      n /= p;
      largest = p;
    }
  if (g->wall[dir] && (int)f == dir && largest > 13)
    PetscCall(PetvesSay(g->comm,
                        "petves: warning: -domain_cells %" PetscInt_FMT " in %c has the prime factor %" PetscInt_FMT
                        ", sine transforms are slow; products of 2, 3, 5 and 7 are fast\n",
                        g->n[dir], dir ? 'y' : 'x', largest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve_FFTW(FastSolver s, const PetscScalar b[], PetscScalar x[]) {
  Transform *t = (Transform *)s->data;
  Grid g = s->grid;
  const PetscInt local = g->columns[s->field] * g->rows[s->field], ny = g->all_rows[s->field];
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(t->buffer, b, local));
  fftw_execute(t->forward);
  for (ptrdiff_t i = 0; i < t->columns; i++) {
    const PetscReal base = s->a0 - s->nu * t->lambda[0][t->first_column + i], nu = s->nu, scale = t->scale;
    const PetscReal *lambda = t->lambda[1];
    double *a = t->buffer + i * ny;
    if (s->singular && t->first_column + i == 0) a[0] = 0;
    for (PetscInt j = s->singular && t->first_column + i == 0 ? 1 : 0; j < ny; j++)
      a[j] *= scale / (base - nu * lambda[j]);
  }
  fftw_execute(t->backward);
  PetscCall(PetscArraycpy(x, t->buffer, local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_FFTW(FastSolver s) {
  Transform *t = (Transform *)s->data;
  PetscFunctionBeginUser;
  fftw_destroy_plan(t->forward);
  fftw_destroy_plan(t->backward);
  fftw_free(t->buffer);
  PetscCall(PetscFree2(t->lambda[0], t->lambda[1]));
  PetscCall(PetscFree(t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CleanUpFFTW(void) {
  fftw_mpi_cleanup();
  return PETSC_SUCCESS;
}

/* FFTW's MPI part, on the first call only. */
static PetscErrorCode StartFFTW(void) {
  static PetscBool done = PETSC_FALSE;
  PetscFunctionBeginUser;
  if (done) PetscFunctionReturn(PETSC_SUCCESS);
  fftw_mpi_init();
  PetscCall(PetscRegisterFinalize(CleanUpFFTW));
  done = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverCreate_FFTW(FastSolver s) {
  Grid g = s->grid;
  Transform *t;
  const ptrdiff_t n[2] = {g->all_rows[s->field], g->columns[s->field]};
  const ptrdiff_t column_block = (n[1] + g->size - 1) / g->size;
  ptrdiff_t rows, first_row, size;
  fftw_r2r_kind forward[2], backward[2];
  PetscReal logical[2];
  PetscFunctionBeginUser;
  PetscCall(StartFFTW());
  PetscCall(PetscNew(&t));
  s->data = t;
  s->solve = Solve_FFTW;
  s->destroy = Destroy_FFTW;
  for (int dir = 0; dir < 2; dir++) {
    Kinds(g, s->field, dir, &forward[1 - dir], &backward[1 - dir], &logical[dir]);
    PetscCall(WarnSlow(g, s->field, dir));
  }
  t->scale = 1 / (logical[0] * logical[1]);
  PetscCall(PetscMalloc2(n[1], &t->lambda[0], n[0], &t->lambda[1]));
  Eigenvalues(g, s->field, 0, (PetscInt)n[1], t->lambda[0]);
  Eigenvalues(g, s->field, 1, (PetscInt)n[0], t->lambda[1]);
  size = fftw_mpi_local_size_many_transposed(2, n, 1, g->block, column_block, g->comm, &rows, &first_row, &t->columns,
                                             &t->first_column);
  PetscCheck(rows == g->rows[s->field] && (rows == 0 || first_row == g->first), PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "FFTW's rows differ from the grid's");
  t->buffer = fftw_alloc_real((size_t)PetscMax(size, 1));
  PetscCheck(t->buffer, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the transforms");
  t->forward = fftw_mpi_plan_many_r2r(2, n, 1, g->block, column_block, t->buffer, t->buffer, g->comm, forward,
                                      FFTW_ESTIMATE | FFTW_MPI_TRANSPOSED_OUT);
  /* blocks of the input, then of the output: the transposed array comes first here */
  t->backward = fftw_mpi_plan_many_r2r(2, n, 1, column_block, g->block, t->buffer, t->buffer, g->comm, backward,
                                       FFTW_ESTIMATE | FFTW_MPI_TRANSPOSED_IN);
  PetscCheck(t->forward && t->backward, PETSC_COMM_SELF, PETSC_ERR_LIB, "FFTW could not plan a transform");
  PetscFunctionReturn(PETSC_SUCCESS);
}
