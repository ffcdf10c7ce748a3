/* Regularised delta functions between grid and markers: tensor products of 1-D weights, one along a component's own
   direction, one across (docs/membrane.md, Kernels). */
#pragma once
#include "base/base.h"

#define KERNEL_MAX_POINTS 6
#define KERNEL_WALL_CELLS 3      /* cells that markers keep from walls: the kernels' reach; */
#define KERNEL_FOLDED_CELLS 0.25 /* or where stencils are folded at walls (markers/fold.h) */

/* The kernels: ib6 of Bao, Kaye and Peskin (2016), the composite B-splines of Gruninger and Griffith (2025). Name;
   weights along and across; marker spacing ds/h that suits it; spacing below which the tension problem is near
   singular; a, b of the stiffest springs a nu h/dt + b h^3/dt^2 that explicit steps bear, as measured (docs/split.md:
   ib6 smooths the markers' own motion more than the others, of which cbs32 bears least). */
/* clang-format off */
#define KERNELS(ROW, BETWEEN)                                    \
  ROW(ib6, IB6, IB6, 1.75, 1.25, 50, 100) BETWEEN                \
  ROW(cbs32, BSpline3, BSpline2, 1.25, 1, 19, 12) BETWEEN        \
  ROW(cbs43, BSpline4, BSpline3, 1.5, 1, 19, 12) BETWEEN         \
  ROW(cbs54, BSpline5, BSpline4, 1.5, 1, 19, 12) BETWEEN         \
  ROW(cbs65, BSpline6, BSpline5, 1.5, 1, 19, 12)
/* clang-format on */

/* Texts of the table, constants for the option table: "a|b", "a 1.75, b 1.25" (spacing that suits, least spacing). */
#define KERNEL_NAME(name, along, across, spacing, least, a, b) #name
#define KERNEL_SPACING(name, along, across, spacing, least, a, b) #name " " #spacing
#define KERNEL_LEAST(name, along, across, spacing, least, a, b) #name " " #least
#define KERNEL_NAMES KERNELS(KERNEL_NAME, "|")
#define KERNEL_SPACINGS KERNELS(KERNEL_SPACING, ", ")
#define KERNEL_LEAST_SPACINGS KERNELS(KERNEL_LEAST, ", ")

/* Weights phi(x - j) at the grid points j = first .. first + n - 1 of a coordinate x in cells; returns n. */
typedef PetscInt (*KernelWeights)(PetscReal x, PetscInt *first, PetscReal weights[KERNEL_MAX_POINTS]);

typedef struct {
  const char *name;
  KernelWeights along, across; /* along the component's own direction, across it */
  PetscReal default_spacing;   /* marker spacing ds/h that suits it */
  PetscReal least_spacing;     /* below it the tension problem is near singular */
  PetscReal spring[2];         /* the step bears springs up to sigma_0 = spring[0] nu h/dt + spring[1] h^3/dt^2 */
} Kernel;

/* KernelFind - kernel by name, NULL when unknown. */
PETSC_EXTERN const Kernel *KernelFind(const char name[]);

/* KernelSecondMoment - SUM phi(x - j) (x - j)^2, the same at every place x but for cbs32. Not collective. */
PETSC_EXTERN PetscReal KernelSecondMoment(KernelWeights weights);

/* KernelMoments - moment[m], m < count, the mean over all places x in a cell of SUM phi(x - j) (x - j)^{2m}. Not
   collective. */
PETSC_EXTERN void KernelMoments(KernelWeights weights, int count, PetscReal moment[]);
