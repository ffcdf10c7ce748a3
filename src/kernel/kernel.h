/* Regularised delta functions: tensor products of 1-D weights, one along a component's own direction, one across
   (docs/method.md, Kernels). */
#pragma once
#include "base/base.h"

#define KERNEL_MAX_POINTS 6

/* Weights phi(x - j) at the grid points j = first .. first + n - 1 of a coordinate x in cells; returns n. */
typedef PetscInt (*KernelWeights)(PetscReal x, PetscInt *first, PetscReal weights[KERNEL_MAX_POINTS]);

typedef struct {
  const char *name;
  KernelWeights along, across; /* along the component's own direction, across it */
  PetscReal default_spacing;   /* marker spacing ds/h that suits it */
  PetscReal least_spacing;     /* below it the tension problem is near singular */
} Kernel;

/* KernelFind - kernel by name: ib6 (Bao, Kaye, Peskin 2016), cbs32, cbs43, cbs54, cbs65 (Gruninger, Griffith 2025);
   NULL when unknown. */
PETSC_EXTERN const Kernel *KernelFind(const char name[]);
