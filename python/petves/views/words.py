"""A run in words and in key numbers."""

from __future__ import annotations

import numpy as np

from petves.run import Run
from petves.views.curves import columns_of
from petves.views.figures import MANY

SIDES = {"wall": "walls", "periodic": "periodic", "free": "without bounds"}
DRIVE = ("pressure_drop", "flux", "viscosity")  # columns of channels
FLOWS = {
    "quiescent": "There is no background flow",
    "shear": "The background is a shear flow of rate {flow_rate}",
    "poiseuille": "The background is a Poiseuille flow of peak velocity {flow_peak_velocity} and half width {flow_half_width}",
    "extension": "The background is an extension of rate {flow_rate}",
    "uniform": "The background is a uniform flow of velocity {flow_velocity}",
    "formula": "The background flow is u = {flow_u}, v = {flow_v}",
    "custom": "The background flow is a function of the caller's",
}
INERTIA = {
    "none": "quasi-steady Stokes flow, without inertia",
    "unsteady": "unsteady Stokes flow",
    "convective": "Navier-Stokes flow, with convection",
}


def scene_in_words(run: Run) -> list[str]:
    """Return paragraphs that say what was simulated, and how."""
    o = {name: _short(value) for name, value in run.options().items()}
    x, y = ([f"{c:g}" for c in run.box[k : k + 2]] for k in (0, 2))
    inertia = run.summary.get("inertia", o["fluid_inertia"])  # the model that -fluid_inertia auto has chosen
    cells, walls = o["domain_cells"].replace(",", " x "), [SIDES[o[f"domain_bc_{c}"]] for c in "xy"]
    fluid = (
        f"A box [{x[0]}, {x[1]}] x [{y[0]}, {y[1]}] of {cells} cells (h = {run.h:g}), {walls[0]} in x, {walls[1]} in y, holds a fluid of "
        f"viscosity {run.nu:g}: {INERTIA.get(inertia, inertia)}. {FLOWS[o['flow_type']].format(**o)}."
    )
    told = [fluid, _vesicles(run, o), _solids(run, o), _method(run, o)]
    return [text for text in told if text] + [f"Warning: {text}" for text in run.summary.get("warnings", [])]


def _solids(run: Run, o: dict[str, str]) -> str:
    """Return what the obstacles are and what drives the flow past them; "" without obstacles."""
    if not run.obstacles:
        return ""
    names = {"closed": "closed", "open": "on a wall", "spanning": "across a period"}
    kinds = " or ".join(dict.fromkeys(names[kind] for kind in run.obstacle_kinds))
    moving = " They move and turn as prescribed." if o.get("obstacle_moving") == "true" else ""
    moving = " The fluid carries them." if o.get("obstacle_free") == "all" else moving
    kept = {"flux": " The flux through the box is kept.", "pressure": " The mean pressure gradient is kept."}
    driven = kept[o.get("flow_drive", "pressure")] if run.periods[0] else ""
    return f"Solid bodies: {len(run.obstacles)}, {kinds}.{moving}{driven}"


def _short(value: str) -> str:
    """Return numbers as people write them."""
    try:
        return ",".join(f"{float(item):g}" for item in value.split(","))
    except ValueError:
        return value


def _vesicles(run: Run, o: dict[str, str]) -> str:
    if not run.vesicles:
        return "There is no vesicle."
    law = o.get("membrane_law", "inextensible")
    kind = "an inextensible" if law == "inextensible" else f"a stretching ({law})"
    count = "One vesicle" if run.vesicles == 1 else f"{run.vesicles} vesicles"
    if run.vesicles > MANY:
        area, length = (run.each(name)[0] for name in ("area", "length"))
        share = area.sum() / ((run.box[1] - run.box[0]) * (run.box[3] - run.box[2]))
        sizes = f"area {_span(area)}, reduced area {_span(4 * np.pi * area / length**2)}, {_span(np.diff(run.start))}"
        bending = f"and bending stiffness up to {run.c_b:g}"
        return f"{count} with {kind} membrane {bending}: area fraction {share:.3f}, {sizes} markers each."
    shapes = []
    for area, length, n in zip(run.each("area")[0], run.each("length")[0], np.diff(run.start)):
        shapes.append(f"area {area:.4g}, length {length:.4g}, reduced area {4*np.pi*area/length**2:.3f}, {n} markers")
    bending = f"bending stiffness {run.c_b:g}" if run.c_b > 0 else "no bending stiffness"
    return f"{count} with {kind} membrane and {bending}: {'; '.join(shapes)}."


def _method(run: Run, o: dict[str, str]) -> str:
    last = run.series["time"][-1]
    adaptive = ", adapted to an error estimate" if o.get("time_adapt") == "error" else ""
    reason = run.summary.get("reason", "")
    ends = {"": "It has not ended yet", "finished": "It ended as asked", "steady": "It ended at the steady state"}
    return (
        f"Scheme {o['scheme_type']} of order {o['scheme_order']}, kernel {o['delta_type']}, time step "
        f"{o['time_step']}{adaptive}. {ends.get(reason, f'It was stopped: {reason}')}, at t = {last:g} after "
        f"{int(run.series['step'][-1])} steps."
    )


def key_numbers(run: Run) -> list[tuple[str, str]]:
    """Return names and values, as text, of what people ask of a run first; what is not known is left out."""
    s, rows = run.series, []
    total = sum(run.energies().values())
    rows.append(("energy, first and last", f"{total[0]:.4g}, {total[-1]:.4g}"))
    if run.vesicles:
        rows += _sizes(run) + _motions(run)
        losses = {name: f"{np.abs(s[f'{name}_error']).max():.1e}" for name in ("area", "length")}
        rows += [(f"worst {name} error", value) for name, value in losses.items()]
        low, high = run.tension_range(-1)
        rows.append(("last tension, least and largest", f"{low:.4g}, {high:.4g}"))
    rows += _forces(run)
    rows.append(("largest |div u| left", f"{s['div_max'].max():.1e}"))
    means = {name: s[f"{name}_its"][1:] for name in ("coupled", "tension", "bending")}
    rows.append(("iterations a step", ", ".join(f"{name} {x.mean():.1f}" for name, x in means.items() if x.any())))
    rows.append(("fast solves a step", f"{s['nsolve'][1:].mean():.0f}" if len(s["nsolve"]) > 1 else ""))
    rows.append(("seconds in steps", f"{s['wall'].sum():.3g}"))
    rows.append(("Reynolds number", "" if (Re := run.summary.get("reynolds")) is None else f"{Re:.3g}"))
    versions = run.summary.get("versions", {})
    rows.append(("ranks", str(run.summary.get("ranks", ""))))
    rows.append(("petves", ", ".join(filter(None, (versions.get("petves"), run.summary.get("git_commit"))))))
    rows.append(("PETSc", versions.get("petsc", "")))
    return [(name, value) for name, value in rows if value]


def _span(values: np.ndarray, form: str = ".4g") -> str:
    """Return the least and the largest value, or one where they are the same to a thousandth; "" without values."""
    known = values[np.isfinite(values)]
    if not len(known):
        return ""
    low, high = known.min(), known.max()
    return f"{high:{form}}" if high - low <= 1e-3 * abs(high) else f"{low:{form}} to {high:{form}}"


def _sizes(run: Run) -> list[tuple[str, str]]:
    """Return what scales the vesicles: of several, the least and the largest; times and chi of the largest."""
    area, length = (run.each(name) for name in ("area", "length"))
    radius = length[0] / (2 * np.pi)
    rows = [("radius R0 = length/(2 pi)", _span(radius))]
    if run.vesicles > 1:
        rows.append(("area of all vesicles", f"{area[-1].sum():.5g}"))
        rows.append(("length of all membranes", f"{length[-1].sum():.5g}"))
    if run.c_b <= 0:
        return rows
    relaxation = run.nu * radius.max() ** 3 / run.c_b
    rows.append(("relaxation time nu R0^3/c_b", f"{relaxation:.4g}"))
    if run.options().get("flow_type") in ("shear", "extension"):
        rows.append(("chi = rate nu R0^3/c_b", f"{abs(float(run.options()['flow_rate'])) * relaxation:.4g}"))
    return rows


def _motions(run: Run) -> list[tuple[str, str]]:
    """Return how vesicles lie at the end: of several the mean axis and how well they agree with it; and frequencies."""
    turned = np.mean(np.exp(2j * run.each("inclination")[-1]))
    angle, one = np.angle(turned) / 2, run.vesicles == 1
    return [
        (f"last {'inclination' if one else 'mean axis'}", f"{angle:.4f} rad = {np.degrees(angle):.2f}°"),
        ("last order |<exp(2 i inclination)>|", "" if one else f"{abs(turned):.3f}"),
        ("last tank-treading frequency", _span(run.each("frequency")[-1])),
    ]


def _forces(run: Run) -> list[tuple[str, str]]:
    """Return the least gap and what obstacles and walls feel at the end."""
    last = {name: np.array([values[-1] for _, values in columns_of(run, name)]) for name in ("obstacle_torque", *DRIVE)}
    gap = run.series.get("gap", np.zeros(0))
    rows = [("least gap", _span(np.array([np.nanmin(gap)]), ".3g") if np.isfinite(gap).any() else "")]
    return rows + [(f"last {name.replace('_', ' ')}", _span(values)) for name, values in last.items()]
