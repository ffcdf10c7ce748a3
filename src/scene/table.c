/* The option table: each option once, beside its default, range, unit and need. */
#include "scene/table.h"
#include "kernel/kernel.h"
#include "scene/properties.h"
#include "scene/space.h"

#define AT(member) offsetof(struct _p_Scene, member)

static PetscBool HasVesicles(const void *scene) {
  return ((Scene)scene)->shape.vesicles > 0 || ((Scene)scene)->dim != DIM_PLANE;
}

static PetscBool HasBodies(const void *scene) {
  return HasVesicles(scene) || ((Scene)scene)->obstacles.shape != OBSTACLE_NONE;
}

static PetscBool HasFile(const void *scene) {
  return ((Scene)scene)->vesicles.shape == SHAPE_FILE || ((Scene)scene)->dim != DIM_PLANE;
}

static PetscBool IsPacked(const void *scene) {
  const SceneVesicles *vesicles = &((Scene)scene)->vesicles;
  return vesicles->shape == SHAPE_ELLIPSE && vesicles->packing > 0;
}

static PetscBool IsPackedRandomly(const void *scene) {
  return IsPacked(scene) && ((Scene)scene)->vesicles.packing_type == PACKING_RANDOM;
}

static PetscBool HasCenters(const void *scene) {
  return HasVesicles(scene) && !IsPacked(scene);
}

static PetscBool HasAngles(const void *scene) {
  return HasVesicles(scene) && !IsPackedRandomly(scene);
}

static PetscBool IsCoupled(const void *scene) {
  return HasVesicles(scene) && !strcmp(((Scene)scene)->scheme.type, "coupled");
}

static PetscBool HasFreeBodies(const void *scene) {
  return *((Scene)scene)->obstacles.free.which != 0;
}

static PetscBool HasRepulsion(const void *scene) {
  return (HasVesicles(scene) || HasFreeBodies(scene)) && ((Scene)scene)->repulsion.stress > 0;
}

static PetscBool HasSolidCenters(const void *scene) {
  const SceneObstacles *own = &((Scene)scene)->obstacles;
  const PetscBool placed = own->posts.count || (own->posts.lattice.n && own->posts.lattice.v[0]);
  return own->shape == OBSTACLE_POSTS ? !placed : own->shape == OBSTACLE_COUETTE || own->shape == OBSTACLE_CONSTRICTION;
}

static PetscBool HasHeavy(const void *scene) {
  return HasFreeBodies(scene) || IsCoupled(scene);
}

/* The 0 that stands for no springs is right for all schemes. */
static PetscBool HasSprings(const void *scene) {
  const SceneScheme *scheme = &((Scene)scene)->scheme;
  return scheme->stiffness == 0 || (HasVesicles(scene) && !strcmp(scheme->type, "penalty"));
}

static PetscBool IsAdaptable(const void *scene) {
  const Scene s = (Scene)scene;
  return HasVesicles(s) || s->obstacles.free.count || s->time.adapt == ADAPT_NONE;
}

/* The 0 that stands for no difference is right for all scenes. */
static PetscBool HasWeight(const void *scene) {
  const RealList *density = &((Scene)scene)->gravity.density;
  const PetscBool none = density->n == 1 && density->v[0] == 0;
  return none || (HasVesicles(scene) && SceneHasGravity((Scene)scene));
}

static PetscBool IsChannel(const void *scene) {
  const PetscInt *bc = ((Scene)scene)->fluid.bc;
  return bc[0] == BC_PERIODIC && bc[1] == BC_WALL;
}

#define IS(value) (1u << (value))
/* Conditions under which an option means something: the last but one column of the table. */
/* clang-format off */
static const OptionNeed
  need_strain = {"-flow_type shear, extension or axial", AT(flow.type), IS(FLOW_SHEAR) | IS(FLOW_EXTENSION) | IS(FLOW_AXIAL)},
  need_channel = {"-flow_type poiseuille or tube", AT(flow.type), IS(FLOW_POISEUILLE) | IS(FLOW_TUBE)},
  need_extension = {"-flow_type extension or axial", AT(flow.type), IS(FLOW_EXTENSION) | IS(FLOW_AXIAL)},
  need_sheared = {"-flow_type shear, poiseuille or extension", AT(flow.type), IS(FLOW_SHEAR) | IS(FLOW_POISEUILLE) | IS(FLOW_EXTENSION) | IS(FLOW_UNIFORM) | IS(FLOW_AXIAL) | IS(FLOW_TUBE)},
  need_flow = {"a -flow_type that is not quiescent", AT(flow.type), ~(IS(FLOW_QUIESCENT))},
  need_uniform = {"-flow_type uniform", AT(flow.type), IS(FLOW_UNIFORM)},
  need_formula = {"-flow_type formula", AT(flow.type), IS(FLOW_FORMULA)},
  need_vesicles = {"vesicles (-vesicle_shape)", .met = HasVesicles},
  need_ellipses = {"-vesicle_shape ellipse", AT(vesicles.shape), IS(SHAPE_ELLIPSE)},
  need_sizes = {"-vesicle_shape ellipse or biconcave", AT(vesicles.shape), IS(SHAPE_ELLIPSE) | IS(SHAPE_BICONCAVE)},
  need_file = {"-vesicle_shape file", .met = HasFile},
  need_packing = {"-vesicle_packing", .met = IsPacked},
  need_random = {"-vesicle_packing and -vesicle_packing_type random", .met = IsPackedRandomly},
  need_centers = {"vesicles that are not packed (-vesicle_packing 0)", .met = HasCenters},
  need_angles = {"vesicles that are not packed at random (-vesicle_packing)", .met = HasAngles},
  need_coupled = {"vesicles and -scheme_type coupled", .met = IsCoupled},
  need_repulsion = {"-contact_repulsion", .met = HasRepulsion},
  need_adhesion = {"-contact_adhesion", .positive = AT(repulsion.adhesion)},
  need_potential = {"-contact_potential", .positive = AT(potential.strength)},
  need_penalty = {"vesicles and -scheme_type penalty", .met = HasSprings},
  need_order = {"-scheme_order 2 or 3", AT(scheme.order), IS(2) | IS(3)},
  need_adapt = {"-time_adapt error", AT(time.adapt), IS(ADAPT_ERROR)},
  need_adaptable = {"vesicles or free bodies; without, steps are fixed", .met = IsAdaptable},
  need_convection = {"-fluid_inertia convective", AT(fluid.inertia), IS(INERTIA_CONVECTIVE)},
  need_grid = {"walls or periodic boundaries (-domain_bc_x)", AT(fluid.bc[0]), IS(BC_WALL) | IS(BC_PERIODIC)},
  need_gravity = {"a -fluid_gravity that is not 0,0", .met = HasWeight},
  need_period = {"-domain_bc_x periodic and -domain_bc_y wall", .met = IsChannel},
  need_bodies = {"vesicles (-vesicle_shape) or obstacles (-obstacle_shape)", .met = HasBodies},
  need_obstacles = {"obstacles (-obstacle_shape)", AT(obstacles.shape), ~(IS(OBSTACLE_NONE))},
  need_circles = {"-obstacle_shape posts or couette", AT(obstacles.shape), IS(OBSTACLE_POSTS) | IS(OBSTACLE_COUETTE)},
  need_posts = {"-obstacle_shape posts", AT(obstacles.shape), IS(OBSTACLE_POSTS)},
  need_constriction = {"-obstacle_shape constriction", AT(obstacles.shape), IS(OBSTACLE_CONSTRICTION)},
  need_solid_centers = {"posts that are in no lattice and not packed, couette or constriction (-obstacle_shape)", .met = HasSolidCenters},
  need_free = {"-obstacle_free", .met = HasFreeBodies},
  need_heavy = {"vesicles and -scheme_type coupled, or -obstacle_free", .met = HasHeavy},
  need_space = {"-dim 3", AT(dim), IS(DIM_SPACE) | IS(DIM_AXIAL)},
  need_axial = {"-dim axisymmetric", AT(dim), IS(DIM_AXIAL)},
  need_tube = {"-tube_radius", .positive = AT(space.tube.radius)},
  need_throat = {"-tube_throat", .positive = AT(space.tube.throat)},
  need_obstacle_file = {"-obstacle_shape file", AT(obstacles.shape), IS(OBSTACLE_FILE)};

/* A restart may have another value than its checkpoint: end, tolerances, output, limits and back ends may change; grid,
   fluid, vesicles and scheme may not, nor -output_precision, since a file goes on as it was begun. Of -flow_chi,
   -flow_ca and -flow_ca_stretching what they stand for is compared. */
#define MAY_CHANGE PETSC_TRUE
#define IN_SPACE .group = 1 /* three dimensions have the option */
static const OptionRow table[] = {
  {"-dim", OPT_ENUM, AT(dim), "2", "2|3|axisymmetric", "dimensions; 3: vesicles in unbounded fluid, surfaces in spherical harmonics; axisymmetric: bodies of revolution about x, in unbounded fluid or a tube", IN_SPACE},
  {"-domain_box", OPT_REALS, AT(domain.box), "-1,1,-1,1", "any", "x_min,x_max,y_min,y_max (length)"},
  {"-domain_cells", OPT_INTS, AT(domain.cells), "128,128", ">=8", "cells in x and y; cells must be square"},
  {"-domain_bc_x", OPT_ENUM, AT(fluid.bc[0]), "wall", "wall|periodic|free", "boundaries at x_min and x_max; free (in x and y): unbounded fluid, the box is the window of the fields"},
  {"-domain_bc_y", OPT_ENUM, AT(fluid.bc[1]), "wall", "wall|periodic|free", "boundaries at y_min and y_max; periodic where x is periodic too"},
  {"-flow_type", OPT_ENUM, AT(flow.type), "quiescent", "quiescent|shear|poiseuille|extension|uniform|custom|formula|axial|tube", "background flow; custom: a function given from Python or C; formula: -flow_u and -flow_v, which need no -flow_type", IN_SPACE},
  {"-flow_rate", OPT_REAL, AT(flow.rate), "1", "any", "rate of shear or extension (1/time)", &need_strain, IN_SPACE},
  {"-flow_chi", OPT_REAL, AT(flow.chi), "0", "any", "in place of -flow_rate: chi = rate nu R0^3/c_b, R0 of the largest vesicle", &need_strain, MAY_CHANGE, IN_SPACE},
  {"-flow_ca_stretching", OPT_REAL, AT(flow.ca_stretching), "0", "any", "in place of -flow_rate: capillary number nu rate R0/E_s, R0 of the largest vesicle, E_s the largest -membrane_stretching", &need_strain, MAY_CHANGE},
  {"-flow_peak_velocity", OPT_REAL, AT(flow.peak), "1", "any", "u_max of poiseuille (length/time)", &need_channel, IN_SPACE},
  {"-flow_ca", OPT_REAL, AT(flow.ca), "0", "any", "in place of -flow_peak_velocity: u_max nu R0^2/c_b, the paper's w", &need_channel, MAY_CHANGE, IN_SPACE},
  {"-flow_velocity", OPT_REALS, AT(flow.velocity), "1,0", "any", "uniform: u_x,u_y (length/time)", &need_uniform, IN_SPACE},
  {"-flow_u", OPT_TEXT, AT(flow.formula[0]), "0", "", "formula: u_x as a formula of x, y and t, in quotes, such as \"sin(pi*y)*cos(2*t)\"; a blank goes before a minus sign at its beginning (length/time)", &need_formula, IN_SPACE},
  {"-flow_v", OPT_TEXT, AT(flow.formula[1]), "0", "", "formula: u_y (length/time)", &need_formula, IN_SPACE},
  {"-flow_w", OPT_TEXT, AT(flow.formula[2]), "0", "", "formula in three dimensions: u_z, and all three formulas may have z (length/time)", &need_space, IN_SPACE},
  {"-flow_half_width", OPT_REAL, AT(flow.half_width), "3", ">0", "L_y of poiseuille: half the channel's height (length)", &need_channel, IN_SPACE},
  {"-flow_center_x", OPT_REAL, AT(flow.center[0]), "0", "any", "x_c of the background flow (length)", &need_extension, IN_SPACE},
  {"-flow_center_y", OPT_REAL, AT(flow.center[1]), "0", "any", "y_c of the background flow (length)", &need_sheared, IN_SPACE},
  {"-flow_form", OPT_ENUM, AT(fluid.form), "disturbance", "disturbance|total", "solve for u - u_inf, or (split, penalty) for u with moving walls as the paper", &need_flow},
  {"-flow_drive", OPT_ENUM, AT(fluid.drive), "pressure", "pressure|flux", "channel, periodic in x: which quantity vesicles and obstacles do not change, the mean pressure gradient or the flux", &need_period},
  {"-fluid_viscosity", OPT_REAL, AT(fluid.nu), "1", ">0", "nu (length^2/time; density is 1)", IN_SPACE},
  {"-fluid_inertia", OPT_ENUM, AT(fluid.inertia), "auto", "auto|none|unsteady|convective", "inertia of the fluid: quasi-steady Stokes, unsteady Stokes, Navier-Stokes; auto goes by flow and Reynolds number"},
  {"-fluid_gravity", OPT_REALS, AT(gravity.g), "0,0", "any", "gravity g_x,g_y (length/time^2); it moves vesicles by -vesicle_density_difference, free obstacles by -obstacle_density", &need_heavy, IN_SPACE},
  {"-vesicle_shape", OPT_ENUM, AT(vesicles.shape), "ellipse", "ellipse|biconcave|file|none", "initial shape; biconcave: the red cell's outline"},
  {"-vesicle_count", OPT_INT, AT(vesicles.count), "1", ">=1", "number of vesicles; a file has its own number of curves, a packing the number that it takes", &need_vesicles, IN_SPACE},
  {"-vesicle_semi_axes", OPT_REALS, AT(vesicles.axes), "0.2,0.5", ">0", "semi-axes of the ellipse, two for all, or two a vesicle or kind (length)", &need_ellipses},
  {"-vesicle_area", OPT_REALS, AT(vesicles.area), "1", ">0", "area, with -vesicle_reduced_area; one for all, or one a vesicle or kind (length^2)", &need_sizes},
  {"-vesicle_reduced_area", OPT_REALS, AT(vesicles.reduced_area), "0.7", "(0,1)", "V = area/(pi R0^2), R0 = perimeter/(2 pi); long axis along x", &need_sizes},
  {"-vesicle_center", OPT_REALS, AT(vesicles.center), "0,0", "any", "x,y of the centre, a pair a vesicle; file: added to its coordinates, one pair for all or one each (length)", &need_centers, IN_SPACE},
  {"-vesicle_angle", OPT_REALS, AT(vesicles.angle), "0", "any", "counter-clockwise turn about the centre, file: about each curve's centroid; one for all or one a vesicle (degrees)", &need_angles},
  {"-vesicle_file", OPT_PATH, AT(vesicles.file), "", "", "closed curves: x y a line, an empty line between curves, for -vesicle_shape file; three dimensions, without it: surfaces, points x y z a line, or coefficients l m c_x c_y c_z of spherical harmonics", &need_file, MAY_CHANGE, IN_SPACE},
  {"-vesicle_mixture", OPT_REALS, AT(vesicles.mixture), "1", ">0", "fraction of the vesicles that are of each kind, adding up to 1; lists of area, reduced area, semi-axes and bending then have an entry for each kind", &need_sizes},
  {"-vesicle_packing", OPT_REAL, AT(vesicles.packing), "0", "[0,1]", "area fraction of ellipses packed into the box; their number follows, or with -vesicle_count their area; 0: they lie at -vesicle_center", &need_ellipses},
  {"-vesicle_packing_type", OPT_ENUM, AT(vesicles.packing_type), "random", "random|lattice", "random places and angles, or a rectangular lattice with -vesicle_angle", &need_packing},
  {"-vesicle_packing_seed", OPT_INT, AT(vesicles.packing_seed), "1", ">=0", "of the random packing: the same seed gives the same vesicles", &need_random},
  {"-vesicle_packing_gap", OPT_REAL, AT(vesicles.packing_gap), "0", ">=0", "least distance of packed vesicles from one another and from walls; 0: a cell, at most R0/20, but at least 0.6 marker spacings with the exact near field (length)", &need_packing},
  {"-vesicle_bending", OPT_REALS, AT(membrane.stiffness), "0.01", ">=0", "c_b, bending stiffness, one for all, or one a vesicle or kind; 0 leaves bending out (length^5/time^2)", &need_vesicles, IN_SPACE},
  {"-vesicle_density_difference", OPT_REALS, AT(gravity.density), "0", "any", "density inside less density outside, over that outside; one for all, or one a vesicle or kind", &need_gravity, IN_SPACE},
  {"-vesicle_viscosity_ratio", OPT_REALS, AT(membrane.viscosity_ratio), "1", "[0.02,200]", "coupled: viscosity inside over -fluid_viscosity, which is outside; one for all, or one a vesicle or kind; other than 1 the flow is quasi-steady", &need_vesicles, IN_SPACE},
  {"-vesicle_spacing", OPT_REAL, AT(vesicles.spacing), "0", ">=0", "marker spacing ds/h; 0: by the shape with -coupling_near_field exact (45 markers, more on thin vesicles, at most 2 h apart), else the kernel's (" KERNEL_SPACINGS ")", &need_vesicles},
  {"-vesicle_markers", OPT_INT, AT(vesicles.markers), "0", ">=0", "number of markers of each vesicle, instead of the spacing; 0 takes the spacing", &need_vesicles},
  {"-vesicle_allow_close_markers", OPT_BOOL, AT(vesicles.allow_close_markers), "false", "true|false", "accept spacings below the least: 0.3 h with -coupling_near_field exact, else the kernel's (" KERNEL_LEAST_SPACINGS ")", &need_vesicles, MAY_CHANGE},
  {"-vesicle_spheroid", OPT_ENUM, AT(space.spheroid), "prolate", "prolate|oblate|capsule", "three dimensions: initial shape, a spheroid about -vesicle_axis, or nearly a cylinder with round ends", &need_space, IN_SPACE},
  {"-vesicle_radius", OPT_REALS, AT(space.radius), "1", ">0", "R0 of the volume 4 pi R0^3/3, one for all, or one a vesicle (length)", &need_space, IN_SPACE},
  {"-vesicle_reduced_volume", OPT_REALS, AT(space.reduced_volume), "0.9", "(0,1]", "v = 6 sqrt(pi) volume/area^(3/2), one for all, or one a vesicle", &need_space, IN_SPACE},
  {"-vesicle_half_axes", OPT_REALS, AT(space.half_axes), "1,1,1", ">0", "of an ellipsoid, in place of radius and reduced volume, the first along -vesicle_axis; three for all, or three a vesicle (length)", &need_space, IN_SPACE},
  {"-vesicle_axis", OPT_REALS, AT(space.axis), "1,0,0", "any", "direction of a spheroid's axis, of any length; three numbers for all, or three a vesicle", &need_space, IN_SPACE},
  {"-obstacle_shape", OPT_ENUM, AT(obstacles.shape), "none", "none|posts|couette|constriction|file", "solid bodies in the fluid: circles, two circles with fluid between them, two bumps on the walls y_min and y_max that face one another, curves of a file"},
  {"-obstacle_radius", OPT_REALS, AT(obstacles.radius), "0.2", ">0", "of posts: one for all or one each; of couette: the inner and the outer one (length)", &need_circles},
  {"-obstacle_center", OPT_REALS, AT(obstacles.center), "0,0", "any", "x,y of the centres: a pair a post; of couette one for both circles or one each; of a constriction x counts (length)", &need_solid_centers},
  {"-obstacle_count", OPT_INT, AT(obstacles.posts.count), "0", ">=0", "posts that are packed at random into the box, together with vesicles that are (-vesicle_packing, its seed and gap), in place of -obstacle_center; 0: none", &need_posts},
  {"-obstacle_lattice", OPT_INTS, AT(obstacles.posts.lattice), "0,0", ">=0", "posts: columns and rows that fill the box, in place of -obstacle_center; 0,0: none", &need_posts},
  {"-obstacle_shift", OPT_REAL, AT(obstacles.posts.shift), "0", "any", "lattice of posts: how far a row stands along x from the one below it, over the distance of columns", &need_posts},
  {"-obstacle_throat", OPT_REAL, AT(obstacles.throat), "0.5", "(0,1)", "constriction: its narrowest width over that of the channel", &need_constriction},
  {"-obstacle_length", OPT_REAL, AT(obstacles.length), "0", ">=0", "constriction: its length along x, a whole wave of a cosine; 0: as long as the channel is wide (length)", &need_constriction},
  {"-obstacle_velocity", OPT_REALS, AT(obstacles.move), "0,0", "any", "u_x,u_y of the fluid at the obstacles' surfaces, one for all or one each; the curves stay where they are without -obstacle_moving (length/time)", &need_circles},
  {"-obstacle_rotation", OPT_REALS, AT(obstacles.rotation), "0", "any", "rate at which the surfaces turn about their curves' middles, counter-clockwise, one for all or one each (1/time)", &need_circles},
  {"-obstacle_frequency", OPT_REAL, AT(obstacles.frequency), "0", ">=0", "the surfaces' velocities are those given times the cosine of this times the time: they swing (1/time)", &need_obstacles},
  {"-obstacle_moving", OPT_BOOL, AT(obstacles.moving), "false", "true|false", "closed obstacles move and turn as solid bodies with the velocities given (of a file: its lines # velocity and # rotation); false: they rest, and only their surfaces move", &need_obstacles},
  {"-obstacle_free", OPT_TEXT, AT(obstacles.free.which), "", "", "numbers of the closed obstacles, from 1 on, with commas between, that move and turn as the fluid carries them, or all", &need_obstacles},
  {"-obstacle_density", OPT_REALS, AT(obstacles.free.density), "1", ">0", "density of free obstacles over that of the fluid, for their weight under -fluid_gravity and their inertia; one for all or one an obstacle", &need_free},
  {"-obstacle_force", OPT_REALS, AT(obstacles.free.force), "0,0", "any", "f_x,f_y from outside on free obstacles, over the fluid's density and a unit of depth; a pair for all or one an obstacle (length^3/time^2)", &need_free},
  {"-obstacle_torque", OPT_REALS, AT(obstacles.free.torque), "0", "any", "torque from outside on free obstacles about their centroids, counter-clockwise; one for all or one an obstacle (length^4/time^2)", &need_free},
  {"-obstacle_file", OPT_PATH, AT(obstacles.file), "", "", "curves as -vesicle_file's, a clockwise one a container of the fluid; one after a line # open has its ends on a wall, one whose last point is the first but for a period spans the box, its solid on the left; lines # velocity u_x u_y and # rotation w before a curve are its own", &need_obstacle_file, MAY_CHANGE},
  {"-obstacle_spacing", OPT_REAL, AT(obstacles.spacing), "1", "[0.3,2]", "spacing ds/h of the obstacles' markers, without influence on the flow from 0.5 to 2 but for films thinner than it", &need_obstacles},
  {"-obstacle_factor", OPT_ENUM, AT(obstacles.factor), "auto", "auto|dense|modes", "preconditioner's block of the obstacles: the dense inverse of all; or that of each curve and a few points on every curve for what others do to it. auto: modes for more than 2000 markers in a box that is periodic both ways, or of -obstacle_free all in any box", &need_obstacles},
  {"-tracer_file", OPT_PATH, AT(tracers.file), "", "", "passive points that the flow carries along: x y a line"},
  {"-tracer_grid", OPT_INTS, AT(tracers.grid), "0,0", ">=0", "tracers besides: columns and rows at equal distances in the box; 0,0: none"},
  {"-delta_type", OPT_NAME, AT(coupling.kernel), "cbs54", KERNEL_NAMES, "kernel between grid and markers", &need_bodies},
  {"-scheme_type", OPT_NAME, AT(scheme.type), "coupled", "split|penalty|coupled", "time-stepping scheme: the paper's, stiff springs, unsplit", IN_SPACE},
  {"-scheme_order", OPT_INT, AT(scheme.order), "3", "[1,3]", "order in time: backward Euler, BDF2, or BDF3 wherever it predicts better", IN_SPACE},
  {"-scheme_auto", OPT_REAL, AT(scheme.wanted), "0", ">=0", "relative error wanted, 1e-4 to 0.1: steps, tolerances, markers, kernel, and the box and the grid that are not given, by what was measured; three dimensions: degree and steps; 0 off", &need_vesicles, MAY_CHANGE, IN_SPACE},
  {"-penalty_stiffness", OPT_REAL, AT(scheme.stiffness), "0", ">=0", "penalty: sigma_0 of the springs sigma = sigma_0 (|X_s| - 1) (length^3/time^2); 0 takes half of what the step bears", &need_penalty},
  {"-scheme_length_target", OPT_BOOL, AT(scheme.length_target), "true", "true|false", "coupled: each step aims at edges of their first length", &need_coupled},
  {"-coupling_near_field", OPT_ENUM, AT(coupling.near_field), "exact", "exact|none", "coupled: correct the markers' velocity for the smoothing by kernel and grid, to the exact single layer; none: do not", &need_bodies},
  {"-coupling_box_part", OPT_BOOL, AT(coupling.box_part), "true", "true|false", "with the exact near field: the grid's error of second order in what walls and periodic images do is taken off", &need_bodies},
  {"-contact_repulsion", OPT_REAL, AT(repulsion.stress), "0", ">=0", "coupled: K, stress that pushes membranes from one another, from other parts of themselves and from walls, K (1 - d/D) at a distance d, and free obstacles from them, from one another and from walls (length^2/time^2); 0: none", &need_heavy, IN_SPACE},
  {"-contact_repulsion_range", OPT_REAL, AT(repulsion.range), "0", ">=0", "D, up to which it acts (length); 0: 1.5 times the longest mean edge, in three dimensions a tenth of the least R0", &need_repulsion, IN_SPACE},
  {"-contact_adhesion", OPT_REAL, AT(repulsion.adhesion), "0", ">=0", "with a repulsion: W, energy a length, in three dimensions an area, of membranes, bodies and walls that stick together at the distance D (length^3/time^2); 0: none", &need_repulsion, IN_SPACE},
  {"-contact_adhesion_range", OPT_REAL, AT(repulsion.band), "0", ">=0", "B, width of the band from D to D + B in which they are drawn together (length); 0: D", &need_adhesion, IN_SPACE},
  {"-contact_potential", OPT_REAL, AT(potential.strength), "0", ">=0", "coupled: H of the potential H ((d/z)^m - m/n (d/z)^n) between the points of different membranes, a length of both, z their distance (length^2/time^2); 0: none", &need_coupled},
  {"-contact_potential_distance", OPT_REAL, AT(potential.distance), "0", ">=0", "d, at which the potential is least (length)", &need_potential},
  {"-contact_potential_exponents", OPT_REALS, AT(potential.exponents), "4,2", ">0", "m,n with m > n", &need_potential},
  {"-membrane_derivative", OPT_ENUM, AT(membrane.derivative), "spectral", "fd|bending|spectral", "derivatives along the membrane: finite differences, without area target; spectral bending, spectral bending and edges", &need_vesicles},
  {"-membrane_law", OPT_INTS, AT(membrane.law), "inextensible", "inextensible|hooke|green|neo_hookean", "coupled: how membranes stretch, tension T by the stretch L: not at all; T = E_s (L - 1); T = E_s/2 (L^3 - L); T = E_s/3 (L^1.5 - L^-1.5); one for all, or one a vesicle or kind", &need_vesicles},
  {"-membrane_stretching", OPT_REALS, AT(membrane.stretching), "0", ">=0", "E_s of -membrane_law, one for all, or one a vesicle or kind; 0: does not stretch (length^3/time^2)", &need_vesicles},
  {"-membrane_moment", OPT_ENUM, AT(membrane.moment), "quadratic", "quadratic|angle|helfrich", "bending energy of membranes that stretch, a length at rest: c_b/2 times |X_ss|^2 by the length at rest s, the angle a length squared, or the curvature squared times the stretch", &need_vesicles},
  {"-membrane_viscosity", OPT_REALS, AT(membrane.viscosity), "0", ">=0", "of membranes that stretch: tension over the rate of the stretch, one for all, or one a vesicle or kind (length^3/time)", &need_vesicles},
  {"-membrane_permeability", OPT_REAL, AT(membrane.permeability), "0", ">=0", "coupled: water passes the membranes at this times the normal stress inside less that outside, where viscosities are alike its pressure; 0: none (time/length)", &need_vesicles},
  {"-membrane_osmotic", OPT_REALS, AT(membrane.osmotic), "0,0", ">=0", "of permeable membranes: osmotic pressures inside, at the first area, and outside; the higher one draws water (length^2/time^2)", &need_vesicles},
  {"-membrane_memory", OPT_REALS, AT(membrane.memory), "0", ">=0", "coupled: shape memory, bending prefers this times the curvature that each part of the membrane has at rest (-membrane_rest), one for all, or one a vesicle or kind; 0: no curvature", &need_vesicles},
  {"-membrane_rest", OPT_PATH, AT(membrane.rest), "initial", "", "of membranes that stretch or remember: the shape at rest, the initial one, a circle of its length, or the curve of a file (initial|circle|FILE); its first point is that of the initial curve", &need_vesicles},
  {"-scheme_startup", OPT_ENUM, AT(scheme.startup), "graded", "euler|graded", "first step of orders 2 and 3: backward Euler, or five growing parts of a step", &need_order},
  {"-tube_radius", OPT_REAL, AT(space.tube.radius), "0", ">=0", "axisymmetric: radius of a circular tube about the axis x (length); 0: unbounded fluid", &need_axial, IN_SPACE},
  {"-tube_pressure_drop", OPT_REAL, AT(space.tube.pressure_drop), "0", "any", "in place of -flow_peak_velocity: pressure drop along -tube_period, vesicles included, over the density (length^2/time^2)", &need_tube, IN_SPACE},
  {"-tube_period", OPT_REAL, AT(space.tube.period), "0", ">=0", "length of tube over which -tube_pressure_drop is given (length); 0: the flux is given", &need_tube, IN_SPACE},
  {"-tube_throat", OPT_REAL, AT(space.tube.throat), "0", ">=0", "radius to which the tube narrows in a throat (length); 0: no throat", &need_tube, IN_SPACE},
  {"-tube_throat_center", OPT_REAL, AT(space.tube.throat_center), "0", "any", "x of the middle of the throat (length)", &need_throat, IN_SPACE},
  {"-tube_throat_length", OPT_REAL, AT(space.tube.throat_length), "0", ">=0", "of the part of the throat that has its radius (length)", &need_throat, IN_SPACE},
  {"-tube_throat_mouth", OPT_REAL, AT(space.tube.throat_mouth), "0", ">=0", "length of either mouth, along which the radius changes as a cosine (length); 0: -tube_radius", &need_throat, IN_SPACE},
  {"-sphere_degree", OPT_INT, AT(space.degree), "12", "[4,64]", "p, even: a shape has (p + 1)^2 spherical harmonics for each coordinate, and its tension as many; axisymmetric: p + 1; up to 32 with -dim 3", &need_space, IN_SPACE},
  {"-sphere_label_rate", OPT_REAL, AT(space.label_rate), "0", ">=0", "rate at which labels are drawn to a spectrum that falls off (1/time); 0: 10 times the larger of the flow's rate and bending/(nu R0^3)", &need_space, IN_SPACE},
  {"-bending_newton", OPT_INT, AT(space.newton), "1", "[1,2]", "Newton steps on the bending energy within a time step; 2: larger steps of stiff membranes", &need_space, MAY_CHANGE, IN_SPACE},
  {"-time_step", OPT_REAL, AT(time.dt), "0.01", ">0", "dt (time)", NULL, MAY_CHANGE, IN_SPACE},
  {"-time_end", OPT_REAL, AT(time.end), "1", ">=0", "end time, reached exactly: the last steps are shortened (time)", NULL, MAY_CHANGE, IN_SPACE},
  {"-time_adapt", OPT_ENUM, AT(time.adapt), "none", "none|error", "step size: fixed, or from an error estimate (coupled of order 2 or 3)", &need_adaptable, IN_SPACE},
  {"-time_adapt_tol", OPT_REAL, AT(time.adapt_tol), "1e-4", ">0", "error estimate accepted a step, in units of R0", &need_adapt, MAY_CHANGE, IN_SPACE},
  {"-time_adapt_max_move", OPT_REAL, AT(time.adapt_max_move), "1", ">=0", "cells that a marker may move in a step relative to its vesicle; 0 no limit", &need_adapt, MAY_CHANGE},
  {"-time_adapt_max_step", OPT_REAL, AT(time.adapt_max_step), "0", ">=0", "largest step that -time_adapt error takes; 0 no limit", &need_adapt, MAY_CHANGE, IN_SPACE},
  {"-time_cfl_limit", OPT_REAL, AT(time.cfl_limit), "0.5", ">0", "convective: largest dt max(|u| + |v|)/h; -time_adapt error stays below it, a fixed step above it stops the run", &need_convection},
  {"-time_steady_tol", OPT_REAL, AT(time.steady_tol), "0", ">=0", "stop when normal_speed, max |u.n| on a membrane, falls below it; 0 never (length/time)", &need_vesicles, MAY_CHANGE, IN_SPACE},
  {"-helmholtz_type", OPT_NAME, AT(fluid.helmholtz), "fftw_tridiagonal", "fftw_tridiagonal|fftw|hypre", "fast solver of the velocity Helmholtz problems", &need_grid, MAY_CHANGE},
  {"-poisson_type", OPT_NAME, AT(fluid.poisson), "fftw_tridiagonal", "fftw_tridiagonal|fftw|hypre", "fast solver of the pressure Poisson problems", &need_grid, MAY_CHANGE},
  {"-output_dir", OPT_PATH, AT(output.dir), "out/run", "", "folder of every output file", NULL, MAY_CHANGE, IN_SPACE},
  {"-output_overwrite", OPT_BOOL, AT(output.overwrite), "false", "true|false", "replace the results that -output_dir holds already", NULL, MAY_CHANGE, IN_SPACE},
  {"-output_every", OPT_REAL, AT(output.every), "0.1", ">0", "time between saved fields; adaptive steps end at its multiples", NULL, MAY_CHANGE, IN_SPACE},
  {"-output_precision", OPT_ENUM, AT(output.precision), "double", "double|single", "of saved velocity and pressure; single takes half the room"},
  {"-checkpoint_every", OPT_INT, AT(output.checkpoint_every), "100", ">=0", "steps between checkpoints; 0 writes one at the end only", NULL, MAY_CHANGE, IN_SPACE},
  {"-checkpoint_keep", OPT_INT, AT(output.checkpoint_keep), "2", "[1,100]", "checkpoints kept: checkpoint.h5, the one before it checkpoint_1.h5, and so on", NULL, MAY_CHANGE, IN_SPACE},
  {"-restart", OPT_PATH, AT(output.restart), "", "", "go on from this checkpoint, in its folder or in a new -output_dir", NULL, MAY_CHANGE, IN_SPACE},
  {"-time_wall_limit", OPT_REAL, AT(time.wall_limit), "0", ">=0", "stop with a checkpoint before this much wall time has passed; 0 never (seconds)", NULL, MAY_CHANGE, IN_SPACE},
  {"-limit_edge_ratio", OPT_REAL, AT(limits.edge_ratio), "5", ">=0", "stop when a vesicle's longest edge is more than this many times its shortest; 0 no limit", &need_vesicles, MAY_CHANGE},
  {"-limit_area_error", OPT_REAL, AT(limits.area_error), "0.2", ">=0", "stop when a vesicle's area is off by more than this part of its first; 0 no limit", &need_vesicles, MAY_CHANGE},
  {"-limit_length_error", OPT_REAL, AT(limits.length_error), "0.2", ">=0", "stop when a vesicle's length is off by more than this part of its first; 0 no limit", &need_vesicles, MAY_CHANGE},
  {"-limit_gap_loss", OPT_REAL, AT(limits.gap_loss), "0.5", "[0,1]", "stop when a step takes more than this part of a film between vesicles, or vesicle and wall, that is then thinner than half an edge (a cell without near field); -time_adapt error takes a smaller step; 0 no limit", &need_vesicles, MAY_CHANGE},
  {"-limit_crossing", OPT_BOOL, AT(limits.crossing), "true", "true|false", "stop when membranes cross, one another or themselves", &need_vesicles, MAY_CHANGE},
  {"-view", OPT_BOOL, AT(view), "false", "true|false", "print the model in force and the solvers", NULL, MAY_CHANGE, IN_SPACE},
  {"-allow_unused_options", OPT_BOOL, AT(allow_unused), "false", "true|false", "go on when an option is misspelt or unused", NULL, MAY_CHANGE, IN_SPACE},
};
/* clang-format on */
#define TABLE_SIZE ((PetscInt)(sizeof(table) / sizeof(table[0])))

const char *const scene_alternatives[][2] = {{"-flow_chi", "-flow_rate"},
                                             {"-flow_chi", "-flow_ca_stretching"},
                                             {"-flow_ca_stretching", "-flow_rate"},
                                             {"-flow_ca", "-flow_peak_velocity"},
                                             {"-tube_pressure_drop", "-flow_peak_velocity"},
                                             {"-tube_pressure_drop", "-flow_ca"},
                                             {"-vesicle_semi_axes", "-vesicle_area"},
                                             {"-vesicle_semi_axes", "-vesicle_reduced_area"},
                                             {"-vesicle_half_axes", "-vesicle_radius"},
                                             {"-vesicle_half_axes", "-vesicle_reduced_volume"},
                                             {"-vesicle_markers", "-vesicle_spacing"},
                                             {"-obstacle_center", "-obstacle_lattice"},
                                             {"-obstacle_center", "-obstacle_count"},
                                             {NULL, NULL}};

PetscErrorCode SceneReadOptions(MPI_Comm comm, Draft scene) {
  PetscFunctionBeginUser;
  scene->options.missing = SceneSpaceMissing;
  PetscCall(OptionsRead(comm, "petves: vesicles and capsules in viscous flow", TABLE_SIZE, table, scene_defaults,
                        &scene->options, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const OptionRow *SceneOptionRow(PetscInt i) {
  return i < TABLE_SIZE ? &table[i] : NULL;
}

PetscErrorCode SceneWriteOptions(Scene scene, FILE *file) {
  /* what one launch was asked to do with an earlier run's files is no part of the run; both descriptions of the
     ellipse, or of the flow, would be refused when read back */
  const PetscBool by_area = SceneByArea(scene), packed = scene->vesicles.packing > 0;
  const PetscBool counted = SceneGiven(scene, "-vesicle_count");
  const char *skip[12] = {"-restart", "-output_overwrite", "-flow_chi", "-flow_ca", "-flow_ca_stretching"};
  PetscInt skipped = 5;
  PetscFunctionBeginUser;
  if (scene->space.tube.period > 0) skip[skipped++] = "-flow_peak_velocity";
  if (by_area) skip[skipped++] = "-vesicle_semi_axes";
  if (packed && !counted) skip[skipped++] = "-vesicle_count"; /* of fraction, number and area two say the third */
  if (!by_area || (packed && counted)) skip[skipped++] = "-vesicle_area";
  if (!by_area) skip[skipped++] = "-vesicle_reduced_area";
  if (!SceneGiven(scene, "-vesicle_half_axes")) {
    skip[skipped++] = "-vesicle_half_axes";
  } else {
    skip[skipped++] = "-vesicle_radius";
    skip[skipped++] = "-vesicle_reduced_volume";
  }
  PetscCall(OptionsWrite(&scene->options, scene, skip, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}
