/* Closed curves, and vectors along them, as trigonometric polynomials of complex numbers: marker k at t = 2 pi k/n. */
#pragma once
#include "base/base.h"
#include <complex.h>

/* Points of a plane as complex numbers. */
typedef double complex Point;

/* CurveModes - hat[n + 1], the modes -n/2 .. n/2 of a[2n]; the last of an even n belongs to both ends by halves. Not
   collective. */
PETSC_EXTERN void CurveModes(PetscInt n, const PetscReal a[], Point hat[]);

/* CurveSeries - SUM hat_k e^{ikt} at t, which may be complex, and its derivative. Not collective. */
PETSC_EXTERN Point CurveSeries(PetscInt n, const Point hat[], Point t, Point *slope);
