"""Ranks whose BLAS rounds differently, as on unlike processors: every decision is taken once for all, so a run ends, and
differs from one on like ranks by what the solvers' tolerances let through. One rank preloads a library that turns the last
bit of what BLAS and LAPACK give back."""

import functools

import numpy as np
import pytest
from harness import PETVES, mpirun, preloaded, read_series

NUDGE = r"""
#include <math.h>
static unsigned count;
/* Zeros stay: sums of zeros are zero on any processor, and a sum of squares is never negative. */
static double nudged(double x) { return x != 0 && ++count % 3 ? nextafter(x, count % 2 ? HUGE_VAL : -HUGE_VAL) : x; }
double ddot_(int *n, double *x, int *dx, double *y, int *dy) { return nudged(REAL(ddot_)(n, x, dx, y, dy)); }
double dnrm2_(int *n, double *x, int *dx) { return nudged(REAL(dnrm2_)(n, x, dx)); }
void dgemv_(char *t, int *m, int *n, double *a, double *A, int *lda, double *x, int *dx, double *b, double *y, int *dy) {
  REAL(dgemv_)(t, m, n, a, A, lda, x, dx, b, y, dy);
  for (int k = 0; k < (*t == 'N' ? *m : *n); k++) y[k * *dy] = nudged(y[k * *dy]);
}
void dgetrs_(char *t, int *n, int *m, double *A, int *lda, int *p, double *X, int *ldx, int *info) {
  REAL(dgetrs_)(t, n, m, A, lda, p, X, ldx, info);
  for (int k = 0; k < *n * *m; k++) X[k] = nudged(X[k]);
}
void dpotri_(char *t, int *n, double *A, int *lda, int *info) {
  REAL(dpotri_)(t, n, A, lda, info);
  for (int j = 0; j < *n; j++)
    for (int i = j; i < *n; i++) A[j * *lda + i] = nudged(A[j * *lda + i]);
}
void dpotrs_(char *t, int *n, int *m, double *A, int *lda, double *X, int *ldx, int *info) {
  REAL(dpotrs_)(t, n, m, A, lda, X, ldx, info);
  for (int k = 0; k < *n * *m; k++) X[k] = nudged(X[k]);
}
"""

SCENES = {
    "shear": "-domain_cells 64,64 -flow_type shear -time_step 0.02 -time_end 0.4",
    "two_vesicles": "-domain_box 0,4,0,4 -domain_cells 64,64 -domain_bc_x periodic -flow_type shear -flow_center_y 2 "
    "-vesicle_count 2 -vesicle_center 1.3,2.2,2.7,1.8 -time_step 0.02 -time_end 0.5",
    "adaptive": "-domain_cells 48,48 -flow_type shear -time_step 0.05 -time_end 1 -time_adapt error -time_adapt_tol 1e-3",
    "split": "-domain_box 0,4,0,4 -domain_cells 64,64 -flow_type shear -flow_center_y 2 -scheme_type split -delta_type ib6 "
    "-vesicle_count 2 -vesicle_center 1.2,2.2,2.8,1.8 -time_step 0.05 -time_end 0.75",
}


pytestmark = pytest.mark.xdist_group("unlike_ranks")  # its tests share runs


@pytest.fixture(scope="module")
def series(tmp_path_factory):
    """Rows of two ranks, of which this one is nudged, or none; each run is made once."""
    library = preloaded(tmp_path_factory.mktemp("nudge"), NUDGE)

    @functools.cache
    def of(scene: str, odd: int | None):
        solvers = ("tension", "bending") if scene == "split" else ("coupled",)
        folder = tmp_path_factory.mktemp("run") / "out"
        options = f"{SCENES[scene]} {' '.join(f'-{solver}_ksp_rtol 1e-12' for solver in solvers)}"
        run = [PETVES, "-output_dir", str(folder), *options.split()]
        nudged = ["env", f"LD_PRELOAD={library}", *run]
        one, two = (nudged if rank == odd else run for rank in (0, 1))
        done = mpirun(["mpirun", "-n", "1", *one, ":", "-n", "1", *two], 1, timeout=120)
        assert done.returncode == 0, done.stderr
        return read_series(folder / "series.csv")

    return of


@pytest.mark.parametrize("unlike", [0, 1])
@pytest.mark.parametrize("scene", SCENES)
def test_unlike_ranks_agree(scene, unlike, series):
    """Two ranks, one of them nudged, against two that are not."""
    like, other = series(scene, None), series(scene, unlike)
    assert len(like["time"]) == len(other["time"]) > 10
    assert any(not np.array_equal(like[name], other[name]) for name in ("energy_bending", "center_x", "length_error"))
    for name in ("time", "energy_kinetic", "energy_bending", "area", "length", "center_x", "center_y", "inclination"):
        scale = np.abs(like[name]).max() + 1e-3
        assert np.abs(like[name] - other[name]).max() < 1e-8 * scale, name
