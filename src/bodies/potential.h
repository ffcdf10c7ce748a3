/* A potential between the points of different membranes, of a reach that is not small beside a vesicle: molecules that
   draw vesicles together, such as dextran (Quaife, Veerapaneni and Young, Phys. Rev. Fluids 4, 103601, 2019). With z
   the distance of two points, that of the nearest image where the box has periods,

       phi(z) = H [ (d/z)^m - (m/n) (d/z)^n ],      m > n,      least at z = d,
       E      = SUM over pairs of membranes INT INT phi ds ds'.

   Lengths ds are those at rest; the sums are over markers. A step takes the force at the extrapolated markers X*.
   Forces of walls and obstacles are those of repulsion.h. */
#pragma once
#include "bodies/force.h"
