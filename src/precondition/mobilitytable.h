/* The mobility of two markers on the grid as a smooth function of their distance (docs/solver.md, Preconditioner).

   A solve for a unit force on one face of a periodic box of the run's cells gives the grid's Green's function G by
   offsets of faces. Two kernels at markers i and j make SUM SUM w_i G w_j of it; the mean of these sums over the places
   in a cell, by whole cells between the markers, is a second table, which is interpolated.

   The solves are collective; every rank has the tables. */
#pragma once
#include "mobility/boxgrid.h"
#include "fluid/stokes/stokes.h"

typedef struct _p_MobilityTable *MobilityTable;
struct _p_MobilityTable {
  const Kernel *kernel;
  Fluid periodic;    /* a periodic box of the same cells */
  PetscReal alpha;   /* coefficient of H that the tables are for; negative: none yet */
  OffsetTable green; /* its Green's function, by offsets of faces */
  OffsetTable mean;  /* of two markers' mobility, by whole cells between them */
};

/* MeanTableCreate - the mean over the places in a cell of the sums over two kernels, by whole cells between them, from
   the table of a function of offsets. MeanTableAt - its value some cells apart: xx, yy, xy. Beyond the table its
   border. Not collective. */
PETSC_EXTERN PetscErrorCode MeanTableCreate(const OffsetTable *green, const Kernel *kernel, OffsetTable *mean);
PETSC_EXTERN void MeanTableAt(const OffsetTable *mean, const PetscReal cells[2], PetscReal value[3]);

/* MobilityTableCreate - for the grid that spec makes and markers up to `reach` (length) apart. Collective. */
PETSC_EXTERN PetscErrorCode MobilityTableCreate(const FluidSpec *spec, const Kernel *kernel, PetscReal reach,
                                                MobilityTable *table);
PETSC_EXTERN PetscErrorCode MobilityTableDestroy(MobilityTable *table);

/* MobilityTableSetUp - for the fluid's coefficient alpha of H = alpha I - nu L_u (0 in quasi-steady flow: made once).
   Collective. */
PETSC_EXTERN PetscErrorCode MobilityTableSetUp(MobilityTable table, PetscReal alpha);

/* MobilityTableAdd - the mean mobility of two markers d (length) apart, velocity per force on the faces, times scale,
   added to the two rows and columns of a matrix from A on, whose columns are `rows` numbers apart. Not collective. */
PETSC_EXTERN void MobilityTableAdd(MobilityTable table, PetscReal scale, const PetscReal d[2], PetscInt rows,
                                   PetscReal A[]);
