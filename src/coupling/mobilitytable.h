/* The grid's Green's function in a periodic box of the run's cells, by offsets of faces, and the mean over places in a
   cell of what two kernels make of it: the mobility of two markers as a smooth function of their distance
   (docs/solver.md, Preconditioner). */
#pragma once
#include "coupling/offsets.h"
#include "fluid/stokes.h"

typedef struct _p_MobilityTable *MobilityTable;
struct _p_MobilityTable {
  const Kernel *kernel;
  Fluid periodic; /* a periodic box of the same cells */
  Stokes stokes;  /* its solver with a work vector, kept on few cells; else NULL between set-ups */
  Vec u;
  PetscReal alpha;   /* coefficient of H that the tables are for; negative: none yet */
  OffsetTable green; /* its Green's function, by offsets of faces */
  OffsetTable mean;  /* of two markers' mobility, by whole cells between them, once asked for */
  PetscBool averaged;
  PetscReal *line; /* work */
};

/* MobilityTableCreate - for the grid that spec makes and markers up to `reach` (length) apart. Collective. */
PETSC_EXTERN PetscErrorCode MobilityTableCreate(const FluidSpec *spec, const Kernel *kernel, PetscReal reach,
                                                MobilityTable *table);
PETSC_EXTERN PetscErrorCode MobilityTableDestroy(MobilityTable *table);

/* MobilityTableSetUp - for the fluid's coefficient alpha of H = alpha I - nu L_u (0 in quasi-steady flow: made once).
   Collective. */
PETSC_EXTERN PetscErrorCode MobilityTableSetUp(MobilityTable table, PetscReal alpha);

/* MobilityTableMean - of two markers d (length) apart, velocity per force on the faces: xx, yy, xy. Beyond the table
   its border. Not collective. */
PETSC_EXTERN void MobilityTableMean(MobilityTable table, const PetscReal d[2], PetscReal mean[3]);
