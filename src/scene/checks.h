/* Checks that involve more than one option.

   Most are rows of a table: a condition that must not hold, and the message. */
#pragma once
#include "scene/spec.h"

/* A condition and what is to be said where it holds. In the message the value in force of an option stands for
   "{-name}", the next of the numbers for each conversion of printf, %g, %f or (a character) %c, and the next of the
   words for %s. */
typedef struct {
  int holds;
  const char *message;
  PetscReal number[7];
  const char *word[3];
} SceneRule;

/* SceneText - the message of the first rule that holds; empty where none does. SceneRefuse - stop with this message.
   SCENE_REFUSE_IF - one rule. SceneCheckList - stop unless a list has `each` numbers (1 to 3) for all of `count`
   "vesicles" (what), or `each` numbers "a vesicle" (one). Collective. */
PETSC_EXTERN PetscErrorCode SceneText(Scene scene, size_t rules, const SceneRule rule[], char text[PETVES_MAX_MESSAGE]);
PETSC_EXTERN PetscErrorCode SceneRefuse(Scene scene, size_t rules, const SceneRule rule[]);
PETSC_EXTERN PetscErrorCode SceneCheckList(Scene scene, const char name[], PetscInt each, PetscInt count,
                                           const char what[], const char one[]);
#define REFUSE(scene, rules) SceneRefuse(scene, sizeof(rules) / sizeof((rules)[0]), rules)
#define SCENE_TEXT(scene, rules, text) SceneText(scene, sizeof(rules) / sizeof((rules)[0]), rules, text)
#define SCENE_REFUSE_IF(scene, ...) SceneRefuse(scene, 1, &(const SceneRule){__VA_ARGS__})

#define SCENE_MOST_FREE 30 /* vesicles in unbounded fluid: all pairs are summed, beyond it a large box is faster */

/* SceneCheck - scheme, lists, background flow and vesicles, before anything is made. SceneCheckCells - that cells are
   square; the box is known. SceneCheckBodies - unbounded fluid, a custom flow's divergence, gravity, drive and
   viscosities; the vesicles are known. Collective; stop with the user's message. */
PETSC_EXTERN PetscErrorCode SceneCheck(Scene scene);
PETSC_EXTERN PetscErrorCode SceneCheckCells(Scene scene);
PETSC_EXTERN PetscErrorCode SceneCheckBodies(Scene scene);

/* SceneChooseInertia (inertia.c) - the Reynolds number (speed R0/nu with R0 of the largest vesicle and the speed of the
   scene: rate R0 of shear and extension, u_max of poiseuille, c_b/(nu R0^2) of a quiescent fluid; 0 without vesicles,
   NaN of a custom flow), the model that -fluid_inertia auto stands for, and the warning that goes with it. Collective;
   stops with the user's message when the model does not fit the scene. */
PETSC_EXTERN PetscErrorCode SceneChooseInertia(Draft scene);

/* SceneModel (inertia.c) - the model of the fluid and why it was taken, as text. Not collective. */
#define SCENE_MODEL 128
PETSC_EXTERN void SceneModel(Scene scene, char text[SCENE_MODEL]);

/* SceneChooseFreeBodies - which obstacles move freely, and what -obstacle_free and the scene need for it
   (freebodies.c). Collective; stops with the user's message. */
PETSC_EXTERN PetscErrorCode SceneChooseFreeBodies(Draft scene);

/* SceneCheckObstacles - method, places and sizes of the obstacles and of the vesicles among them (obstaclechecks.c);
   finds what is around each. Collective; stops with the user's message. */
PETSC_EXTERN PetscErrorCode SceneCheckObstacles(Draft scene);
