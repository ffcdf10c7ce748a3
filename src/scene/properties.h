/* Numbers that follow from the options of a scene: of a vesicle, times, and which parts the method has. */
#pragma once
#include "curve/contacts.h"
#include "scene/spec.h"

/* SceneKindOf - the entry of the options' lists that a vesicle takes: its own number, or with -vesicle_mixture that of
   its kind. Not collective. */
PETSC_EXTERN PetscInt SceneKindOf(Scene scene, PetscInt vesicle);

#define SCENE_FILM 0.6 /* marker spacings: the thickness of a thinner film is off by 1 %, now or as it thins */

/* SceneRoom - box, periods and walls, as curves see them. Not collective. */
PETSC_EXTERN CurveRoom SceneRoom(Scene scene);

/* SceneByArea - whether the vesicles are given by area and reduced area. Not collective. */
PETSC_EXTERN PetscBool SceneByArea(Scene scene);

/* SceneHasGravity - whether it pulls at a vesicle. SceneWeight - density difference times gravity of one vesicle, in
   direction dir (length/time^2). Not collective. */
PETSC_EXTERN PetscBool SceneHasGravity(Scene scene);
PETSC_EXTERN PetscReal SceneWeight(Scene scene, PetscInt vesicle, int dir);

/* SceneHasContrast - whether a vesicle's inner fluid has another viscosity than the outer one. SceneViscosityRatio - of
   one vesicle, inner over outer. Not collective. */
PETSC_EXTERN PetscBool SceneHasContrast(Scene scene);
PETSC_EXTERN PetscReal SceneViscosityRatio(Scene scene, PetscInt vesicle);

/* SceneHasInertia (inertia.c) - whether -fluid_inertia, or what auto stands for when the largest vesicle has this
   radius (0: none), has inertia, and why; the flow is known. Not collective. */
PETSC_EXTERN PetscBool SceneHasInertia(Scene scene, PetscReal R0, const char **why);

/* SceneIsProjection - whether the scheme is one of the baselines, split or penalty, which stand on a projection step.
   SceneHasAreaTarget - whether each step aims at the first areas of the vesicles: coupled, but for the finite
   differences of the paper's membrane. SceneHasBoxPart - whether the near field has its box part: asked for, and no
   period too long. Not collective. */
PETSC_EXTERN PetscBool SceneIsProjection(Scene scene);
PETSC_EXTERN PetscBool SceneHasAreaTarget(Scene scene);
PETSC_EXTERN PetscBool SceneHasBoxPart(Scene scene);

/* SceneSmallestRadius, SceneLargestRadius - R0 of a vesicle (length). SceneMembraneTime - nu R0^3/c_b of vesicle v;
   PETSC_MAX_REAL without bending. SceneRestTime - the least nu R0^3/c_b of a vesicle. SceneFlowStep - up to which
   -time_adapt error lets steps grow in a flow when nothing changes (time): 1/(rate (1 + 0.03 chi)), which fixed steps
   from an ellipse still bear (docs/time.md), chi = rate nu R0^3/c_b of the softest vesicle, at most 250; PETSC_MAX_REAL
   without a known rate. Not collective. */
PETSC_EXTERN PetscReal SceneSmallestRadius(Scene scene);
PETSC_EXTERN PetscReal SceneLargestRadius(Scene scene);
PETSC_EXTERN PetscReal SceneMembraneTime(Scene scene, PetscInt v);
PETSC_EXTERN PetscReal SceneRestTime(Scene scene);
PETSC_EXTERN PetscReal SceneFlowStep(Scene scene);
