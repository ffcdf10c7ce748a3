/* The steps of SceneCreate, the only ones that write to a scene. scene.c has them in their order. */
#pragma once
#include "curve/packing.h"
#include "scene/scene.h"

typedef struct _p_Scene *Draft; /* a scene that is not resolved yet */

/* SceneReadOptions - every option of the table, or its default. SceneChoose - give an option of the table a value that
   the user has not given: what was given stays. Collective. */
PETSC_EXTERN PetscErrorCode SceneReadOptions(MPI_Comm comm, Draft scene);
PETSC_EXTERN PetscErrorCode SceneChoose(Draft scene, const char name[], const char value[]);

/* SceneByArea - whether the vesicles are given by area and reduced area. Not collective. */
PETSC_EXTERN PetscBool SceneByArea(Scene scene);

/* SceneChooseByError - with -scheme_auto: scheme, order, tolerances, kernel and spacing for the error wanted.
   SceneChooseSteps - what depends on the vesicles: the steps. Collective. Errors: outside of what was measured, and
   for schemes that have no error control. */
PETSC_EXTERN PetscErrorCode SceneChooseByError(Draft scene);
PETSC_EXTERN PetscErrorCode SceneChooseSteps(Draft scene);

/* SceneChooseDomain - with -scheme_auto, where they are not given: a box as large as the error asks for, unless walls
   are part of the question, and a grid for the vesicles and their distance from walls. After the checks of lists,
   before the fluid is described. Collective. Errors: no square cells, or too many of them. */
PETSC_EXTERN PetscErrorCode SceneChooseDomain(Draft scene);

/* SceneChooseFlow - rate or peak velocity from -flow_chi or -flow_ca: rate = chi c_b/(nu R0^3), u_max = Ca c_b/(nu
   R0^2), R0 of the largest vesicle and the largest c_b, both known before there are markers (shape.longest,
   membrane.bending). Collective. Errors: both given, no bending, no vesicles. */
PETSC_EXTERN PetscErrorCode SceneChooseFlow(Draft scene);

/* SceneChooseMarkers - with -scheme_auto, where the user gives neither their number nor their spacing: more than the
   default where the start needs it, in steps of a fifth up to three times, and not closer than the near field bears;
   the shape is made anew. SceneSqueeze - nu R0^3/c_b times the rate at which the flow shortens a vesicle of the start
   along its length, the largest. SceneIsSqueezed - whether it wrinkles. SceneThinnestFilm - of the start, in marker
   spacings (2: none is thinner), and the error that it leaves, of its thickness over R0. Collective. */
PETSC_EXTERN PetscErrorCode SceneChooseMarkers(Draft scene);
PETSC_EXTERN PetscReal SceneSqueeze(Scene scene);
PETSC_EXTERN PetscBool SceneIsSqueezed(Scene scene);
PETSC_EXTERN PetscErrorCode SceneThinnestFilm(Scene scene, PetscReal *spacings, PetscReal *error);

/* SceneSmallestRadius - R0 of the smallest vesicle (length). SceneMembraneTime - nu R0^3/c_b of vesicle v;
   PETSC_MAX_REAL without bending. SceneTimes - the slowest and the fastest time of the
   scene, the least nu R0^3/c_b of a vesicle, and the least of it and the flow's; PETSC_MAX_REAL: none. Not collective.
 */
PETSC_EXTERN PetscReal SceneSmallestRadius(Scene scene);
PETSC_EXTERN PetscReal SceneMembraneTime(Scene scene, PetscInt v);
PETSC_EXTERN void SceneTimes(Scene scene, PetscReal *slow, PetscReal *fast);

/* SceneChooseOutput - -output_every where it is not given: for at most 100 frames, the first included. Collective. */
PETSC_EXTERN PetscErrorCode SceneChooseOutput(Draft scene);

/* SceneFlowStep - up to which -time_adapt error lets steps grow in a flow when nothing changes (time): 1/(rate (1 +
   0.03 chi)), which fixed steps from an ellipse still bear (docs/time.md), chi = rate nu R0^3/c_b of the
   softest vesicle, at most 250; PETSC_MAX_REAL without a known rate. SceneChooseLargestStep - make it the default; at
   rest the least nu R0^3/c_b of a vesicle, for the error that the area target leaves there. */
PETSC_EXTERN PetscReal SceneFlowStep(Scene scene);
PETSC_EXTERN PetscErrorCode SceneChooseLargestStep(Draft scene);

/* SceneIsProjection - whether the scheme is one of the baselines, split or penalty, which stand on a projection step.
   SceneChooseByScheme - their defaults. SceneChooseBoxPart - that of the box part, which goes by the grid.
   SceneChooseStiffness - penalty's springs, where none are given: half of what the step bears. */
PETSC_EXTERN PetscBool SceneIsProjection(Scene scene);
PETSC_EXTERN PetscErrorCode SceneChooseByScheme(Draft scene);
PETSC_EXTERN PetscErrorCode SceneChooseBoxPart(Draft scene);
PETSC_EXTERN PetscErrorCode SceneChooseStiffness(Draft scene);

/* SceneWishes - what is asked for by names that there are not. Not collective. */
PETSC_EXTERN const OptionWish *SceneWishes(void);

/* SceneCheck - checks that involve more than one option; SceneCheckCells - that cells are square. Collective. */
PETSC_EXTERN PetscErrorCode SceneCheck(Scene scene);
PETSC_EXTERN PetscErrorCode SceneCheckCells(Scene scene);

#define SCENE_MOST_FREE 30 /* vesicles in unbounded fluid: all pairs are summed, beyond it a large box is faster */

/* SceneCheckFree - that a scene in unbounded fluid (-domain_bc_x free) asks for nothing that needs a grid, nor for more
   vesicles than it is meant for; the vesicles are known. Collective. */
PETSC_EXTERN PetscErrorCode SceneCheckFree(Scene scene);

/* SceneCheckDivergence - that a custom flow has no divergence, by differences at points all over the box. Collective.
 */
PETSC_EXTERN PetscErrorCode SceneCheckDivergence(Scene scene);

/* SceneCheckGravity - gravity, density differences and the drive of a channel; the vesicles are known. Collective. */
PETSC_EXTERN PetscErrorCode SceneCheckGravity(Scene scene);

/* SceneCheckContrast - ratios of viscosities and what they can do without; the vesicles are known. Collective. */
PETSC_EXTERN PetscErrorCode SceneCheckContrast(Scene scene);

/* SceneMakeShape - the initial markers of the scene's vesicles, all edges of a vesicle equal to 1e-12, and their
   bending stiffnesses; before the markers, whose number goes by it, the flow from numbers that go by the vesicles.
   Every rank gets all of it. Collective; stops with the user's message on a bad file, spacing or position, and when a
   packing has no room. SceneDropShape - what it has made is gone, so that it can be made
   anew. */
PETSC_EXTERN PetscErrorCode SceneMakeShape(Draft scene);
PETSC_EXTERN PetscErrorCode SceneDropShape(Draft scene);

/* SceneMakeObstacles - the markers of the scene's obstacles, equally spaced, and what their surfaces do; that the rest
   of the scene goes with them. The vesicles are known. Collective; stops with the user's message. SceneDropObstacles -
   free them. */
PETSC_EXTERN PetscErrorCode SceneMakeObstacles(Draft scene);
PETSC_EXTERN PetscErrorCode SceneDropObstacles(Draft scene);

/* SceneCheckObstacles - method, places and sizes of the obstacles and of the vesicles among them; finds what is around
   each. Collective. */
PETSC_EXTERN PetscErrorCode SceneCheckObstacles(Draft scene);

/* SceneChooseInertia - the Reynolds number (speed R0/nu with R0 of the largest vesicle and the speed of the scene: rate
   R0 of shear and extension, u_max of poiseuille, c_b/(nu R0^2) of a quiescent fluid; 0 without vesicles), the model
   that -fluid_inertia auto stands for, and the warning that goes with it. Stops with the user's message when the model
   does not fit the scene. SceneHasInertia - whether -fluid_inertia, or what auto stands for when the largest vesicle
   has this radius (0: none), has inertia; the flow is known. Collective; not collective. */
PETSC_EXTERN PetscErrorCode SceneChooseInertia(Draft scene);
PETSC_EXTERN PetscBool SceneHasInertia(Scene scene, PetscReal R0);
