/* What the functions of pairs of markers, of curves and of images in walls need of a run. Nothing here crosses ranks:
   every rank has the markers of all. */
#pragma once
#include "bodies/bodies.h"
#include "layers/boxaxis.h"
#include "markers/markers.h"

typedef struct {
  Markers markers;    /* with their grid and their regularised delta function, borrowed */
  Bodies bodies;      /* the curves on which the markers are, borrowed; NULL: single points */
  PetscReal nu;       /* viscosity (length^2/time, density 1) */
  PetscReal unit;     /* length whose logarithm is zero */
  const BoxAxis *box; /* [2] with a box part: pairs are of nearest images and fade over a period (BoxImage); or NULL */
} LayerSetting;
