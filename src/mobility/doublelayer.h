/* The double layer of membranes whose inner fluid has another viscosity than the outer one (docs/contrast.md). v, the
   velocity outside and the ratio times the velocity inside, is a field of the outer viscosity that jumps by J = (1 -
   ratio) U at a membrane that moves with U: a sheet of tensor dipoles J n + n J with the source J.n. The markers'
   velocities obey

       (1 + ratio)/2 U = u_inf + E v' + C f + C_D J,      C_D = DL - DL_h Pi,

   DL the exact double layer of unbounded fluid, DL_h what the same dipoles give on the infinite lattice, Pi what takes
   the net flux off a vesicle's J, as spreading on the grid does (nearblock.h). Its pairs of bodies are those of the
   near field (nearfield.h). In unbounded fluid DL_h = 0. Every rank gathers all of J.

   Create, perhaps AddBoxPart, Place where the near field has been placed, Set the jump, then Apply, Spread, Rows. */
#pragma once
#include "mobility/boxpart.h"
#include "mobility/nearfield.h"
#include "markers/dipolerows.h"

typedef struct _p_DoubleLayer *DoubleLayer;
struct _p_DoubleLayer {
  NearField near;   /* borrowed: markers, membranes, their pairs and stencils */
  PetscReal *ratio; /* [vesicles] viscosity inside over that outside */
  OffsetTable lattice[2];
  LayerPairs pairs;
  PaddedStencil *dipole; /* [DIPOLE_COUNT M] unfolded; */
  Stencil *spot;         /* [DIPOLE_SPOTS M] on the grid, zero where there is no jump; */
  StencilRows list;      /* these by rows; spots and rows not in unbounded fluid */
  PetscReal *normal;     /* [2M] outward n times the marker's share w of the length */
  PetscReal *along;      /* [M] w (length); of vesicles of ratio 1 these are not made */
  PetscReal *length;     /* [vesicles] sum of w */
  NearBlock *block;
  NearStore store;
  PetscInt blocks;
  size_t block_room, values;
  PetscScalar *velocity; /* [2n] work */
  PetscScalar *jump;     /* [2M] work: J of all markers, less its flux, */
  PetscScalar *plain;    /* [2M] J, */
  PetscReal *tensor;     /* [DIPOLE_COUNT M] and the dipoles of the former */
  BoxPart box;           /* NULL without box part */
  PetscLogEvent place, apply;
};

/* DoubleLayerCreate - for membranes with a near field and ratio[vesicles] (copied). Collective. */
PETSC_EXTERN PetscErrorCode DoubleLayerCreate(NearField near, const PetscReal ratio[], DoubleLayer *layer);
PETSC_EXTERN PetscErrorCode DoubleLayerDestroy(DoubleLayer *layer);

/* DoubleLayerAddBoxPart - from here on with the box part for the fluid that spec makes. DoubleLayerPlace - C_D where
   the near field has been placed (NearFieldPlace). Collective. */
PETSC_EXTERN PetscErrorCode DoubleLayerAddBoxPart(DoubleLayer layer, const FluidSpec *spec);
PETSC_EXTERN PetscErrorCode DoubleLayerPlace(DoubleLayer layer);

/* In what follows the jump is that of the vesicles' markers that move with U. Collective.

   DoubleLayerApply - y += alpha (C_D J and the box part of its dipoles), this rank's part y[2n] of a marker vector of
   all bodies.

   DoubleLayerMean - mean += the mean velocity v' that goes with no mean of the fluid's own, -(1/box) SUM w X (J.n); not
   in unbounded fluid.

   DoubleLayerSpread - f += the force of J's dipoles, its source += G^T of the velocity that is their source, its mean
   += DoubleLayerMean, which a box that is periodic both ways, or a channel without flux, has with them: the one without
   flow outside a moving rigid body. Nothing in unbounded fluid.

   DoubleLayerRows - the same dipoles as rows of a solve by stream function, with their mean velocity, and unless their
   force is spread already their own; profile: that of the Stokes solve (StreamProfile).

   DoubleLayerStress - sum[3] (xx, yy, xy) += minus nu INT (J n + n J) ds of J less its flux: what the dipoles add to
   the sum of force times place; shortfall[2] (u, v) += what their stencils lack of it across a channel along x
   (DipoleShortfall). */
PETSC_EXTERN PetscErrorCode DoubleLayerApply(DoubleLayer layer, PetscReal alpha, Vec U, PetscScalar y[]);
PETSC_EXTERN PetscErrorCode DoubleLayerMean(DoubleLayer layer, Vec U, PetscReal mean[2]);
PETSC_EXTERN PetscErrorCode DoubleLayerSpread(DoubleLayer layer, Vec U, Forcing *f);
PETSC_EXTERN PetscErrorCode DoubleLayerRows(DoubleLayer layer, Vec U, PetscBool own, const PetscReal profile[],
                                            DipoleRows rows);
PETSC_EXTERN PetscErrorCode DoubleLayerStress(DoubleLayer layer, Vec U, PetscReal sum[3], PetscReal shortfall[2]);

/* DoubleLayerAdd - out += scale C_D (1 - ratio) (without box part) or, without lattice, D (1 - ratio), between the
   markers first .. first + n - 1: out[2n][2n], columns one after another, the rows of own markers only. Not collective.
 */
PETSC_EXTERN PetscErrorCode DoubleLayerAdd(DoubleLayer layer, PetscReal scale, PetscBool lattice, PetscInt first,
                                           PetscInt n, PetscReal out[]);
