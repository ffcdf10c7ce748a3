/* -help options: the option table by groups. */
#include "scene/scene.h"

/* A group goes to the first option of the next. */
static const struct {
  const char *first, *title;
} groups[] = {{"-domain_box", "Domain"},
              {"-flow_type", "Background flow"},
              {"-fluid_viscosity", "Fluid"},
              {"-vesicle_shape", "Vesicles"},
              {"-obstacle_shape", "Obstacles"},
              {"-delta_type", "Scheme"},
              {"-time_step", "Time"},
              {"-helmholtz_type", "Fast solvers"},
              {"-output_dir", "Output, checkpoints, restart"},
              {"-time_wall_limit", "When to stop"},
              {"-view", "Others"}};
#define GROUPS (sizeof(groups) / sizeof(groups[0]))

PetscBool SceneHelp(FILE *file, const char word[]) {
  const char *title = NULL;
  PetscBool any = PETSC_FALSE;
  for (PetscInt i = 0; SceneOptionRow(i); i++) {
    const OptionRow *row = SceneOptionRow(i);
    for (size_t g = 0; g < GROUPS; g++)
      if (!strcmp(groups[g].first, row->name)) title = groups[g].title;
    if (word && !strstr(row->name, word)) continue;
    if (title) fprintf(file, "%s%s\n", any ? "\n" : "", title);
    title = NULL; /* has been printed */
    OptionHelp(file, row);
    any = PETSC_TRUE;
  }
  return any;
}
