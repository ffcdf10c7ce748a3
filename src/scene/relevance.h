/* What a scene must have for an option to mean something (the last but one column of table.c). */
#pragma once
#include "options/options.h"

PETSC_EXTERN const OptionNeed need_strain, need_channel, need_extension, need_sheared, need_flow, need_uniform;
PETSC_EXTERN const OptionNeed need_vesicles, need_ellipses, need_sizes, need_file, need_packing, need_random;
PETSC_EXTERN const OptionNeed need_centers, need_angles, need_coupled, need_repulsion, need_adhesion;
PETSC_EXTERN const OptionNeed need_penalty, need_order, need_adapt, need_adaptable, need_convection, need_grid;
PETSC_EXTERN const OptionNeed need_gravity, need_period, need_bodies, need_obstacles, need_circles, need_posts;
PETSC_EXTERN const OptionNeed need_constriction, need_solid_centers, need_obstacle_file;
