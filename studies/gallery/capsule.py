"""Capsules in shear: Taylor's deformation by the capillary number and the law of the membrane."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.curves import smooth_curve
from petves.measures import deformation
from petves.run import Run
from petves.views.figures import new_figure, save_figure
from petves.views.plot import dress
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, plain_ticks, seconds

EXACT = {
    "hooke": {0.0125: 0.24865, 0.025: 0.30907, 0.05: 0.381598, 0.1: 0.465772, 0.2: 0.55612},
    "green": {0.1: 0.435335},
    "neo_hookean": {0.0125: 0.25054, 0.05: 0.38815, 0.2: 0.571},
}
"""Deformation by Ca: explicit boundary integral of tests/support/references.json."""
DRAWN = tuple(("hooke", number) for number in (0.0125, 0.05, 0.2))
NUMBERS = (0.0001, 0.001, 0.0125, 0.025, 0.05, 0.1, 0.2)


def small(number: float) -> float:
    """Return D of the closed form for small Ca: D sqrt((3 D^2/(8 Ca))^2 + 1) = 1/2."""
    q = np.roots([9 / (64 * number**2), 0, 1, -0.25])  # of D^2
    return float(np.sqrt(q[np.abs(q.imag) < 1e-9].real.max()))


def capsule(law: str, number: float) -> Case:
    """Return the deformation at the end of a run, and the outline of those that are drawn."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        markers = Run.read(folder).markers[-1]
        outline = {"outline": markers.round(4).tolist()} if (law, number) in DRAWN else {}
        return {"D": deformation(markers), "angle": series["inclination"][-1] / np.pi} | outline

    modulus = f"-membrane_law {law} -membrane_stretching {1 / number!r}"
    return case(f"{law}_{number:g}", "capsule", f"{modulus} -output_every 24", measure)


def picture(found: dict[tuple[str, float], dict], path: Path) -> None:
    """Draw D against Ca, and outlines."""
    figure, (panel, shapes) = new_figure(10, 4, columns=2)
    line = np.geomspace(NUMBERS[0], NUMBERS[-1], 100)
    panel.loglog(line, [small(x) for x in line], "k:", lw=1, label="closed form, small Ca")
    for law, style in zip(EXACT, ("o", "s", "^")):
        panel.loglog(
            NUMBERS, [found[law, x]["D"] for x in NUMBERS], f"{style}-", ms=5, lw=1, label=law.replace("_", "-")
        )
    panel.loglog(*zip(*EXACT["hooke"].items()), "k+", ms=11, label="boundary integral, hooke")
    dress(panel, grid="both", xlabel=r"$Ca = \nu$ rate $R_0/E_s$", ylabel="deformation $D$")
    plain_ticks(panel, NUMBERS[:3] + NUMBERS[-2:], (0.05, 0.1, 0.2, 0.5))
    panel.legend(frameon=False, fontsize=8)
    for law, number in DRAWN:
        x, y = smooth_curve(np.array(found[law, number]["outline"]), 8).T
        shapes.plot(x, y, lw=1.5, label=f"Ca = {number:g}")
    shapes.set(aspect="equal", xlabel="$x/R_0$", ylabel="$y/R_0$")
    shapes.legend(frameon=False, fontsize=8)
    save_figure(figure, path)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    found = {(law, number): results.get(capsule(law, number)) for law in EXACT for number in NUMBERS}
    picture(found, results.path.parent / "capsule.png")
    rows = []
    for number in NUMBERS:
        cells = []
        for law, exact in EXACT.items():
            own, other = found[law, number]["D"], exact.get(number)
            cells.append(f"{own:.5f}" + (f" ({other:.5f})" if other else ""))
        rows.append([number, *cells, f"{small(number):.5f}", f"{found['hooke', number]['angle']:.5f} pi"])
    header = ["Ca", *(law.replace("_", "-") for law in EXACT), "closed form", "angle"]
    return {"capsules": [header, *rows], "seconds": seconds(*found.values())}


SCENE = Scene("capsule", fill)
