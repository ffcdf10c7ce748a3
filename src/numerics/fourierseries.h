/* Closed curves, and vectors along them, as trigonometric polynomials.

   n points (x_j, y_j) of a closed curve are complex numbers z_j = x_j + i y_j at t_j = 2 pi j/n. The series through
   them is

       z(t) = SUM hat_k e^{ikt},   k = -n/2 .. n/2,

   and of an even n the highest mode belongs to both ends by halves. t may be complex: near-singular integrals along the
   curve take the point of the complex plane where z(t) is a given point off the curve.

   All functions work on one rank. */
#pragma once
#include "base/base.h"
#include <complex.h>

/* A point of the plane as a complex number. */
typedef double complex Point;

/* FourierSeriesModes - hat[n + 1] of the points a[2n]; n/2 is rounded down, hat[n/2 + k] is mode k. Not collective. */
PETSC_EXTERN void FourierSeriesModes(PetscInt n, const PetscReal a[], Point hat[]);

/* FourierSeriesAt - z(t), and its derivative by t. Not collective. */
PETSC_EXTERN Point FourierSeriesAt(PetscInt n, const Point hat[], Point t, Point *slope);
