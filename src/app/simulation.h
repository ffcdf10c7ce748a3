/* What a simulation is made of: for simulation.c, which runs it, and api.c, which answers questions about it. */
#pragma once
#include "output/output.h"
#include "plane/plane.h"

struct _p_Simulation {
  Scene scene;
  Model model; /* of the plane or of space */
  Output output;
  PetscReal *gathered[3]; /* SimulationGatherMarkers: markers, velocity, tension; NULL before */
  PetscBool begun;        /* the initial state has been written */
  PetscBool steady;       /* after the last step */
  PetscReal longest_step; /* wall seconds, with its output */
  const char *reason;     /* why SimulationAdvance did not step */
};
