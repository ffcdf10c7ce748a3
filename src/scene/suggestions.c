/* Names that the program does not have, with the option that is meant or the answer that there is none; and options for
   which a scene has no use. -help searches both, the names and the table. */
#define _GNU_SOURCE /* strcasestr */
#include "scene/scene.h"
#include <ctype.h>

#define NO "; README.md, What petves does not do"

static const OptionSuggestion suggestions[] = {
    /* other words for what there is */
    {"-dt", "-time_step is meant?"},
    {"-nu", "-fluid_viscosity is meant?"},
    {"-chi", "-flow_chi is meant?"},
    {"-ca", "-flow_ca is meant?"},
    {"*end_time *final_time *t_end -tend -tmax", "-time_end is meant?"},
    {"*shear_rate *strain_rate", "-flow_rate is meant?"},
    {"*capillary", "-flow_ca (in a channel) or -flow_chi is meant?"},
    {"*kappa *rigidity *bending_modulus *bending_stiffness", "-vesicle_bending is meant?"},
    {"-gpu *cuda *graphics", "no graphics processors; mpirun -n RANKS takes several cores" NO},
    {"-amr *adaptive_grid *adaptive_mesh *refinement",
     "one grid of equal cells, -domain_cells; steps adapt with -time_adapt error" NO},
    {"*resolution *grid -n -nx -ny", "-domain_cells is meant?"},
    {"*channel *pipe", "-flow_type poiseuille with -domain_bc_x periodic is meant?"},
    {"*confinement",
     "in a channel -flow_half_width over R0: -flow_half_width, -domain_box and -vesicle_area are meant?"},
    {"*reynolds -re", "-fluid_viscosity sets it, -fluid_inertia what is made of it, -view prints it"},
    {"*area_fraction *volume_fraction *hematocrit", "-vesicle_packing is meant?"},
    {"*attraction", "-contact_adhesion is meant?"},
    {"*viscosity_contrast *viscosity_in *inner_viscosity -lambda", "-vesicle_viscosity_ratio is meant?"},
    {"-density *density_ratio", "-vesicle_density_difference (inside less outside, over outside) is meant?"},
    {"-steps *n_steps *max_steps", "-time_end and -time_step are meant?"},
    {"*domain_size *box_size", "-domain_box is meant?"},
    {"-periodic", "-domain_bc_x periodic is meant?"},
    {"-vesicles *n_vesicles", "-vesicle_count is meant?"},
    {"-obstacles", "-obstacle_shape is meant?"},
    {"-radius", "-vesicle_area and -vesicle_reduced_area, or -vesicle_semi_axes, are meant?"},
    {"*volume", "-vesicle_area is meant?"},
    {"*aspect_ratio", "-vesicle_semi_axes is meant?"},
    {"-flow_shear", "-flow_type shear is meant?"},
    {"*wall_velocity", "-flow_type shear, or -flow_type uniform with -flow_velocity, is meant?"},
    {"-tolerance -tol", "-scheme_auto (the error wanted) or -time_adapt_tol is meant?"},
    {"*accuracy", "-scheme_auto (the error wanted) is meant?"},
    {"-output -o", "-output_dir is meant?"},
    {"*save_every", "-output_every is meant?"},
    {"*threads", "mpirun -n RANKS is meant?"},
    {"-dpi -width -cmap -column -field -format -follow", "it is one of petves plot, see petves help plot"},
    /* what there is not */
    {"*inflow *outflow *inlet",
     "a channel is -flow_type poiseuille in a periodic box; there is no inflow or outflow" NO},
    {"*pressure_drop", "a channel's flow is given by -flow_peak_velocity or -flow_ca" NO},
    {"*electric *magnetic *voltage", "no electric or magnetic fields" NO},
    {"*temperature *noise *thermal *brownian", "no thermal fluctuations" NO},
    {"*spontaneous_curvature *rest_shape *stress_free",
     "-membrane_memory is meant (a constant curvature has no effect on a closed curve in the plane)?"},
    {"*shear_modulus *elastic *stretch *capsule", "-membrane_law and -membrane_stretching are meant?"},
    {"*surface_tension", "the tension follows from the membrane's length, which stays" NO},
    {"*permeability *osmosis", "-membrane_permeability and -membrane_osmotic are meant?"},
    {"*constriction *stenosis", "-obstacle_shape constriction is meant?"},
    {"*3d *dimension", "-dim 3 is meant?"},
    {"*axisymmetric", "no axial symmetry" NO},
    {NULL, NULL}};

/* Solver options that users write most, as candidates for a suggestion. */
static const char *const solvers[] = {"-tension_ksp_type",   "-tension_ksp_rtol",         "-tension_ksp_atol",
                                      "-tension_ksp_max_it", "-tension_ksp_monitor",      "-tension_pc_type",
                                      "-bending_ksp_type",   "-bending_ksp_rtol",         "-bending_ksp_atol",
                                      "-bending_ksp_max_it", "-bending_pc_type",          "-options_file",
                                      "-log_view",           "-tension_pc_factor_levels", "-bending_ksp_monitor",
                                      "-coupled_ksp_type",   "-coupled_ksp_rtol",         "-coupled_ksp_atol",
                                      "-coupled_ksp_max_it", "-coupled_ksp_monitor",      NULL};

/* Prefixes of solvers, and what a scene needs to have them. */
static const OptionOwner owners[] = {
    {"-tension_", "-scheme_type", "split"},   {"-bending_", "-scheme_type", "split"},
    {"-coupled_", "-scheme_type", "coupled"}, {"-helmholtz_", "-helmholtz_type", "hypre"},
    {"-poisson_", "-poisson_type", "hypre"},  {NULL, NULL, NULL}};

PetscErrorCode SceneCheckUsed(Scene scene) {
  PetscFunctionBeginUser;
  if (!scene->allow_unused) PetscCall(OptionsCheckUsed(&scene->options, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheckUnused(Scene scene) {
  PetscFunctionBeginUser;
  PetscCall(OptionsTryLate(&scene->options));
  if (!scene->allow_unused) PetscCall(OptionsCheckUnused(&scene->options, scene, solvers, owners, suggestions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A group goes to the first option of the next. */
static const struct {
  const char *first, *title;
} groups[] = {{"-domain_box", "Domain"},
              {"-flow_type", "Background flow"},
              {"-fluid_viscosity", "Fluid"},
              {"-vesicle_shape", "Vesicles"},
              {"-obstacle_shape", "Obstacles"},
              {"-tracer_file", "Tracers"},
              {"-delta_type", "Scheme"},
              {"-time_step", "Time"},
              {"-helmholtz_type", "Fast solvers"},
              {"-output_dir", "Output, checkpoints, restart"},
              {"-time_wall_limit", "When to stop"},
              {"-view", "Others"}};
#define GROUPS (sizeof(groups) / sizeof(groups[0]))

/* TRUE if the word is at the beginning of a word of the text, case ignored. */
static PetscBool TextHas(const char *text, const char *word) {
  for (const char *p = strcasestr(text, word); p; p = strcasestr(p + 1, word))
    if (p == text || !isalnum((unsigned char)p[-1])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* How well an option answers to a word: 2 by its name; 1 by its help, by what is allowed, or because a suggestion that
   has the word names the option. */
static int OptionAnswers(const OptionRow *row, const char *word) {
  char help[OPTION_HELP];
  if (!word || TextHas(row->name, word)) return 2;
  OptionHelpText(row, scene_defaults, help);
  if (TextHas(help, word) || TextHas(row->range, word)) return 1;
  for (const OptionSuggestion *s = suggestions; s->names; s++)
    if (TextHas(s->names, word) && TextHas(s->say, row->name)) return 1;
  return 0;
}

PetscBool SceneHelp(FILE *file, const char word[]) {
  const char *title = NULL;
  const OptionRow *row;
  int best = 0, across = 0;
  PetscBool any = PETSC_FALSE;
  for (PetscInt i = 0; (row = SceneOptionRow(i)); i++) best = PetscMax(best, OptionAnswers(row, word));
  for (const OptionSuggestion *s = suggestions; best < 2 && s->names; s++) {
    if (!TextHas(s->names, word)) continue;
    OptionHelp(file, &(OptionRow){.name = word, .value = "", .range = "", .help = s->say}, scene_defaults);
    any = PETSC_TRUE;
  }
  for (PetscInt i = 0; best && (row = SceneOptionRow(i)); i++) {
    for (size_t g = 0; g < GROUPS; g++)
      if (!strcmp(groups[g].first, row->name)) title = groups[g].title;
    if (OptionAnswers(row, word) < best) continue;
    if (title) fprintf(file, "%s%s\n", any ? "\n" : "", title);
    title = NULL; /* has been printed */
    OptionHelp(file, row, scene_defaults);
    any = PETSC_TRUE;
  }
  for (PetscInt i = 0; best == 2 && (row = SceneOptionRow(i)); i++) {
    if (OptionAnswers(row, word) != 1) continue;
    if (!across) across = fprintf(file, "\nAlso in the help of");
    if (across > 80) across = fprintf(file, "\n     ");
    across += fprintf(file, " %s", row->name);
  }
  if (across) fprintf(file, "\n");
  return any;
}
