/* Curves nearer to one another, or to an image in a wall, than their markers are: kernels between them need finer
   points. A curve at f n points instead of n markers is P x, P an interpolation (curve/kind.h), trigonometric where the
   curve repeats. A kernel K between two curves becomes

       P_a^T K_fine P_b/(f_a f_b),

   symmetric under exchange of the curves where K is. Only near pairs need this: what is exchanged in a block is

       chi(r) K on finer points less chi(r) K on the markers,

   chi a window from 1 to 0 over some marker spacings. Nothing crosses ranks.

   FinePairMake or FinePairsAtWalls says how fine and how wide, then FinePairParts gives the difference. */
#pragma once
#include "layers/layersetting.h"
#include "layers/wallimage.h"

/* Two bodies, the column's moved by `shift` (length) and, with a wall, mirrored there. */
typedef struct {
  PetscInt row, column;
  PetscReal shift[2];
  int wall;         /* 2 times the direction of its normal plus its side; -1: none */
  PetscInt factor;  /* finer points a marker */
  PetscReal window; /* (length) beyond which chi is zero */
} FinePair;

/* FinePairMake - for curves with this gap (length). FinePairGap - the gap of two curves whose markers come as near as
   gap (length): that of finer points where it may need any, else as it is; returns whether it does, by `close`.
   FinePairsAtWalls - `count` pairs of two bodies within these bounds at the walls where images are nearer than two
   marker spacings, of closed curves only: the first marker of an open one is half a spacing off its wall. Not
   collective. */
PETSC_EXTERN FinePair FinePairMake(const LayerSetting *set, PetscInt row, PetscInt column, const PetscReal shift[2],
                                   PetscReal gap);
PETSC_EXTERN PetscErrorCode FinePairGap(const LayerSetting *set, PetscInt row, PetscInt column,
                                        const PetscReal shift[2], PetscReal *gap, PetscBool *close);
PETSC_EXTERN void FinePairsAtWalls(const LayerSetting *set, const NearBounds bounds[], PetscInt row, PetscInt column,
                                   const PetscReal shift[2], FinePair pair[4], PetscInt *count);

/* A kernel of so many parts between curves: K[parts] at four points x of the row's curve, of the point y of the
   column's with N there; wall as in FinePair, y being mirrored. */
#define FINE_PARTS 4 /* at most */
typedef struct {
  int parts;
  void (*at)(const void *context, int wall, const Lanes x[2], const PetscReal y[2], const PetscReal N[2], Lanes K[]);
  const void *context;
  const PetscReal *normal; /* [2 n_column] N at the markers, which finer points interpolate; NULL: no N */
} FineKernel;

/* FinePairParts - part[parts][n_column][n_row] = chi K on finer points less chi K on the markers. Not collective. */
PETSC_EXTERN PetscErrorCode FinePairParts(const LayerSetting *set, const FinePair *pair, const FineKernel *kernel,
                                          PetscReal part[]);
