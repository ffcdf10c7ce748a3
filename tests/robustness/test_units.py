"""One scene of each kind in other units of length and time, powers of two from 2^-40 to 2^40: the same rows and iterations.
The units of options are those that -help says."""

import numpy as np
import pytest
from harness import run_scenes
from unit_powers import option_powers, powers

from petves.dataset import unit

VESICLE = "-vesicle_semi_axes 0.5,0.9 -vesicle_bending 0.1"
BOX = f"-domain_box -2,2,-2,2 -domain_cells 32,32 -fluid_viscosity 1 {VESICLE} -time_step 0.02 -time_end 0.06"
STOKES = f"{BOX} -fluid_inertia none"
SHEAR = "-flow_type shear -flow_rate 1 -domain_bc_x periodic"
STREAM = "-flow_type poiseuille -flow_peak_velocity 1 -flow_half_width 2 -domain_bc_x periodic"
POST = "-obstacle_shape posts -obstacle_radius 0.4 -obstacle_center 1.2,1.2 -vesicle_center -0.5,-0.3"
KINDS = {
    "walls": STOKES,
    "channel": f"{STOKES} {STREAM}",
    "flux": f"{STOKES} {STREAM} -flow_drive flux",
    "total": f"{BOX} {SHEAR} -flow_form total -scheme_type split",
    "periodic": f"{STOKES} -domain_bc_x periodic -domain_bc_y periodic",
    "free": f"{STOKES} {SHEAR} -domain_bc_x free -domain_bc_y free",
    "contrast": f"{BOX} {SHEAR} -vesicle_viscosity_ratio 5",
    "free contrast": f"{BOX} {SHEAR} -domain_bc_x free -domain_bc_y free -vesicle_viscosity_ratio 5",
    "obstacles": f"{BOX} {SHEAR} {POST}",
    "moving": f"{BOX} {POST} -obstacle_moving -obstacle_velocity 0.3,0.1 -obstacle_rotation 1 -obstacle_frequency 5",
    "gravity": f"{STOKES} -fluid_gravity 0,-1 -vesicle_density_difference 1",
    "gravity in a channel": f"{STOKES} -domain_bc_x periodic -fluid_gravity 0.5,-1 -vesicle_density_difference 1",
    "gravity, periodic": f"{STOKES} -domain_bc_x periodic -domain_bc_y periodic -fluid_gravity 0.5,-1 "
    "-vesicle_density_difference 1",
    "repulsion": f"{STOKES} -vesicle_semi_axes 0.4,0.6 -vesicle_count 2 -vesicle_center -0.45,0,0.45,0 "
    "-contact_repulsion 1 -contact_repulsion_range 0.25 -contact_adhesion 0.1 -contact_adhesion_range 0.3",
    "suspension": f"{STOKES} -domain_bc_x periodic -domain_bc_y periodic -vesicle_packing 0.3 -vesicle_semi_axes 0.25,0.4",
    "unsteady": f"{BOX} {SHEAR} -fluid_inertia unsteady",
    "convective": f"{BOX} {SHEAR} -fluid_inertia convective",
    "split": f"{BOX} -scheme_type split",
    "penalty": f"{BOX} -scheme_type penalty -time_step 0.001 -time_end 0.003",
    "hypre": f"{BOX} -scheme_type split -helmholtz_type hypre -poisson_type hypre",
    "adaptive": f"{STOKES} -time_adapt error -time_adapt_max_step 0.1 -output_every 0.05",
    "steady": f"{STOKES} -time_end 0.3 -time_step 0.05 -time_steady_tol 0.01",
    "auto": f"-fluid_viscosity 1 {VESICLE} -time_step 0.02 -time_end 0.1 -scheme_auto 0.01 -output_every 0.05",
}
COUNTS = ("step", "tension_its", "bending_its", "coupled_its", "nsolve")


def scaled(options: str, length: float, time: float) -> str:
    words, units = options.split(), option_powers()
    for k, word in enumerate(words):
        if word in units:
            factor = length ** units[word][0] * time ** units[word][1]
            words[k + 1] = ",".join(repr(float(x) * factor) for x in words[k + 1].split(","))
    tight = [] if "split" in options or "penalty" in options else ["-coupled_ksp_rtol", "1e-10"]
    return " ".join([*words, *tight])


def scaled_back(series: dict, length: float, time: float) -> dict:
    scale = {name: length ** powers(unit(name))[0] * time ** powers(unit(name))[1] for name in series}
    return {name: column / scale[name] for name, column in series.items() if name != "wall"}


@pytest.mark.parametrize("kind", KINDS)
def test_units_change_nothing(kind, tmp_path):
    """Differences are over the largest number of any column of the same unit; of rates over 1/time as well."""
    units = [(2.0**k, 2.0**m) for k, m in ((0, 0), (-40, 40), (40, -40), (-20, 0))]
    runs = run_scenes(tmp_path, {n: scaled(KINDS[kind], *scales) for n, scales in enumerate(units)})
    base, *others = (scaled_back(runs[n].series, *scales) for n, scales in enumerate(units))
    largest = {unit(name): 1.0 for name in base if powers(unit(name)) == (0, 0)}
    largest |= {unit(name): 1 / base["time"][-1] for name in base if powers(unit(name)) == (0, -1)}
    for name, column in base.items():
        largest[unit(name)] = max(largest.get(unit(name), 0), np.nanmax(np.abs(column), initial=0))
    for other, scales in zip(others, units[1:]):
        for name, column in base.items():
            apart = np.nan_to_num(np.abs(other[name] - column))
            assert apart.shape == column.shape
            within = 0 if name in COUNTS else 1e-10 * largest[unit(name)]
            assert apart.max() <= within, (name, scales, column, other[name])
