"""The maps of thin films, fluid of another viscosity inside, and obstacles: the coupled scheme, a panel a variant."""

from __future__ import annotations

from studies.stability.cells import Map
from studies.stability.maps import OVER_RATE, powers, relax, shear, times

PRESSED = (
    "-domain_box -4,4,-4,4 -domain_cells 64,64 -flow_type extension -flow_rate -1 -fluid_inertia none -vesicle_count 2 "
    "-vesicle_semi_axes 0.4,0.8 -vesicle_bending 0.002345"
)
WALL = (
    "-domain_box -2,2,-1,1 -domain_cells 64,32 -domain_bc_x periodic -fluid_inertia none -vesicle_semi_axes 0.35,0.2 "
    "-vesicle_bending 0.02"
)
THROAT = (
    "-domain_box 0,3,0,1 -domain_cells 96,32 -domain_bc_x periodic -flow_type poiseuille -flow_half_width 0.5 "
    "-flow_center_y 0.5 -flow_peak_velocity 1.5 -flow_drive flux -obstacle_shape constriction -obstacle_length 1 "
    "-obstacle_center 1.5,0 -vesicle_area 0.1979203 -vesicle_reduced_area 0.7 -vesicle_center 0.6,0.5 -vesicle_bending 0.1"
)
POST = (
    "-domain_box 0,2,0,2 -domain_cells 32,32 -domain_bc_x periodic -domain_bc_y periodic -flow_type uniform "
    "-flow_velocity 1,0 -obstacle_shape posts -obstacle_radius 0.3 -obstacle_center 1,1 -vesicle_area 0.19634954 "
    "-vesicle_reduced_area 0.7 -vesicle_angle 90 -vesicle_center 0.25,1"
)
BESIDE = "-obstacle_shape posts -obstacle_radius 0.2 -obstacle_center 0.5,0 -vesicle_center -0.3,0"
CAPSULE = (
    "-domain_bc_x free -domain_bc_y free -domain_box -4,4,-4,4 -domain_cells 32,32 -flow_type shear "
    "-vesicle_semi_axes 1,1 -vesicle_bending 0 -membrane_law hooke"
)
GAPS = (0.125, 0.25, 0.5, 1.0, 4.0)  # cells
RATIO, GAP, DT = "viscosity inside over outside", "gap at the start (cells)", "$dt$"
DIVIDED = "-vesicle_viscosity_ratio"


def pressed(dt: float, gap: float) -> str:
    """Return the options of two vesicles that an extension presses together, until t = 4."""
    center = 0.4 + gap * 0.125 / 2
    return f"{PRESSED} -vesicle_center {-center},0,{center},0 -time_step {dt!r} -time_end 4"


def at_wall(dt: float, gap: float) -> str:
    """Return the options of a vesicle along the lower wall of a sheared channel, until t = 4."""
    return f"{WALL} -vesicle_center 0,{gap / 16 - 0.8} -flow_type shear -time_step {dt!r} -time_end 4"


def throat(dt: float, width: float) -> str:
    """Return the options of a vesicle through a throat of so many of its diameters, until t = 0.84."""
    return f"{THROAT} -obstacle_throat {0.6 * width!r} -time_step {dt!r} -time_end 0.84"


def post(dt: float, c_b: float) -> str:
    """Return the options of a vesicle that a stream drapes round a post, until t = 1.92."""
    return f"{POST} -vesicle_bending {c_b} -time_step {dt!r} -time_end 1.92"


def capsule(dt: float, ca: float) -> str:
    """Return the options of a capsule in unbounded shear of rate 1, R0 = nu = 1."""
    return f"{CAPSULE} -membrane_stretching {1 / ca!r} {times(dt)}"


RATIOS = (0.1, 0.3, 1.0, 3.0, 10.0, 100.0)
# fmt: off
MAPS = (
    Map("ratio_rest", "ellipse at rest, $32^2$", RATIO, RATIOS, DT, (4.0, *powers(1, 3, 5, 7)),
        lambda ratio, dt: (f"{relax(dt, 1)} {DIVIDED} {ratio}",),
        {f"c_b = {c_b:g}": f"-vesicle_bending {c_b:g}" for c_b in (0.01, 1, 1000)}),
    Map("ratio_shear", "shear, V = 0.7, $64^2$", RATIO, RATIOS, OVER_RATE, powers(1, 2, 3, 4, 6),
        lambda ratio, dt: (f"{shear(dt, 0.7, 10)} {DIVIDED} {ratio} -fluid_inertia none",),
        {"chi = 10, walls": "", "chi = 10, channel": "-domain_bc_x periodic",
         "chi = 1000, walls": f"-vesicle_bending {0.3066 / 1000!r}"}),
    Map("bodies_cb", "ellipse at rest, $32^2$", "$c_b$", (1e-4, 1e-2, 1.0, 100.0), DT, powers(1, 3, 5, 7, 9),
        lambda c_b, dt: (relax(dt, c_b),),
        {"beside a post": BESIDE, "two": "-vesicle_count 2 -vesicle_center -0.3,0,0.3,0",
         "ratio 10": f"{DIVIDED} 10", "ratio 10, beside a post": f"{DIVIDED} 10 {BESIDE}"}),
    Map("film", r"two pressed by extension, $\chi = 100$, $64^2$", GAP, GAPS, OVER_RATE, powers(1, 2, 3, 5),
        lambda gap, dt: (pressed(dt, gap),),
        {"no repulsion": "", "repulsion": "-contact_repulsion 40", "ratio 10": f"{DIVIDED} 10",
         "steps by error": "-time_adapt error -time_adapt_tol 1e-3"}),
    Map("wall", "ellipse along a wall in shear, 32 cells across", GAP, (0.35, 0.5, 1.0, 2.0, 4.0), OVER_RATE, powers(1, 2, 3, 5),
        lambda gap, dt: (at_wall(dt, gap),),
        {"no repulsion": "", "repulsion": "-contact_repulsion 40", "ratio 10": f"{DIVIDED} 10",
         "pressed by gravity": "-fluid_gravity 0,-5 -vesicle_density_difference 1"}),
    Map("throat", "through a throat, 32 cells across", "throat over $2 R_0$", (0.9, 0.75, 0.6, 0.5, 0.45, 0.4), DT,
        tuple(0.0028 * 2**k for k in (4, 3, 2, 1, 0)), lambda width, dt: (throat(dt, width),),
        {"no repulsion": "", "repulsion": "-contact_repulsion 2000", "ratio 5": f"{DIVIDED} 5"}),
    Map("post", "draped round a post by a stream, $32^2$", "$c_b$", (1e-4, 1e-3, 1e-2, 0.1, 1.0), DT,
        tuple(0.02 * 2**k for k in (4, 3, 2, 1, 0)), lambda c_b, dt: (post(dt, c_b),),
        {"no repulsion": "", "repulsion": "-contact_repulsion 40", "ratio 10": f"{DIVIDED} 10",
         "fine markers": "-vesicle_markers 91 -vesicle_allow_close_markers true"}),
    Map("capsule", r"capsule in shear, $Ca = \nu$ rate $R_0/E_s$, unbounded", "Ca", (1e-5, 1e-4, 1e-3, 0.01, 0.1, 0.4), OVER_RATE,
        powers(0, 1, 2, 3, 4, 6), lambda ca, dt: (capsule(dt, ca),),
        {"no bending": "", "neo-Hookean": "-membrane_law neo_hookean", "ratio 10": f"{DIVIDED} 10",
         "two passing": "-vesicle_count 2 -vesicle_center -2,0.5,2,-0.5 -vesicle_bending 0.01"}),
)
# fmt: on
