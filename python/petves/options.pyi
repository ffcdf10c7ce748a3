# fmt: off
"""The program's options, for editors that complete names; python/check_options.py --write makes this file."""

from collections.abc import Sequence
from os import PathLike
from typing import Literal, TypedDict

import numpy as np

Value = str | float | bool | PathLike[str] | np.ndarray | Sequence[str | float | Sequence[float]] | None

class Options(TypedDict, total=False):
    domain_box: Value  # x_min,x_max,y_min,y_max (length)
    domain_cells: Value  # cells in x and y; cells must be square
    domain_bc_x: Literal['wall', 'periodic', 'free'] | None  # boundaries at x_min and x_max; free (in x and y): unbounded fluid, the box is the window of the fields
    domain_bc_y: Literal['wall', 'periodic', 'free'] | None  # boundaries at y_min and y_max; periodic where x is periodic too
    flow_type: Literal['quiescent', 'shear', 'poiseuille', 'extension', 'uniform', 'custom', 'formula', 'axial', 'tube'] | None  # background flow; custom: a function given from Python or C; formula: -flow_u and -flow_v, which need no -flow_type
    flow_rate: Value  # rate of shear or extension (1/time)
    flow_chi: Value  # in place of -flow_rate: chi = rate nu R0^3/c_b, R0 of the largest vesicle
    flow_ca_stretching: Value  # in place of -flow_rate: capillary number nu rate R0/E_s, R0 of the largest vesicle, E_s the largest -membrane_stretching
    flow_peak_velocity: Value  # u_max of poiseuille (length/time)
    flow_ca: Value  # in place of -flow_peak_velocity: u_max nu R0^2/c_b, the paper's w
    flow_velocity: Value  # uniform: u_x,u_y (length/time)
    flow_u: Value  # formula: u_x as a formula of x, y and t, in quotes, such as "sin(pi*y)*cos(2*t)"; a blank goes before a minus sign at its beginning (length/time)
    flow_v: Value  # formula: u_y (length/time)
    flow_w: Value  # formula in three dimensions: u_z, and all three formulas may have z (length/time)
    flow_half_width: Value  # L_y of poiseuille: half the channel's height (length); between walls in y: half their distance
    flow_center_x: Value  # x_c of the background flow (length)
    flow_center_y: Value  # y_c of the background flow (length); poiseuille between walls in y: their middle
    flow_form: Literal['disturbance', 'total'] | None  # solve for u - u_inf, or (split, penalty) for u with moving walls as the paper
    flow_drive: Literal['pressure', 'flux'] | None  # channel, periodic in x: which quantity vesicles and obstacles do not change, the mean pressure gradient or the flux
    fluid_viscosity: Value  # nu (length^2/time; density is 1)
    fluid_inertia: Literal['auto', 'none', 'unsteady', 'convective'] | None  # inertia of the fluid: quasi-steady Stokes, unsteady Stokes, Navier-Stokes; auto goes by flow and Reynolds number
    fluid_gravity: Value  # gravity g_x,g_y (length/time^2); it moves vesicles by -vesicle_density_difference, free obstacles by -obstacle_density
    vesicle_shape: Literal['ellipse', 'biconcave', 'file', 'none'] | None  # initial shape; biconcave: the red cell's outline
    vesicle_count: Value  # number of vesicles; a file has its own number of curves, a packing the number that it takes
    vesicle_semi_axes: Value  # semi-axes of the ellipse, two for all, or two a vesicle or kind (length)
    vesicle_area: Value  # area, with -vesicle_reduced_area; one for all, or one a vesicle or kind (length^2)
    vesicle_reduced_area: Value  # V = area/(pi R0^2), R0 = perimeter/(2 pi); long axis along x; biconcave: 0.35 to 0.9, 0.65 when not given
    vesicle_center: Value  # x,y of the centre, a pair a vesicle; file: added to its coordinates, one pair for all or one each (length)
    vesicle_angle: Value  # counter-clockwise turn about the centre, file: about each curve's centroid; one for all or one a vesicle (degrees)
    vesicle_file: Value  # closed curves: x y a line, an empty line between curves, for -vesicle_shape file; three dimensions, without it: surfaces, points x y z a line, or coefficients l m c_x c_y c_z of spherical harmonics
    vesicle_mixture: Value  # fraction of the vesicles that are of each kind, adding up to 1; lists of area, reduced area, semi-axes and bending then have an entry for each kind
    vesicle_packing: Value  # area fraction of ellipses packed into the box; their number follows, or with -vesicle_count their area; 0: they lie at -vesicle_center
    vesicle_packing_type: Literal['random', 'lattice'] | None  # random places and angles, or a rectangular lattice with -vesicle_angle
    vesicle_packing_seed: Value  # of the random packing: the same seed gives the same vesicles
    vesicle_packing_gap: Value  # least distance of packed vesicles from one another and from walls; 0: a cell, at most R0/20, but at least 0.6 marker spacings with the exact near field (length)
    vesicle_bending: Value  # c_b, bending stiffness, one for all, or one a vesicle or kind; 0 leaves bending out (length^5/time^2)
    vesicle_density_difference: Value  # density inside less density outside, over that outside; one for all, or one a vesicle or kind
    vesicle_viscosity_ratio: Value  # coupled: viscosity inside over -fluid_viscosity, which is outside; one for all, or one a vesicle or kind; other than 1 the flow is quasi-steady
    vesicle_spacing: Value  # marker spacing ds/h; 0: by the shape with -coupling_near_field exact (45 markers, more on thin vesicles, at most 2 h apart), else the kernel's (ib6 1.75, cbs54 1.5)
    vesicle_markers: Value  # number of markers of each vesicle, instead of the spacing; 0 takes the spacing
    vesicle_allow_close_markers: Literal['true', 'false'] | None  # accept spacings below the least: 0.3 h with -coupling_near_field exact, else the kernel's (ib6 1.25, cbs54 1)
    vesicle_spheroid: Literal['prolate', 'oblate', 'capsule'] | None  # three dimensions: initial shape, a spheroid about -vesicle_axis, or nearly a cylinder with round ends
    vesicle_radius: Value  # R0 of the volume 4 pi R0^3/3, one for all, or one a vesicle (length)
    vesicle_reduced_volume: Value  # v = 6 sqrt(pi) volume/area^(3/2), one for all, or one a vesicle
    vesicle_half_axes: Value  # of an ellipsoid, in place of radius and reduced volume, the first along -vesicle_axis; three for all, or three a vesicle (length)
    vesicle_axis: Value  # direction of a spheroid's axis, of any length; three numbers for all, or three a vesicle
    obstacle_shape: Literal['none', 'posts', 'couette', 'constriction', 'file'] | None  # solid bodies in the fluid: circles, two circles with fluid between them, two bumps on the walls y_min and y_max that face one another, curves of a file
    obstacle_radius: Value  # of posts: one for all or one each; of couette: the inner and the outer one (length)
    obstacle_center: Value  # x,y of the centres: a pair a post; of couette one for both circles or one each; of a constriction x counts (length)
    obstacle_count: Value  # posts that are packed at random into the box, together with vesicles that are (-vesicle_packing, its seed and gap), in place of -obstacle_center; 0: none
    obstacle_lattice: Value  # posts: columns and rows that fill the box, in place of -obstacle_center; 0,0: none
    obstacle_shift: Value  # lattice of posts: how far a row stands along x from the one below it, over the distance of columns
    obstacle_throat: Value  # constriction: its narrowest width over that of the channel
    obstacle_length: Value  # constriction: its length along x, a whole wave of a cosine; 0: as long as the channel is wide (length)
    obstacle_velocity: Value  # u_x,u_y of the fluid at the obstacles' surfaces, one for all or one each; the curves stay where they are without -obstacle_moving (length/time)
    obstacle_rotation: Value  # rate at which the surfaces turn about their curves' middles, counter-clockwise, one for all or one each (1/time)
    obstacle_frequency: Value  # the surfaces' velocities are those given times the cosine of this times the time: they swing (1/time)
    obstacle_moving: Literal['true', 'false'] | None  # closed obstacles move and turn as solid bodies with the velocities given (of a file: its lines # velocity and # rotation); false: they rest, and only their surfaces move
    obstacle_free: Value  # numbers of the closed obstacles, from 1 on, with commas between, that move and turn as the fluid carries them, or all
    obstacle_density: Value  # density of free obstacles over that of the fluid, for their weight under -fluid_gravity and their inertia; one for all or one an obstacle
    obstacle_force: Value  # f_x,f_y from outside on free obstacles, over the fluid's density and a unit of depth; a pair for all or one an obstacle (length^3/time^2)
    obstacle_torque: Value  # torque from outside on free obstacles about their centroids, counter-clockwise; one for all or one an obstacle (length^4/time^2)
    obstacle_file: Value  # curves as -vesicle_file's, a clockwise one a container of the fluid; one after a line # open has its ends on a wall, one whose last point is the first but for a period spans the box, its solid on the left; lines # velocity u_x u_y and # rotation w before a curve are its own
    obstacle_spacing: Value  # spacing ds/h of the obstacles' markers, without influence on the flow from 0.5 to 2 but for films thinner than it
    obstacle_factor: Literal['auto', 'dense', 'modes'] | None  # preconditioner's block of the obstacles: the dense inverse of all; or that of each curve and a few points on every curve for what others do to it. auto: modes for more than 2000 markers in a box that is periodic both ways, or of -obstacle_free all in any box
    tracer_file: Value  # passive points that the flow carries along: x y a line
    tracer_grid: Value  # tracers besides: columns and rows at equal distances in the box; 0,0: none
    delta_type: Literal['ib6', 'cbs54'] | None  # kernel between grid and markers; split, penalty: ib6
    scheme_type: Literal['split', 'penalty', 'coupled'] | None  # time-stepping scheme: the paper's, stiff springs, unsplit
    scheme_order: Value  # order in time: backward Euler, BDF2, or BDF3 wherever it predicts better; split and penalty are of order 1
    scheme_auto: Value  # relative error wanted, 1e-4 to 0.1: steps, tolerances, markers, kernel, and the box and the grid that are not given, by what was measured; three dimensions: degree and steps; 0 off
    penalty_stiffness: Value  # penalty: sigma_0 of the springs sigma = sigma_0 (|X_s| - 1) (length^3/time^2); 0 takes half of what the step bears
    scheme_length_target: Literal['true', 'false'] | None  # coupled: each step aims at edges of their first length
    coupling_near_field: Literal['exact', 'none'] | None  # coupled: correct the markers' velocity for the smoothing by kernel and grid, to the exact single layer; none: do not
    coupling_box_part: Literal['true', 'false'] | None  # with the exact near field: the grid's error of second order in what walls and periodic images do is taken off; default false from 256 cells across on
    contact_repulsion: Value  # coupled: K, stress that pushes membranes from one another, from other parts of themselves and from walls, K (1 - d/D) at a distance d, and free obstacles from them, from one another and from walls (length^2/time^2); 0: none
    contact_repulsion_range: Value  # D, up to which it acts (length); 0: 1.5 times the longest mean edge, in three dimensions a tenth of the least R0
    contact_adhesion: Value  # with a repulsion: W, energy a length, in three dimensions an area, of membranes, bodies and walls that stick together at the distance D (length^3/time^2); 0: none
    contact_adhesion_range: Value  # B, width of the band from D to D + B in which they are drawn together (length); 0: D
    contact_potential: Value  # coupled: H of the potential H ((d/z)^m - m/n (d/z)^n) between the points of different membranes, a length of both, z their distance (length^2/time^2); 0: none
    contact_potential_distance: Value  # d, at which the potential is least (length)
    contact_potential_exponents: Value  # m,n with m > n
    membrane_derivative: Literal['fd', 'bending', 'spectral'] | None  # derivatives along the membrane: finite differences, without area target; spectral bending, spectral bending and edges; split, penalty: fd
    membrane_law: Value  # coupled: how membranes stretch, tension T by the stretch L: not at all; T = E_s (L - 1); T = E_s/2 (L^3 - L); T = E_s/3 (L^1.5 - L^-1.5); one for all, or one a vesicle or kind
    membrane_stretching: Value  # E_s of -membrane_law, one for all, or one a vesicle or kind; 0: does not stretch (length^3/time^2)
    membrane_moment: Literal['quadratic', 'angle', 'helfrich'] | None  # bending energy of membranes that stretch, a length at rest: c_b/2 times |X_ss|^2 by the length at rest s, the angle a length squared, or the curvature squared times the stretch
    membrane_viscosity: Value  # of membranes that stretch: tension over the rate of the stretch, one for all, or one a vesicle or kind (length^3/time)
    membrane_permeability: Value  # coupled: water passes the membranes at this times the normal stress inside less that outside, where viscosities are alike its pressure; 0: none (time/length)
    membrane_osmotic: Value  # of permeable membranes: osmotic pressures inside, at the first area, and outside; the higher one draws water (length^2/time^2)
    membrane_memory: Value  # coupled: shape memory, bending prefers this times the curvature that each part of the membrane has at rest (-membrane_rest), one for all, or one a vesicle or kind; 0: no curvature
    membrane_rest: Value  # of membranes that stretch or remember: the shape at rest, the initial one, a circle of its length, or the curve of a file (initial|circle|FILE); its first point is that of the initial curve
    scheme_startup: Literal['euler', 'graded'] | None  # first step of orders 2 and 3: backward Euler, or five growing parts of a step
    tube_radius: Value  # axisymmetric: radius of a circular tube about the axis x (length); 0: unbounded fluid
    tube_pressure_drop: Value  # in place of -flow_peak_velocity: pressure drop along -tube_period, vesicles included, over the density (length^2/time^2)
    tube_period: Value  # length of tube over which -tube_pressure_drop is given (length); 0: the flux is given
    tube_throat: Value  # radius to which the tube narrows in a throat (length); 0: no throat
    tube_throat_center: Value  # x of the middle of the throat (length)
    tube_throat_length: Value  # of the part of the throat that has its radius (length)
    tube_throat_mouth: Value  # length of either mouth, along which the radius changes as a cosine (length); 0: -tube_radius
    sphere_degree: Value  # p, even: a shape has (p + 1)^2 spherical harmonics for each coordinate, and its tension as many; axisymmetric: p + 1; up to 32 with -dim 3
    sphere_label_rate: Value  # rate at which labels are drawn to a spectrum that falls off (1/time); 0: 10 times the larger of the flow's rate and bending/(nu R0^3)
    bending_newton: Value  # Newton steps on the bending energy within a time step; 2: larger steps of stiff membranes
    time_step: Value  # dt (time)
    time_end: Value  # end time, reached exactly: the last steps are shortened (time)
    time_adapt: Literal['none', 'error'] | None  # step size: fixed, or from an error estimate (coupled of order 2 or 3)
    time_adapt_tol: Value  # error estimate accepted a step, in units of R0
    time_adapt_max_move: Value  # cells that a marker may move in a step relative to its vesicle; 0 no limit
    time_adapt_max_step: Value  # largest step that -time_adapt error takes; 0 no limit; not given: 1/(rate (1 + 0.03 chi)) in a flow, nu R0^3/c_b without one (time)
    time_cfl_limit: Value  # convective: largest dt max(|u| + |v|)/h; -time_adapt error stays below it, a fixed step above it stops the run
    time_steady_tol: Value  # stop when normal_speed, max |u.n| on a membrane, falls below it; 0 never (length/time)
    helmholtz_type: Literal['fftw_tridiagonal', 'fftw', 'hypre'] | None  # fast solver of the velocity Helmholtz problems
    poisson_type: Literal['fftw_tridiagonal', 'fftw', 'hypre'] | None  # fast solver of the pressure Poisson problems
    output_dir: Value  # folder of every output file
    output_overwrite: Literal['true', 'false'] | None  # replace the results that -output_dir holds already
    output_every: Value  # time between saved fields; adaptive steps end at its multiples; not given: 0.1, or so many times more (1, 2, 5, 10 ...) that there are at most 100 (time)
    output_precision: Literal['double', 'single'] | None  # of saved velocity and pressure; single takes half the room
    checkpoint_every: Value  # steps between checkpoints; 0 writes one at the end only
    checkpoint_keep: Value  # checkpoints kept: checkpoint.h5, the one before it checkpoint_1.h5, and so on
    restart: Value  # go on from this checkpoint, in its folder or in a new -output_dir
    time_wall_limit: Value  # stop with a checkpoint before this much wall time has passed; 0 never (seconds)
    limit_edge_ratio: Value  # stop when a vesicle's longest edge is more than this many times its shortest; 0 no limit
    limit_area_error: Value  # stop when a vesicle's area is off by more than this part of its first; 0 no limit
    limit_length_error: Value  # stop when a vesicle's length is off by more than this part of its first; 0 no limit
    limit_gap_loss: Value  # stop when a step takes more than this part of a film between vesicles, or vesicle and wall, that is then thinner than half an edge (a cell without near field); -time_adapt error takes a smaller step; 0 no limit
    limit_crossing: Literal['true', 'false'] | None  # stop when membranes cross, one another or themselves
    view: Literal['true', 'false'] | None  # print the model in force and the solvers
    allow_unused_options: Literal['true', 'false'] | None  # go on when an option is misspelt or unused
    coupled_ksp_rtol: Value  # PETSc's, of the solver
    coupled_ksp_max_it: Value  # PETSc's, of the solver
    coupled_ksp_monitor: Value  # PETSc's, of the solver
    tension_ksp_rtol: Value  # PETSc's, of the solver
    tension_ksp_max_it: Value  # PETSc's, of the solver
    tension_ksp_monitor: Value  # PETSc's, of the solver
    bending_ksp_rtol: Value  # PETSc's, of the solver
    bending_ksp_max_it: Value  # PETSc's, of the solver
    bending_ksp_monitor: Value  # PETSc's, of the solver
