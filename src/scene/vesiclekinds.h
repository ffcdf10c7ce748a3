/* Kinds of vesicles: equal vesicles share one curve and the markers fitted to it, so that a scene of many starts in the
   time of its kinds. */
#pragma once
#include "scene/mixture.h"

typedef struct {
  Curve curve;        /* about the origin, or where its file has it */
  PetscReal pivot[2]; /* about which it is turned: the origin, or the centroid of a file's curve */
  PetscReal length, area, bending;
  PetscInt M;   /* markers, 0 before KindFit */
  PetscReal *X; /* [2M] */
} Kind;

typedef struct {
  PetscInt vesicles, kinds;
  PetscInt *of; /* [vesicles] the kind of each */
  Kind *kind;   /* [kinds] */
} Kinds;

/* KindsCreate - the kinds of the scene's vesicles, with their curves: ellipses and outlines that are equal in all are
   one kind, each curve of a file is one. KindFit - the markers of a kind: their number, and equal edges. Collective;
   stop with the user's message on a bad file, list, number of markers or spacing. */
PETSC_EXTERN PetscErrorCode KindsCreate(Scene scene, Kinds *kinds);
PETSC_EXTERN PetscErrorCode KindsDestroy(Kinds *kinds);
PETSC_EXTERN PetscErrorCode KindFit(Scene scene, Kind *kind);

/* SceneMakeKinds - the kinds of a scene from its options: how many a packing takes, which entries of a mixture, their
   curves. What it leaves in the scene SceneDropShape takes. Collective; errors as KindsCreate's. */
PETSC_EXTERN PetscErrorCode SceneMakeKinds(Draft scene, Kinds *kinds);

/* KindExtend - make the rectangle around[4] (x_min, x_max, y_min, y_max; KIND_NOWHERE is empty) hold a kind's curve,
   turned and moved. Not collective. */
#define KIND_NOWHERE                                                                                                   \
  { PETSC_MAX_REAL, -PETSC_MAX_REAL, PETSC_MAX_REAL, -PETSC_MAX_REAL }
PETSC_EXTERN void KindExtend(const Kind *kind, const Pose *at, PetscReal around[4]);

/* ScenePlace - where the vesicles lie: pose[vesicles] by -vesicle_center and -vesicle_angle, or packed. With
   -vesicle_packing SceneCountPacked has chosen -vesicle_count, or the area, by the fraction before. Collective; stop
   with the user's message when there is no room. */
PETSC_EXTERN PetscErrorCode SceneCountPacked(Draft scene);
PETSC_EXTERN PetscErrorCode ScenePlace(Scene scene, const Kinds *kinds, Pose pose[]);
