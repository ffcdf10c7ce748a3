#include "fluid/transforms/rowtransform.h"

/* One real Fourier transform of length n between real[n] and complex[n/2 + 1], twisted or not. */
static PetscErrorCode FourierCreate(PetscInt n, PetscBool twisted, double *real, double *modes, Fourier *f) {
  PetscFunctionBeginUser;
  f->n = n;
  f->half = n / 2 + 1;
  f->forward = fftw_plan_dft_r2c_1d((int)n, real, (fftw_complex *)modes, FFTW_ESTIMATE);
  f->backward = fftw_plan_dft_c2r_1d((int)n, (fftw_complex *)modes, real, FFTW_ESTIMATE);
  PetscCheck(f->forward && f->backward, PETSC_COMM_SELF, PETSC_ERR_LIB, "FFTW could not plan a transform");
  if (!twisted) PetscFunctionReturn(PETSC_SUCCESS);
  f->twist = fftw_alloc_real(2 * (size_t)f->half);
  for (PetscInt k = 0; k < f->half; k++) {
    f->twist[2 * k] = PetscCosReal(PETSC_PI * k / (2.0 * n));
    f->twist[2 * k + 1] = -PetscSinReal(PETSC_PI * k / (2.0 * n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Twist: mode k of w times e^{-i pi k/2n}. Untwist takes it back. */
static inline void Twist(const Fourier *f, double *restrict w) {
  for (PetscInt k = 0; k < 2 * f->half; k += 2) {
    const double c = f->twist[k], s = f->twist[k + 1], re = w[k], im = w[k + 1];
    w[k] = re * c - im * s;
    w[k + 1] = re * s + im * c;
  }
}
static inline void Untwist(const Fourier *f, double *restrict w) {
  for (PetscInt k = 0; k < 2 * f->half; k += 2) {
    const double c = f->twist[k], s = f->twist[k + 1], re = w[k], im = w[k + 1];
    w[k] = re * c + im * s;
    w[k + 1] = im * c - re * s;
  }
}

/* Walls half a cell off (Makhoul's reordering): the even entries upwards, then the odd ones downwards, are a row whose
   twisted Fourier modes have cosine k as their real and minus cosine n - k as their imaginary part. With the sign of
   the odd entries turned they are sine n - k and minus sine k. */
static void HalfSampleForward(RowTransform t, const PetscScalar x[]) {
  const PetscInt n = t->n;
  const PetscReal sign = t->sign;
  for (PetscInt i = 0; 2 * i < n; i++) t->line[i] = x[2 * i];
  for (PetscInt i = 0; 2 * i + 1 < n; i++) t->line[n - 1 - i] = sign * x[2 * i + 1];
  fftw_execute(t->f[0].forward);
  Twist(&t->f[0], t->modes);
}

static void HalfSampleBackward(RowTransform t, PetscScalar x[]) {
  const PetscInt n = t->n;
  const PetscReal sign = t->sign;
  Untwist(&t->f[0], t->modes);
  fftw_execute(t->f[0].backward);
  for (PetscInt i = 0; 2 * i < n; i++) x[2 * i] = t->line[i];
  for (PetscInt i = 0; 2 * i + 1 < n; i++) x[2 * i + 1] = sign * t->line[n - 1 - i];
}

/* Walls on the entries: the sines of x_1 .. x_{N-1}, N = 2 n. With sin(pi m (N - j)/N) = -(-1)^m sin(pi m j/N),

     odd m    SUM e_j sin(pi m j/N),          j = 1 .. n,       e_j = x_j + x_{N-j},  e_n = x_n
     even m   SUM o_j sin(pi (m/2) j/n),      j = 1 .. n - 1,   o_j = x_j - x_{N-j}

   The even ones are the same problem at half the length, and are taken apart in the next level. The odd ones are the
   transpose of a sine transform of half samples: what HalfSampleBackward does with modes, without its reordering, which
   lambda stands for. There the complex mode k holds sine n - k and minus sine k, so it is (e_{n-k}, -e_k) here.

   A level's Fourier transform runs between its segment of `modes` and `line`. The arrays x below hold x_j at j - 1. */

/* The modes (e_{n-k}, -e_k) of x, untwisted. Both steps are one loop, since each would read all of memory. */
static void FoldAndUntwist(const Fourier *f, const double *restrict x, double *restrict modes) {
  const PetscInt n = f->n;
  const double *restrict twist = f->twist, *middle = x + n - 1, *end = x + 2 * n - 1; /* x_n, x_N */
  modes[0] = 2 * *middle; /* (e_n, 0): other entries count twice, as modes k and -k */
  modes[1] = 0;
  for (PetscInt k = 1; k < f->half; k++) {
    const double c = twist[2 * k], s = twist[2 * k + 1];
    const double re = middle[-k] + middle[k], im = -(x[k - 1] + end[-k]);
    modes[2 * k] = re * c + im * s;
    modes[2 * k + 1] = im * c - re * s;
  }
}

static void SineForward(RowTransform t, const PetscScalar x[]) {
  double *rest = t->rest;
  PetscInt N = t->n + 1;
  memcpy(rest, x, (size_t)t->n * sizeof(double));
  for (PetscInt l = 0; l < t->levels; l++, N /= 2) {
    FoldAndUntwist(&t->f[l], rest, t->line);
    fftw_execute(t->f[l].backward);
    for (PetscInt j = 1; j < N / 2; j++) rest[j - 1] -= rest[N - j - 1]; /* o_j */
  }
  if (t->base > 1) fftw_execute(t->base_forward);
  for (PetscInt k = 0; k < t->width && t->order; k++) t->modes[k] = t->unsorted[t->order[k]];
}

/* The way back: x_j = e_j + o_j and x_{N-j} = e_j - o_j (their halves are in `scale`), in place of the o_j in
   x_1 .. x_{n-1}. The modes come from the Fourier transform and still want their twist. j = k and j = n - k are put
   right together, as one mode has both e_k and e_{n-k}. */
static void TwistAndUnfold(const Fourier *f, const double *restrict modes, double *restrict x) {
  const PetscInt n = f->n;
  const double *restrict twist = f->twist;
  double *middle = x + n - 1, *end = x + 2 * n - 1; /* x_n, x_N */
  *middle = modes[0];
  for (PetscInt k = 1; 2 * k <= n; k++) {
    const double c = twist[2 * k], s = twist[2 * k + 1];
    const double e_far = modes[2 * k] * c - modes[2 * k + 1] * s;     /* e_{n-k} */
    const double e_near = -(modes[2 * k] * s + modes[2 * k + 1] * c); /* e_k */
    const double o_near = x[k - 1], o_far = middle[-k];
    x[k - 1] = e_near + o_near;
    end[-k] = e_near - o_near;
    middle[-k] = e_far + o_far;
    middle[k] = e_far - o_far;
  }
}

static void SineBackward(RowTransform t, PetscScalar x[]) {
  for (PetscInt k = 0; k < t->width && t->order; k++) t->unsorted[t->order[k]] = t->modes[k];
  if (t->base > 1) fftw_execute(t->base_backward);
  for (PetscInt l = t->levels - 1; l >= 0; l--) {
    fftw_execute(t->f[l].forward);
    TwistAndUnfold(&t->f[l], t->line, t->rest);
  }
  memcpy(x, t->rest, (size_t)t->n * sizeof(double));
}

void RowTransformForward(RowTransform t, const PetscScalar x[]) {
  const PetscInt n = t->n;
  PetscInt zeros = 0;
  while (zeros < n && x[zeros] == 0) zeros++; /* forces of a membrane are zero in most rows */
  if (zeros == n)
    memset(t->modes, 0, (size_t)t->width * sizeof(double));
  else if (t->base)
    SineForward(t, x);
  else if (t->sign != 0)
    HalfSampleForward(t, x);
  else if (fftw_alignment_of((double *)x) == fftw_alignment_of(t->line))
    fftw_execute_dft_r2c(t->f[0].forward, (double *)x, (fftw_complex *)t->modes);
  else {
    memcpy(t->line, x, (size_t)n * sizeof(double));
    fftw_execute(t->f[0].forward);
  }
}

void RowTransformBackward(RowTransform t, PetscScalar x[]) {
  if (t->base)
    SineBackward(t, x);
  else if (t->sign != 0)
    HalfSampleBackward(t, x);
  else if (fftw_alignment_of(x) == fftw_alignment_of(t->line))
    fftw_execute_dft_c2r(t->f[0].backward, (fftw_complex *)t->modes, x);
  else {
    fftw_execute(t->f[0].backward);
    memcpy(x, t->line, (size_t)t->n * sizeof(double));
  }
}

/* -h^2 times the second difference's eigenvalue for a wave of phase 2 argument per entry. */
static PetscReal Eigenvalue(PetscReal argument) {
  return 4 * PetscSqr(PetscSinReal(argument));
}

/* Periodic, and walls half a cell off. */
static PetscErrorCode CreateWhole(RowTransform t) {
  const PetscInt n = t->n;
  const PetscBool periodic = t->sign == 0;
  PetscFunctionBeginUser;
  PetscCall(FourierCreate(n, periodic ? PETSC_FALSE : PETSC_TRUE, t->line, t->modes, &t->f[0]));
  for (PetscInt k = 0; k < t->width; k++) {
    const PetscInt mode = k / 2, wave = k % 2 ? n - mode : mode; /* cosine number, of 0 .. n - 1 */
    t->lambda[k] = Eigenvalue(periodic ? PETSC_PI * mode / n : PETSC_PI * (t->sign > 0 ? wave : n - wave) / (2.0 * n));
    if (k == 1) t->lambda[k] = 4; /* no mode: zero, whatever is done to it */
    t->scale[k] = 1.0 / n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Walls on the entries next to the row's ends. */
static PetscErrorCode CreateSines(RowTransform t) {
  const PetscInt cells = t->n + 1;
  PetscInt N = cells, start = 0;
  PetscFunctionBeginUser;
  t->rest = fftw_alloc_real((size_t)t->n);
  for (; N % 2 == 0 && N > 4; N /= 2) {
    const PetscInt half = N / 2;
    PetscCall(FourierCreate(half, PETSC_TRUE, t->modes + start, t->line, &t->f[t->levels++]));
    for (PetscInt i = 0; i < half; i++) { /* wave numbers 1, 3, 5 .. in Makhoul's order */
      const PetscInt m = 2 * i < half ? 2 * i : 2 * (half - 1 - i) + 1;
      t->lambda[start + i] = Eigenvalue(PETSC_PI * (2 * m + 1) / (2.0 * N));
      t->scale[start + i] = 1.0 / cells;
    }
    start += half;
  }
  t->base = N;
  for (PetscInt k = 1; k < N; k++) {
    t->lambda[start + k - 1] = Eigenvalue(PETSC_PI * k / (2.0 * N));
    t->scale[start + k - 1] = 1.0 / (2 * cells);
  }
  if (N == 1) PetscFunctionReturn(PETSC_SUCCESS);
  t->base_forward = fftw_plan_r2r_1d((int)N - 1, t->rest, t->modes + start, FFTW_RODFT00, FFTW_ESTIMATE);
  t->base_backward = fftw_plan_r2r_1d((int)N - 1, t->modes + start, t->rest, FFTW_RODFT00, FFTW_ESTIMATE);
  PetscCheck(t->base_forward && t->base_backward, PETSC_COMM_SELF, PETSC_ERR_LIB, "FFTW could not plan a transform");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RowTransformCreate(Grid g, Field field, RowTransform *out) {
  const PetscReal c = GridWallFactor(field, 0);
  const PetscBool sines = g->wall[0] && c == 0;
  RowTransform t;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  *out = t;
  t->n = g->columns[field];
  t->width = sines ? t->n : 2 * (t->n / 2 + 1);
  t->modes = fftw_alloc_real((size_t)t->width);
  t->line = fftw_alloc_real((size_t)t->n + 5);
  PetscCall(PetscMalloc2(t->width, &t->lambda, t->width, &t->scale));
  t->sign = g->wall[0] ? c : 0;
  PetscCall(sines ? CreateSines(t) : CreateWhole(t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RowTransformSort(RowTransform t) {
  PetscReal *before;
  PetscFunctionBeginUser;
  if (!t->base || t->order) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(t->width, &t->order));
  for (PetscInt k = 0; k < t->width; k++) t->order[k] = k;
  PetscCall(PetscSortRealWithArrayInt(t->width, t->lambda, t->order));
  PetscCall(PetscMalloc1(t->width, &before));
  PetscCall(PetscArraycpy(before, t->scale, t->width));
  for (PetscInt k = 0; k < t->width; k++) t->scale[k] = before[t->order[k]];
  PetscCall(PetscFree(before));
  t->unsorted = t->modes; /* the plans' */
  t->modes = fftw_alloc_real((size_t)t->width);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Between walls Forward's rows are 2 sin(pi k j/N), k = 1 .. N - 1: sums of squares 2 N. Backward is its inverse over
   `scale`, so that its columns are these rows over that and `scale`. In a period modes stand for a pair each but the
   mean and one that alternates from entry to entry. */
PetscErrorCode RowTransformNorms(RowTransform t, PetscReal norm[]) {
  const PetscInt single = t->n % 2 ? t->width : t->width - 2;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < t->width; k++)
    norm[k] = t->base ? 1 / (2 * (PetscReal)(t->n + 1) * PetscSqr(t->scale[k]))
                      : (k < 2 || k >= single ? 1 : 2) * (PetscReal)t->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A transform's own rounding is that of the largest mode, and sines of the shortest and the longest waves are small.
   Its sign is what Makhoul's reordering makes it. */
PetscErrorCode RowTransformEnds(RowTransform t, PetscReal first[], PetscReal last[]) {
  const PetscInt N = t->n + 1;
  PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(t->n, &x));
  x[0] = 1;
  RowTransformForward(t, x);
  for (PetscInt k = 0; k < t->width; k++) {
    const PetscInt wave = PetscMin(k + 1, N - k - 1);
    const PetscReal sine = 2 * PetscSinReal(PETSC_PI * wave / N);
    first[k] = t->modes[k] < 0 ? -sine : sine;
    last[k] = k % 2 ? -first[k] : first[k];
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RowTransformDestroy(RowTransform *transform) {
  RowTransform t = *transform;
  PetscFunctionBeginUser;
  if (!t) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt l = 0; l < ROW_LEVELS; l++) {
    if (t->f[l].forward) fftw_destroy_plan(t->f[l].forward);
    if (t->f[l].backward) fftw_destroy_plan(t->f[l].backward);
    fftw_free(t->f[l].twist);
  }
  if (t->base_forward) fftw_destroy_plan(t->base_forward);
  if (t->base_backward) fftw_destroy_plan(t->base_backward);
  fftw_free(t->modes);
  fftw_free(t->line);
  fftw_free(t->rest);
  fftw_free(t->unsorted);
  PetscCall(PetscFree(t->order));
  PetscCall(PetscFree2(t->lambda, t->scale));
  PetscCall(PetscFree(*transform));
  PetscFunctionReturn(PETSC_SUCCESS);
}
