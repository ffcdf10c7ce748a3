/* Bending of membranes that stretch, by one of two energies in place of the quadratic one of bending.h. By the length
   at rest s, with

       a = X_s,   b = X_ss,   lambda = |a|,   theta = (a x b)/lambda^2,   the curvature times lambda,

   and kappa0 the curvature of the rest shape with a shape memory, else 0,

       E_B = c_b/2 INT r^2 ds,      r = (theta - kappa0 lambda^p) lambda^(-p/2),

       angle      p = 0   the angle by which a piece turns, as in a beam
       helfrich   p = 1   (kappa - kappa0)^2 of each piece of the stretched membrane

   The sum is over twice as many points as markers: on the markers alone products of the Fourier series alias and make
   waves. With the change Q V of r that a motion V makes, a step takes minus the force at the new markers X by the
   matrix N of Gauss and Newton,

       grad E_B(X*) + N (X - X*),      N = c_b Q^T Q ds. */
#pragma once
#include "bodies/force.h"
