/* Names that the program does not have, with the option that is meant or the answer that there is none; and options for
   which a scene has no use. */
#include "scene/scene.h"

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
    {"*reduced_volume", "-vesicle_reduced_area is meant?"},
    {"*resolution *grid -nx -ny", "-domain_cells is meant?"},
    {"*confinement",
     "in a channel -flow_half_width over R0: -flow_half_width, -domain_box and -vesicle_area are meant?"},
    {"*reynolds", "-fluid_viscosity sets it, -fluid_inertia what is made of it, -view prints it"},
    {"*area_fraction *volume_fraction *hematocrit", "-vesicle_packing is meant?"},
    {"*attraction", "-contact_adhesion is meant?"},
    {"*viscosity_contrast *viscosity_in *inner_viscosity -lambda", "-vesicle_viscosity_ratio is meant?"},
    {"-density", "-vesicle_density_difference is meant?"},
    {"-steps *n_steps *max_steps", "-time_end and -time_step are meant?"},
    {"*domain_size *box_size", "-domain_box is meant?"},
    {"-periodic", "-domain_bc_x periodic is meant?"},
    {"-vesicles *n_vesicles", "-vesicle_count is meant?"},
    {"-obstacles", "-obstacle_shape is meant?"},
    {"-radius *vesicle_radius", "-vesicle_area and -vesicle_reduced_area, or -vesicle_semi_axes, are meant?"},
    {"*volume", "-vesicle_area is meant?"},
    {"*aspect_ratio", "-vesicle_semi_axes is meant?"},
    {"-flow_shear", "-flow_type shear is meant?"},
    {"*wall_velocity", "-flow_type shear, or -flow_type uniform with -flow_velocity, is meant?"},
    {"-tolerance -tol", "-scheme_auto (the error wanted) or -time_adapt_tol is meant?"},
    {"*accuracy", "-scheme_auto (the error wanted) is meant?"},
    {"-output -o", "-output_dir is meant?"},
    {"*save_every", "-output_every is meant?"},
    {"*threads", "mpirun -n RANKS is meant?"},
    /* what there is not */
    {"*inflow *outflow *inlet",
     "a channel is -flow_type poiseuille in a periodic box; there is no inflow or outflow" NO},
    {"*pressure_drop", "a channel's flow is given by -flow_peak_velocity or -flow_ca" NO},
    {"*electric *magnetic *voltage", "no electric or magnetic fields" NO},
    {"*temperature *noise *thermal *brownian", "no thermal fluctuations" NO},
    {"*spontaneous_curvature *rest_shape *stress_free",
     "-membrane_memory is meant (a constant curvature has no effect on a closed curve in the plane)?"},
    {"*shear_modulus *elastic *stretch", "-membrane_law and -membrane_stretching are meant?"},
    {"*surface_tension", "the tension follows from the membrane's length, which stays" NO},
    {"*permeability", "the membrane lets no fluid through" NO},
    {"*constriction *stenosis", "-obstacle_shape constriction is meant?"},
    {"*3d *dimension", "two dimensions only" NO},
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
