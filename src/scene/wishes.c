/* What people ask for by names that petves does not have: the option that does it, or that nothing does. */
#include "scene/resolve.h"

#define NO "; README.md, What petves does not do"

static const OptionWish wishes[] = {
    /* other words for what there is */
    {"-dt", "-time_step is meant?"},
    {"-nu", "-fluid_viscosity is meant?"},
    {"-chi", "-flow_chi is meant?"},
    {"-ca", "-flow_ca is meant?"},
    {"*end_time", "-time_end is meant?"},
    {"*final_time", "-time_end is meant?"},
    {"*t_end", "-time_end is meant?"},
    {"*shear_rate", "-flow_rate is meant?"},
    {"*strain_rate", "-flow_rate is meant?"},
    {"*capillary", "-flow_ca (in a channel) or -flow_chi is meant?"},
    {"*kappa", "-vesicle_bending is meant?"},
    {"*rigidity", "-vesicle_bending is meant?"},
    {"*bending_modulus", "-vesicle_bending is meant?"},
    {"*bending_stiffness", "-vesicle_bending is meant?"},
    {"*reduced_volume", "-vesicle_reduced_area is meant?"},
    {"*resolution", "-domain_cells is meant?"},
    {"*grid", "-domain_cells is meant?"},
    {"*confinement",
     "in a channel -flow_half_width over R0: -flow_half_width, -domain_box and -vesicle_area are meant?"},
    {"*reynolds", "-fluid_viscosity sets it, -fluid_inertia what is made of it, -view prints it"},
    {"*area_fraction", "-vesicle_packing is meant?"},
    {"*volume_fraction", "-vesicle_packing is meant?"},
    {"*hematocrit", "-vesicle_packing is meant?"},
    {"*adhesion", "-contact_adhesion is meant?"},
    {"*attraction", "-contact_adhesion is meant?"},
    {"*viscosity_ratio", "-vesicle_viscosity_ratio is meant?"},
    {"*viscosity_contrast", "-vesicle_viscosity_ratio is meant?"},
    {"*viscosity_in", "-vesicle_viscosity_ratio is meant?"},
    {"*inner_viscosity", "-vesicle_viscosity_ratio is meant?"},
    {"*threads", "mpirun -n RANKS is meant?"},
    /* what there is not */
    {"*inflow", "a channel is -flow_type poiseuille in a periodic box; there is no inflow or outflow" NO},
    {"*outflow", "a channel is -flow_type poiseuille in a periodic box; there is no inflow or outflow" NO},
    {"*inlet", "a channel is -flow_type poiseuille in a periodic box; there is no inflow or outflow" NO},
    {"*pressure_drop", "a channel's flow is given by -flow_peak_velocity or -flow_ca" NO},
    {"*electric", "no electric or magnetic fields" NO},
    {"*magnetic", "no electric or magnetic fields" NO},
    {"*voltage", "no electric or magnetic fields" NO},
    {"*temperature", "no thermal fluctuations" NO},
    {"*noise", "no thermal fluctuations" NO},
    {"*thermal", "no thermal fluctuations" NO},
    {"*brownian", "no thermal fluctuations" NO},
    {"*spontaneous_curvature", "no spontaneous curvature, which has no effect on a closed curve in the plane" NO},
    {"*shear_modulus", "the membrane is a fluid, inextensible and without shear elasticity" NO},
    {"*elastic", "the membrane is a fluid, inextensible and without shear elasticity" NO},
    {"*permeability", "the membrane lets no fluid through" NO},
    {"*obstacle", "-obstacle_shape is meant?"},
    {"*constriction", "-obstacle_shape constriction is meant?"},
    {"*stenosis", "-obstacle_shape constriction is meant?"},
    {"*3d", "two dimensions only" NO},
    {"*dimension", "two dimensions only" NO},
    {NULL, NULL}};

const OptionWish *SceneWishes(void) {
  return wishes;
}
