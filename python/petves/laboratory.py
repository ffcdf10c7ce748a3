"""From the laboratory's numbers to the program's options."""

import math

from petves.errors import Error


def numbers(
    radius: float,
    bending: float,
    viscosity: float,
    rate: float = 0.0,
    flow: str = "shear",
    reduced_area: float = 0.7,
    inside: float | None = None,
    density: float = 1000.0,
) -> tuple[dict[str, str], dict[str, float]]:
    """Return the options of a scene in unbounded fluid, its dimensionless numbers and its time scale, from numbers in SI units.

    Parameters
    ----------
    radius : float
        R0 = perimeter/(2 pi) (m).
    bending : float
        Bending modulus (J); c_b is the modulus over the density.
    viscosity, inside : float
        Dynamic viscosity outside and inside (Pa s); one fluid when `inside` is left out.
    rate : float
        Rate of shear or extension (1/s); 0: fluid at rest.
    flow : str
        "shear" or "extension".
    reduced_area : float
        V = area/(pi R0^2); of a red cell's outline about 0.6 to 0.7.
    density : float
        Of both fluids (kg/m^3).

    Returns
    -------
    options : dict of str to str
        Options without the dash, in metres and seconds, for `petves.Simulation` or a file.
    numbers : dict of str to float
        V, lambda_t = nu R0^3/c_b (s), chi = rate lambda_t, Re = rate R0^2/nu, and the viscosity ratio.

    Raises
    ------
    Error
        When a number is out of range.
    """
    given = dict(radius=radius, bending=bending, viscosity=viscosity, density=density, inside=inside or viscosity)
    for name, value in given.items():
        if not 0 < value < math.inf:
            raise Error(f"{name} {value:g}: out of range; allowed: >0, in SI units")
    if not 0 < reduced_area < 1:
        raise Error(f"reduced_area {reduced_area:g}: out of range; allowed: >0 and <1")
    if flow not in ("shear", "extension"):
        raise Error(f"flow {flow}: unknown; allowed: shear, extension")
    nu, c_b, area = viscosity / density, bending / density, reduced_area * math.pi * radius**2
    relaxation, ratio = viscosity * radius**3 / bending, given["inside"] / viscosity
    chi, reynolds = abs(rate) * relaxation, abs(rate) * radius**2 / nu
    found = {"V": reduced_area, "lambda_t": relaxation, "chi": chi, "Re": reynolds, "viscosity_ratio": ratio}
    turn = 1 / abs(rate) if rate else relaxation
    values = {
        "domain_box": ",".join(f"{side * 4 * radius:.9g}" for side in (-1, 1, -1, 1)),
        "domain_cells": "40,40",
        "domain_bc_x": "free",
        "domain_bc_y": "free",
        **({"flow_type": flow, "flow_rate": rate} if rate else {}),
        "fluid_viscosity": nu,
        "fluid_inertia": "none",
        "vesicle_area": area,
        "vesicle_reduced_area": reduced_area,
        "vesicle_bending": c_b,
        **({"vesicle_viscosity_ratio": ratio} if inside else {}),
        "time_step": 0.05 * turn,
        "time_end": 10 * turn,
        "output_every": 0.25 * turn,
    }
    options = {name: value if isinstance(value, str) else f"{value:.9g}" for name, value in values.items()}
    return options, found


def lines(**given: object) -> list[str]:
    """Return what `numbers` finds as a file of options, the numbers in comments; parameters are those of `numbers`."""
    options, found = numbers(**given)
    words = [f"{name} = {value:.4g}" + " s" * (name == "lambda_t") for name, value in found.items()]
    late = "# Re is not small: -fluid_inertia, in a box with walls or periods, has inertia"
    return [
        f"# {', '.join(words)}; metres and seconds, density 1",
        *[late] * (found["Re"] > 0.1),
        *(f"-{name} {value}" for name, value in options.items()),
        "-output_dir out/numbers",
    ]
