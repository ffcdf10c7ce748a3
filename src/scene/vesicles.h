/* The vesicles of a scene: their kinds, their places and their initial markers; and its solid bodies. Equal vesicles
   share one curve and the markers fitted to it, so that a scene of many starts in the time of its kinds. */
#pragma once
#include "curve/packing.h"
#include "scene/spec.h"

typedef struct {
  Curve curve;        /* about the origin, or where its file has it */
  PetscReal pivot[2]; /* about which it is turned: the origin, or the centroid of a file's curve */
  PetscReal given[2]; /* area and reduced area, or both semi-axes: not of a file's curve */
  PetscReal length, area;
  Material material;
  PetscInt M;      /* markers, 0 before KindFit */
  PetscReal *X;    /* [2M] */
  PetscReal *rest; /* [2M] of the shape at rest; NULL: X */
} Kind;

typedef struct {
  PetscInt vesicles, kinds;
  PetscInt *of; /* [vesicles] the kind of each */
  Kind *kind;   /* [kinds] */
} Kinds;

/* KindsCreate - the kinds of a scene from its options, with their curves: how many vesicles a packing takes, which
   entry of the lists each of a mixture; ellipses and outlines that are equal in all are one kind, each curve of a file
   is one. The rate or peak velocity of the flow follows from -flow_chi (chi c_b/(nu R0^3)), -flow_ca (Ca c_b/(nu R0^2))
   or -flow_ca_stretching (Ca E_s/(nu R0)), R0 of the largest vesicle and the largest modulus. What this leaves in the
   scene SceneDropShape takes.
   KindFit - the markers of a kind: their number, and equal edges, of the shape at rest too. Collective; stop with the
   user's message on a bad file, list, number of markers, spacing, or a flow without vesicles that bend. */
PETSC_EXTERN PetscErrorCode KindsCreate(Draft scene, Kinds *kinds);
PETSC_EXTERN PetscErrorCode KindsDestroy(Kinds *kinds);
PETSC_EXTERN PetscErrorCode KindFit(Scene scene, Kind *kind);

/* ScenePlace (packed.c) - pose[vesicles] by -vesicle_center and -vesicle_angle, or packed, together with the posts that
   are packed. Collective; stops with the user's message when there is no room. */
PETSC_EXTERN PetscErrorCode ScenePlace(Draft scene, const Kinds *kinds, Pose pose[]);

/* SceneMakeShape - the initial markers of the scene's vesicles, all edges of a vesicle equal to 1e-12, and their
   materials. Every rank gets all of it. Collective; stops with the user's message on a bad file, spacing or
   position, and when a packing has no room. SceneDropShape - what it has made is gone, so that it can be made anew. */
PETSC_EXTERN PetscErrorCode SceneMakeShape(Draft scene);
PETSC_EXTERN PetscErrorCode SceneDropShape(Draft scene);

/* SceneMakeObstacles (obstacles.c) - the markers of the scene's obstacles, equally spaced, and what their surfaces do;
   that the rest of the scene goes with them. The vesicles are known. Collective; stops with the user's message.
   SceneDropObstacles - free them. */
PETSC_EXTERN PetscErrorCode SceneMakeObstacles(Draft scene);
PETSC_EXTERN PetscErrorCode SceneDropObstacles(Draft scene);

/* KindExtend - make the rectangle around[4] of CurveBounds hold a kind's curve, turned and moved. Not collective. */
PETSC_EXTERN void KindExtend(const Kind *kind, const Pose *at, PetscReal around[4]);
