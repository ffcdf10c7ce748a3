"""A run in words and in key numbers."""

from __future__ import annotations

import numpy as np

from petves.run import Run

MANY = 8  # vesicles above which they are told of together
FLOWS = {
    "quiescent": "There is no background flow",
    "shear": "The background is a shear flow of rate {flow_rate}",
    "poiseuille": "The background is a Poiseuille flow of peak velocity {flow_peak_velocity} and half width {flow_half_width}",
    "extension": "The background is an extension of rate {flow_rate}",
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
    cells, walls = o["domain_cells"].replace(",", " x "), _boundaries(o["domain_bc_x"], o["domain_bc_y"])
    fluid = (
        f"A box [{x[0]}, {x[1]}] x [{y[0]}, {y[1]}] of {cells} cells (h = {run.h:g}), {walls}, holds a fluid of "
        f"viscosity {run.nu:g}: {INERTIA.get(inertia, inertia)}. {FLOWS[o['flow_type']].format(**o)}."
    )
    return [fluid, _vesicles(run, o), _method(run, o)]


def _short(value: str) -> str:
    """Return numbers as people write them."""
    try:
        return ",".join(f"{float(item):g}" for item in value.split(","))
    except ValueError:
        return value


def _boundaries(x: str, y: str) -> str:
    names = {"wall": "walls", "periodic": "periodic"}
    return f"{names[x]} in x and y" if x == y else f"{names[x]} in x, {names[y]} in y"


def _vesicles(run: Run, o: dict[str, str]) -> str:
    if not run.vesicles:
        return "There is no vesicle."
    count = "One vesicle" if run.vesicles == 1 else f"{run.vesicles} vesicles"
    if run.vesicles > MANY:
        return f"{count} with an inextensible membrane{_ranges(run)}."
    shapes = []
    for v in range(run.vesicles):
        n, (area, length) = run.start[v + 1] - run.start[v], run.first_measures(v)
        shapes.append(f"area {area:.4g}, length {length:.4g}, reduced area {4*np.pi*area/length**2:.3f}, {n} markers")
    bending = f"bending stiffness {run.c_b:g}" if run.c_b > 0 else "no bending stiffness"
    return f"{count} with an inextensible membrane and {bending}: {'; '.join(shapes)}."


def _ranges(run: Run) -> str:
    """Return the area fraction, sizes and markers of many vesicles."""
    area, length = (run.each(name)[0] for name in ("area", "length"))
    reduced, markers = 4 * np.pi * area / length**2, np.diff(run.start)
    box = (run.box[1] - run.box[0]) * (run.box[3] - run.box[2])
    span = lambda x: f"{x.min():.4g}" if np.ptp(x) < 1e-3 * abs(x.mean()) else f"{x.min():.4g} to {x.max():.4g}"
    return (
        f" and bending stiffness up to {run.c_b:g}: area fraction {area.sum() / box:.3f}, area {span(area)}, reduced area "
        f"{span(reduced)}, {span(markers)} markers each"
    )


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
    """Return names and values, as text, of what people ask of a run first."""
    s, rows = run.series, []
    total = s["energy_kinetic"] + s["energy_bending"]
    rows.append(("time", f"{s['time'][-1]:g}"))
    rows.append(("steps", f"{int(s['step'][-1])}"))
    rows.append(("energy, first and last", f"{total[0]:.4g}, {total[-1]:.4g}"))
    if run.vesicles:
        rows += _vesicle_numbers(run)
    rows.append(("largest |div u| left", f"{s['div_max'].max():.1e}"))
    rows.append(("iterations a step", ", ".join(_iterations(s)) or "none"))
    rows.append(("fast solves a step", f"{s['nsolve'][1:].mean():.0f}" if len(s["nsolve"]) > 1 else "none"))
    rows.append(("seconds in steps", f"{s['wall'].sum():.3g}"))
    if "reynolds" in run.summary:
        rows.append(("Reynolds number", f"{run.summary['reynolds']:.3g}"))
    if run.summary:
        versions = run.summary.get("versions", {})
        rows.append(("ranks", f"{run.summary.get('ranks', '')}"))
        rows.append(("petves", f"{versions.get('petves', '')}, {run.summary.get('git_commit', '')}"))
        rows.append(("PETSc", versions.get("petsc", "")))
    return rows


def _vesicle_numbers(run: Run) -> list[tuple[str, str]]:
    s = run.series
    area, length = run.first_measures(0)
    radius = length / (2 * np.pi)
    rows = [("radius R0 = length/(2 pi)", f"{radius:.4g}")]
    if run.c_b > 0:
        rows.append(("relaxation time nu R0^3/c_b", f"{run.nu * radius**3 / run.c_b:.4g}"))
        if run.options().get("flow_type") in ("shear", "extension"):
            rate = abs(float(run.options()["flow_rate"]))
            rows.append(("chi = rate nu R0^3/c_b", f"{rate * run.nu * radius**3 / run.c_b:.4g}"))
    angle, frequency = s["inclination"][-1], s["frequency"][-1]
    rows.append(("last inclination", f"{angle:.4f} rad = {np.degrees(angle):.2f}°"))
    rows.append(("last tank-treading frequency", f"{frequency:.4g}" if np.isfinite(frequency) else "none"))
    rows.append(("worst area error", f"{np.abs(s['area_error']).max():.1e}"))
    rows.append(("worst length error", f"{np.abs(s['length_error']).max():.1e}"))
    tension = run.tension[-1]
    rows.append(("last tension, least and largest", f"{tension.min():.4g}, {tension.max():.4g}"))
    return rows


def _iterations(series: dict[str, np.ndarray]) -> list[str]:
    """Return mean iterations of the solves that there are."""
    means = {name: series[f"{name}_its"][1:] for name in ("coupled", "tension", "bending")}
    return [f"{name} {values.mean():.1f}" for name, values in means.items() if values.any()]
