/* Gravity (docs/membrane.md, Gravity). With the hydrostatic pressure of each fluid taken off, the jump of these
   pressures across the membrane is a normal force, n outward,

       (weight.(X - centroid)) n ds,

   whose sum over the markers is weight times the area, without torque. Its energy is

       -weight . INT x dA. */
#pragma once
#include "bodies/force.h"

PETSC_EXTERN PetscErrorCode ForceCreate_Gravity(Bodies bodies, Grid grid, Scene scene, Force *force);
