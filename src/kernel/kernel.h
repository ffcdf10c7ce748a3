/* Regularised delta functions between grid and markers (docs/membrane.md, Kernels): tensor products of 1-D weights,

       phi_along(x - i) phi_across(y - j),

   phi_along in the direction of the velocity component, phi_across in the other one. x and y are in cells, and the
   weights at the grid points add up to 1. All functions work on one rank. */
#pragma once
#include "base/base.h"

#define KERNEL_MAX_POINTS 6
#define KERNEL_WALL_CELLS 3 /* cells that markers keep from walls: the reach of the kernels */
#define KERNEL_FOLDED_CELLS                                                                                            \
  0.25 /* cells that markers keep from walls where stencils are folded (markers/wallfold.h)                            \
        */

/* The kernels: ib6 of Bao, Kaye and Peskin (2016), the composite B-spline cbs54 of Gruninger and Griffith (2025). A row
   has the name; the weights along and across; the marker spacing ds/h that suits the kernel; the spacing below which
   the tension problem is near singular; and a, b of the stiffest springs that explicit steps bear, as measured
   (docs/split.md),

     a nu h/dt + b h^3/dt^2. */
/* clang-format off */
#define KERNELS(ROW, BETWEEN)                              \
  ROW(ib6, IB6, IB6, 1.75, 1.25, 50, 100) BETWEEN          \
  ROW(cbs54, KernelSpline5, KernelSpline4, 1.5, 1, 19, 12)
/* clang-format on */

/* Texts of the table for the option table: names "a|b", spacings that suit and least spacings "a 1.75, b 1.25". */
#define KERNEL_NAME(name, along, across, spacing, least, a, b) #name
#define KERNEL_SPACING(name, along, across, spacing, least, a, b) #name " " #spacing
#define KERNEL_LEAST(name, along, across, spacing, least, a, b) #name " " #least
#define KERNEL_NAMES KERNELS(KERNEL_NAME, "|")
#define KERNEL_SPACINGS KERNELS(KERNEL_SPACING, ", ")
#define KERNEL_LEAST_SPACINGS KERNELS(KERNEL_LEAST, ", ")

/* Weights phi(x - j) at the grid points j = first .. first + n - 1 of a coordinate x in cells; returns n. */
typedef PetscInt (*KernelWeights)(PetscReal x, PetscInt *first, PetscReal weights[KERNEL_MAX_POINTS]);

/* KernelSpline4, 5, 6 - the weights of the cardinal B-splines of 4, 5 and 6 points. Not collective. */
PETSC_EXTERN PetscInt KernelSpline4(PetscReal x, PetscInt *first, PetscReal weights[]);
PETSC_EXTERN PetscInt KernelSpline5(PetscReal x, PetscInt *first, PetscReal weights[]);
PETSC_EXTERN PetscInt KernelSpline6(PetscReal x, PetscInt *first, PetscReal weights[]);

typedef struct {
  const char *name;
  KernelWeights along, across; /* along the component's own direction, across it */
  PetscReal default_spacing;   /* marker spacing ds/h that suits the kernel */
  PetscReal least_spacing;     /* spacing below which the tension problem is near singular */
  PetscReal spring[2];         /* a and b of the stiffest springs */
} Kernel;

/* KernelFind - kernel by name; NULL: there is none. Not collective. */
PETSC_EXTERN const Kernel *KernelFind(const char name[]);

/* KernelSecondMoment - at every place x, for kernels of three points and more,

     SUM_j phi(x - j) (x - j)^2.

   KernelMoments - moment[m], m < count, the means over all places x in a cell of

     SUM_j phi(x - j) (x - j)^{2m}.

   Not collective. */
PETSC_EXTERN PetscReal KernelSecondMoment(KernelWeights weights);
PETSC_EXTERN void KernelMoments(KernelWeights weights, int count, PetscReal moment[]);
