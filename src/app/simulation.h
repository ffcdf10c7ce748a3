/* What a simulation is made of: for simulation.c, which runs it, and api.c, which answers questions about it. */
#pragma once
#include "output/output.h"
#include "output/spaceoutput.h"

struct _p_Simulation {
  Scene scene;
  Fluid fluid;
  Layout all;          /* vesicles, then obstacles */
  Layout layout;       /* vesicles */
  Obstacles obstacles; /* NULL without */
  Membrane membrane;
  Coupling coupling;
  Scheme scheme;
  Output output;
  Space space; /* of a scene in three dimensions, which has nothing between fluid and output; else NULL */
  SpaceOutput space_output;
  PetscReal *gathered[3]; /* SimulationGatherMarkers: markers, velocity, tension; NULL before */
  PetscBool begun;        /* the initial state has been written */
  PetscBool steady;       /* after the last step */
  PetscReal longest_step; /* wall seconds, with its output */
  const char *reason;     /* why SimulationAdvance did not step */
};
