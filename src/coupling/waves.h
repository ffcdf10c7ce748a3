/* A few functions of the markers of a curve: waves along it, and the coefficients of what is smooth there from its
   values at some of the markers. */
#pragma once
#include "curve/kind.h"

typedef struct {
  PetscInt n, count; /* markers, functions */
  PetscReal *value;  /* [count][n] orthonormal */
  PetscInt places;   /* markers that coefficients are had from */
  PetscInt *place;   /* [places] */
  PetscReal *fit;    /* [count][places] the least squares' weights */
} Waves;

/* WavesCreate - of a curve of n markers: the constant, cosines and sines; of an open one cosines with level ends. count
   is odd and at most n. Not collective. */
PETSC_EXTERN PetscErrorCode WavesCreate(PetscBool open, PetscInt n, PetscInt count, Waves *waves);
PETSC_EXTERN PetscErrorCode WavesDestroy(Waves *waves);

/* WavesOf - coefficients a[2 count] of x[2n], two numbers a marker. WavesSum - x = SUM of a's functions. Not
   collective. */
PETSC_EXTERN void WavesOf(const Waves *waves, const PetscReal x[], PetscReal a[]);
PETSC_EXTERN void WavesSum(const Waves *waves, const PetscReal a[], PetscReal x[]);
