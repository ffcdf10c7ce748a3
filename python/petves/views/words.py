"""A run in words and in key numbers."""

import numpy as np

from petves.run import Run, RunFolder, SurfaceRun
from petves.views.curves import columns_of
from petves.views.figures import MANY

SIDES = {"wall": "walls", "periodic": "periodic", "free": "without bounds"}
DRIVE = ("pressure_drop", "flux", "viscosity")  # columns of channels
FLOWS = {
    "quiescent": "There is no background flow",
    "shear": "The background is a shear flow of rate {flow_rate}",
    "poiseuille": "The background is a Poiseuille flow of peak velocity {flow_peak_velocity} and half width {flow_half_width}",
    "tube": "The background is a flow through a tube, of peak velocity {flow_peak_velocity} and radius {flow_half_width}",
    "extension": "The background is an extension of rate {flow_rate}",
    "axial": "The background is an axial extension of rate {flow_rate}",
    "uniform": "The background is a uniform flow of velocity {flow_velocity}",
    "formula": "The background flow is u = {flow_u}, v = {flow_v}",
    "custom": "The background flow is a function of the caller's",
}
INERTIA = {
    "none": "quasi-steady Stokes flow, without inertia",
    "unsteady": "unsteady Stokes flow",
    "convective": "Navier-Stokes flow, with convection",
}


def scene_in_words(run: RunFolder) -> list[str]:
    """Return paragraphs that say what was simulated, and how."""
    o = {name: _short(value) for name, value in run.options().items()}
    inertia = run.summary.get("inertia", o.get("fluid_inertia", "none"))  # what -fluid_inertia auto has chosen
    fluid = f"fluid of viscosity {run.nu:g}: {INERTIA.get(inertia, inertia)}. {FLOWS[o['flow_type']].format(**o)}."
    told = [f"{_place(run, o)} {fluid}", _vesicles(run, o), _solids(run, o), _method(run, o)]
    return [text for text in told if text] + [f"Warning: {text}" for text in run.summary.get("warnings", [])]


def _short(value: str) -> str:
    """Return numbers as people write them."""
    try:
        return ",".join(f"{float(item):g}" for item in value.split(","))
    except ValueError:
        return value


def _place(run: RunFolder, o: dict[str, str]) -> str:
    """Return what is around the fluid, as the begin of a sentence."""
    if isinstance(run, SurfaceRun):
        return "The vesicles are in unbounded"
    x, y = ([f"{c:g}" for c in run.box[k : k + 2]] for k in (0, 2))
    cells, walls = o["domain_cells"].replace(",", " x "), [SIDES[o[f"domain_bc_{c}"]] for c in "xy"]
    box = f"A box [{x[0]}, {x[1]}] x [{y[0]}, {y[1]}] of {cells} cells (h = {run.h:g})"
    return f"{box}, {walls[0]} in x, {walls[1]} in y, holds a"


def _vesicles(run: RunFolder, o: dict[str, str]) -> str:
    """Return what vesicles there are; of several the least and the largest sizes."""
    if not run.vesicles:
        return "There is no vesicle."
    law = o.get("membrane_law", "inextensible")
    kind = "an inextensible" if law == "inextensible" else f"a stretching ({law})"
    count = "One vesicle" if run.vesicles == 1 else f"{run.vesicles} vesicles"
    bending = f"bending stiffness {_span(run.bending)}" if run.bending.any() else "no bending stiffness"
    sizes = [f"{name} {_span(values)}" for name, values in _sizes(run).items()]
    if isinstance(run, SurfaceRun):
        sizes.append(f"spherical harmonics of degree {run.degree}")
    else:
        sizes.append(f"{_span(np.diff(run.start))} markers")
    each = " each" if run.vesicles > 1 else ""
    if run.vesicles > MANY and isinstance(run, Run):
        each += f"; area fraction {run.each('area')[0].sum() / np.prod(run.box[1::2] - run.box[::2]):.3f}"
    return f"{count} with {kind} membrane and {bending}: {', '.join(sizes)}{each}."


def _sizes(run: RunFolder) -> dict[str, np.ndarray]:
    """Return names and values, one a vesicle, of their sizes at the start."""
    area = run.each("area")[0]
    if isinstance(run, SurfaceRun):
        volume = run.each("volume")[0]
        return {"area": area, "volume": volume, "reduced volume": 6 * np.sqrt(np.pi) * volume / area**1.5}
    length = run.each("length")[0]
    return {"area": area, "length": length, "reduced area": 4 * np.pi * area / length**2}


def _span(values: np.ndarray, form: str = ".4g") -> str:
    """Return the least and the largest value, or one where they are the same to a thousandth; "" without values."""
    known = values[np.isfinite(values)]
    if not len(known):
        return ""
    low, high = known.min(), known.max()
    return f"{high:{form}}" if high - low <= 1e-3 * abs(high) else f"{low:{form}} to {high:{form}}"


def _solids(run: RunFolder, o: dict[str, str]) -> str:
    """Return what the obstacles are and what drives the flow past them; "" without obstacles."""
    if isinstance(run, SurfaceRun) or not run.obstacles:
        return ""
    names = {"closed": "closed", "open": "on a wall", "spanning": "across a period"}
    kinds = " or ".join(dict.fromkeys(names[kind] for kind in run.obstacle_kinds))
    moving = " They move and turn as prescribed." if o.get("obstacle_moving") == "true" else ""
    moving = " The fluid carries them." if o.get("obstacle_free") == "all" else moving
    kept = {"flux": " The flux through the box is kept.", "pressure": " The mean pressure gradient is kept."}
    driven = kept[o.get("flow_drive", "pressure")] if run.periods[0] else ""
    return f"Solid bodies: {len(run.obstacles)}, {kinds}.{moving}{driven}"


def _method(run: RunFolder, o: dict[str, str]) -> str:
    """Return how time was stepped, and how the run has ended."""
    kernel = f", kernel {o['delta_type']}" if "delta_type" in o else ""
    adaptive = ", adapted to an error estimate" if o.get("time_adapt") == "error" else ""
    reason = run.summary.get("reason", "")
    ends = {"": "It has not ended yet", "finished": "It ended as asked", "steady": "It ended at the steady state"}
    scheme = f"Scheme {o['scheme_type']} of order {o['scheme_order']}{kernel}, time step {o['time_step']}{adaptive}"
    end = f"at t = {run.series['time'][-1]:g} after {int(run.series['step'][-1])} steps"
    return f"{scheme}. {ends.get(reason, f'It was stopped: {reason}')}, {end}."


def key_numbers(run: RunFolder) -> list[tuple[str, str]]:
    """Return names and values, as text, of what people ask of a run first; what is not known is left out."""
    s, versions = run.series, run.summary.get("versions", {})
    total = sum(run.energies().values())
    rows = [("energy, first and last", f"{total[0]:.4g}, {total[-1]:.4g}")]
    if run.vesicles:
        rows += _scales(run) + _motions(run)
        losses = {name: s[f"{name}_error"] for name in ("area", "length", "volume") if f"{name}_error" in s}
        rows += [(f"worst {name} error", f"{np.abs(values).max():.1e}") for name, values in losses.items()]
        low, high = run.tension_range(-1)
        rows.append(("last tension, least and largest", f"{low:.4g}, {high:.4g}"))
    rows += _forces(run)
    rows.append(("largest |div u| left", f"{s['div_max'].max():.1e}" if "div_max" in s else ""))
    means = {name: s.get(f"{name}_its", np.zeros(0))[1:] for name in ("coupled", "tension", "bending")}
    rows.append(("iterations a step", ", ".join(f"{name} {x.mean():.1f}" for name, x in means.items() if x.any())))
    solves = s.get("nsolve", np.zeros(0))[1:]
    rows.append(("fast solves a step", f"{solves.mean():.0f}" if len(solves) else ""))
    rows.append(("seconds in steps", f"{s['wall'].sum():.3g}"))
    rows.append(("Reynolds number", "" if (Re := run.summary.get("reynolds")) is None else f"{Re:.3g}"))
    rows.append(("ranks", str(run.summary.get("ranks", ""))))
    rows.append(("petves", ", ".join(filter(None, (versions.get("petves"), run.summary.get("git_commit"))))))
    rows.append(("PETSc", versions.get("petsc", "")))
    return [(name, value) for name, value in rows if value]


def _scales(run: RunFolder) -> list[tuple[str, str]]:
    """Return what scales the vesicles: of several, the least and the largest; times and chi of the largest."""
    if isinstance(run, SurfaceRun):
        name, radius = "(3 volume/(4 pi))^(1/3)", np.cbrt(3 * run.each("volume")[0] / (4 * np.pi))
    else:
        name, radius = "length/(2 pi)", run.each("length")[0] / (2 * np.pi)
    rows = [(f"radius R0 = {name}", _span(radius))]
    if run.vesicles > 1:
        sums = {"area": "area of all vesicles", "length": "length of all membranes", "volume": "volume of all vesicles"}
        rows += [(told, f"{run.each(name)[-1].sum():.5g}") for name, told in sums.items() if name in run.series]
    if not run.bending.any():
        return rows
    relaxation = run.nu * radius.max() ** 3 / run.bending.max()
    rows.append(("relaxation time nu R0^3/c_b", f"{relaxation:.4g}"))
    if run.options().get("flow_type") in ("shear", "extension"):
        rows.append(("chi = rate nu R0^3/c_b", f"{abs(float(run.options()['flow_rate'])) * relaxation:.4g}"))
    return rows


def _motions(run: RunFolder) -> list[tuple[str, str]]:
    """Return how vesicles lie at the end: of several the mean axis and how well they agree with it; and how they turn."""
    turned = np.mean(np.exp(2j * run.each("inclination")[-1]))
    angle, one = np.angle(turned) / 2, run.vesicles == 1
    rows = [(f"last {'inclination' if one else 'mean axis'}", f"{angle:.4f} rad = {np.degrees(angle):.2f}°")]
    rows.append(("last order |<exp(2 i inclination)>|", "" if one else f"{abs(turned):.3f}"))
    turns = (
        {"rotation_z": "rotation about z"} if isinstance(run, SurfaceRun) else {"frequency": "tank-treading frequency"}
    )
    return rows + [(f"last {told}", _span(run.each(name)[-1])) for name, told in turns.items()]


def _forces(run: RunFolder) -> list[tuple[str, str]]:
    """Return the least gap and what obstacles and walls feel at the end."""
    last = {name: np.array([values[-1] for _, values in columns_of(run, name)]) for name in ("obstacle_torque", *DRIVE)}
    gap = run.series.get("gap", np.zeros(0))
    rows = [("least gap", _span(np.array([np.nanmin(gap)]), ".3g") if np.isfinite(gap).any() else "")]
    return rows + [(f"last {name.replace('_', ' ')}", _span(values)) for name, values in last.items()]
