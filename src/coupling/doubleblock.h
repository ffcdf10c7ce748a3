/* The numbers of the double layer: pairs of markers. */
#pragma once
#include "coupling/doublelayer.h"

#define DOUBLE_CELLS 16      /* up to which pairs' stencils are summed; farther, a closed form, right to 2e-5 of D */
#define DOUBLE_FACE_CELLS 30 /* up to which markers share a dipole's faces */

/* DoubleBlockFill - C_D (or, without lattice, D) of a block, [2 n_column][2 n_row]. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleBlockFill(DoubleLayer layer, const DoubleBlock *block, PetscBool lattice,
                                            PetscReal value[]);

/* DoubleSelf - D of a closed curve with itself from its n markers X and their n w: [2n][2n]. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleSelf(Spectral spectral, PetscInt n, const PetscReal X[], const PetscReal normal[],
                                       PetscReal D[]);

/* DoubleGeometry - n w [2n] and w [n] of a curve's markers: the derivative by the label, turned. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleGeometry(Spectral spectral, PetscInt n, const PetscReal X[], PetscReal normal[],
                                           PetscReal along[]);

/* DoubleLatticeParts - what the lattice's tables (LatticeDipoles) give of unit parts of a dipole at a marker,
   K[component of the velocity][part]: responses' and dipole's stencils, `cells` added to their offset, d from source to
   target (length); beyond `reach` by the closed form. Not collective. */
PETSC_EXTERN void DoubleLatticeParts(const OffsetTable lattice[2], PetscReal h, PetscReal reach,
                                     const PaddedStencil response[2], const PaddedStencil dipole[DIPOLE_COUNT],
                                     const PetscInt cells[2], const PetscReal d[2], PetscReal K[2][DIPOLE_COUNT]);
