"""Tumbling in shear: half periods against the ratio of viscosities, and where tank-treading ends."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from petves.measures import half_periods
from petves.theory import ellipse_axes
from petves.views.plot import dress, new_figure, save_figure
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Table, Values, case, moments, plain_ticks, seconds, with_pictures

RATIOS = (4.2, 5, 7, 10, 20, 50)
BOX = "-domain_bc_x wall -domain_bc_y wall -domain_box -5.931765,5.931765,-5.931765,5.931765 -domain_cells 32,32"
EXACT = {("free", 10): (12.190, 12.118), ("box", 10): (14.558, 14.546), ("box", 50): (11.1122, 10.8988)}
"""Half periods of a boundary integral, 1e-4 of them."""
CRITICAL = {0.7: 3.946, 0.8: 4.44}
"""Ratio at which tank-treading ends, chi = 10, unbounded: boundary integral, 1e-3."""
ABOVE = {
    0.5: (3.0, 3.1, 3.2, 3.3),
    0.6: (3.55, 3.65, 3.75, 3.85),
    0.7: (4.05, 4.1, 4.15, 4.2),
    0.8: (4.6, 4.7, 4.8, 4.9),
    0.9: (5.45, 5.55, 5.65, 5.75),
}
"""Ratios not far above it, by reduced area."""


def shape(reduced_area: float, chi: float) -> str:
    """Return the options of a vesicle with R0 = 1."""
    area = np.pi * reduced_area
    return f"-vesicle_reduced_area {reduced_area} -vesicle_area {area!r} -vesicle_bending {1 / chi!r}"


def periods(place: str, ratio: float, pictures: Path | None = None) -> Case:
    """Return a tumbling vesicle, V = 0.7, chi = 10, from an ellipse along the flow: its half periods."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "tumbling.png", (12, 16, 18, 19, 20, 22, 24), (-1.6, 1.6, -1.6, 1.6))
        return {"half": half_periods(series["time"], series["inclination"]).tolist()}

    changes = f"{BOX} -time_end 48" if place == "box" else "-time_end 75" if ratio < 5 else ""
    return case(f"{place}_{ratio:g}", "tumbling", f"-vesicle_viscosity_ratio {ratio:g} {changes}", measure)


def long_period(reduced_area: float, ratio: float) -> Case:
    """Return a slowly tumbling vesicle: its last half period."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        return {"half": half_periods(series["time"], series["inclination"])[-1]}

    changes = (
        f"{shape(reduced_area, 10)} -vesicle_viscosity_ratio {ratio} -time_step 0.1 -time_end 200 -output_every 100"
    )
    return case(f"critical_{reduced_area}_{ratio}", "tumbling", changes, measure)


def critical_ratio(half: dict[float, float]) -> float:
    """Return where 1/period^2 goes to zero, by a quadratic through the ratios: a saddle-node bifurcation."""
    return float(np.polyfit([1 / period**2 for period in half.values()], list(half), 2)[-1])


def keller_skalak(reduced_area: float, ratio: float) -> float:
    """Return B of d theta/dt = -(rate/2)(1 - B cos 2 theta) for an ellipse, Keller and Skalak in two dimensions.

    The field inside is linear, and outside the ellipse feels the traction of a linear field, so that with k = 2 a b/(a^2 + b^2) the
    strain of the membrane along the axes is (1 + k)/(ratio + k) that of the flow: the balance of work and dissipation.
    """
    a, b = ellipse_axes(reduced_area)
    squares, difference = a * a + b * b, a * a - b * b
    k = 2 * a * b / squares
    return difference / squares + 4 * (a * b) ** 2 / (squares * difference) * (1 + k) / (ratio + k)


def keller_skalak_critical(reduced_area: float) -> float:
    """Return the ratio at which B is 1: above it the ellipse tumbles."""
    a, b = ellipse_axes(reduced_area)
    k = 2 * a * b / (a * a + b * b)
    return 2 * a * a * (1 + k) / (a * a - b * b) - k


def keller_skalak_half(reduced_area: float, ratio: float) -> float:
    """Return rate times the half period of Keller and Skalak's ellipse."""
    return 2 * np.pi / np.sqrt(1 - keller_skalak(reduced_area, ratio) ** 2)


def _periods(runs: dict[tuple[str, float], dict]) -> Table:
    lines = [["fluid", "ratio", "petves", "boundary integral", "Keller, Skalak"]]
    for (place, ratio), one in runs.items():
        known = EXACT.get((place, ratio), ())
        theirs = ", ".join(f"{value:g}" for value in known)
        theory = f"{keller_skalak_half(0.7, ratio):.2f}" if place == "free" else ""
        ours = ", ".join(f"{value:.4g}" if not known else f"{value:.4f}" for value in one["half"][: len(known) or 1])
        lines.append([place, ratio, ours, theirs, theory])
    return lines


def _picture(path: Path, runs: dict[tuple[str, float], dict], found: dict[float, float]) -> None:
    """Half periods and critical ratios, with Keller and Skalak's curves."""
    figure, (left, right) = new_figure(12, 4.8, columns=2)
    free = {ratio: one["half"][-1] for (place, ratio), one in runs.items() if place == "free"}
    left.loglog(list(free), list(free.values()), "o", ms=4, label="petves")
    left.plot(10, 12.118, "kx", ms=8, label="boundary integral")
    ratios = np.geomspace(3.3, 50, 100)
    left.plot(ratios, [keller_skalak_half(0.7, ratio) for ratio in ratios], "--", lw=1, label="Keller, Skalak")
    dress(left, grid="both", xlabel="viscosity inside over outside", ylabel="rate times half period")
    plain_ticks(left, (3, 5, 10, 20, 50), (10, 15, 20, 30, 40))
    right.plot(list(found), list(found.values()), "o-", ms=4, lw=1, label="petves, chi = 10")
    right.plot(list(CRITICAL), list(CRITICAL.values()), "kx", ms=8, label="boundary integral")
    areas = np.linspace(0.5, 0.92, 40)
    right.plot(areas, [keller_skalak_critical(v) for v in areas], "--", lw=1, label="Keller, Skalak")
    right.text(0.55, 4.6, "tumbling")
    right.text(0.75, 2.7, "tank-treading")
    dress(right, grid="both", xlabel="reduced area V", ylabel="viscosity inside over outside")
    for panel in (left, right):
        panel.legend(frameon=False, fontsize=8)
    save_figure(figure, path)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    folder = results.path.parent
    runs = {("free", ratio): partial(periods, "free", ratio) for ratio in RATIOS}
    runs |= {("box", ratio): partial(periods, "box", ratio) for ratio in (10, 50)}
    made = {key: results.get(make()) for key, make in runs.items() if key != ("free", 10)}
    made["free", 10] = with_pictures(results, periods("free", 10, folder), "tumbling.png")
    made = {key: made[key] for key in runs}
    slow = {v: {ratio: results.get(long_period(v, ratio)) for ratio in ratios} for v, ratios in ABOVE.items()}
    found = {v: critical_ratio({ratio: one["half"] for ratio, one in ones.items()}) for v, ones in slow.items()}
    _picture(folder / "tumbling_ratio.png", made, found)
    rows = [[v, f"{found[v]:.3f}", CRITICAL.get(v, ""), f"{keller_skalak_critical(v):.3f}"] for v in found]
    off = [abs(ours / theirs - 1) for key, known in EXACT.items() for ours, theirs in zip(made[key]["half"], known)]
    return {
        "tumbling_periods": _periods(made),
        "tumbling_critical": [["V", "petves", "boundary integral", "Keller, Skalak"], *rows],
        "period_off": f"{100 * max(off):.2f}",
        "seconds": seconds(*made.values(), *(one for ones in slow.values() for one in ones.values())),
    }


SCENE = Scene("tumbling", fill)
