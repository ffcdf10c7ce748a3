/* A scene for the rest of the program. SceneCreate resolves the scene from the options of the user, every default
   included; from then on the scene is only read. */
#pragma once
#include "scene/auto.h"
#include "scene/properties.h"
#include "scene/table.h"

/* SceneCreate - read every option of the options database and resolve the scene: what -scheme_auto and the scheme
   choose, the initial markers, the model of the fluid, the springs. flow: the function of -flow_type custom with its
   context, or NULL. A user's mistake ends with PETSC_ERR_USER_INPUT after one line that names the option. Also fills in
   -help. Collective. */
PETSC_EXTERN PetscErrorCode SceneCreate(MPI_Comm comm, PetvesFlow flow, void *ctx, Scene *scene);
PETSC_EXTERN PetscErrorCode SceneDestroy(Scene *scene);

/* SceneView - print which parts of the model are on, their numbers, and the defaults that depend on the scene, each
   with its reason (view.c). Collective. */
PETSC_EXTERN PetscErrorCode SceneView(Scene scene, PetscViewer viewer);

/* SceneSayModel - a line with the model of the fluid, its reason, the Reynolds number and the kind of steps (view.c).
   Collective. */
PETSC_EXTERN PetscErrorCode SceneSayModel(Scene scene);

/* SceneCheckUsed - stop when the user gave an option of the table that the scene does not use. SceneCheckUnused - stop
   when the options database holds an option that nothing has read: one of a solver that the scene does not have, or one
   that there is not; when all solvers are set up (suggestions.c). Collective. */
PETSC_EXTERN PetscErrorCode SceneCheckUsed(Scene scene);
PETSC_EXTERN PetscErrorCode SceneCheckUnused(Scene scene);

/* SceneHelp - print the table by groups (suggestions.c). With a word, case ignored: what the word stands for, the
   options that have it in their name, and the names of those that have it in their help; where no name has it, these
   options. FALSE when there is nothing. Not collective, and also before PETSc starts. */
PETSC_EXTERN PetscBool SceneHelp(FILE *file, const char word[]);
