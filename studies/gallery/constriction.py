"""A vesicle through a throat: transit, film, pressure drop."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.views.figures import new_figure, save_figure
from petves.views.plot import dress
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, least, moments, plain_ticks, seconds, with_pictures

EMPTY, EXACT = 0.48, 79.69
"""A throat without a vesicle and its pressure drop: least squares over Stokes' equations, .01."""
THROATS = (0.6, 0.48, 0.36, 0.3)
AROUND = (1.0, 2.0)
"""The bumps: transit is the centre's time between their ends."""


def empty(throat: float, cells: int = 32) -> Case:
    """Return the flow without a vesicle: its pressure drop."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        return {"drop": series["pressure_drop"][-1]}

    changes = f"-vesicle_shape none -allow_unused_options true -obstacle_throat {throat} -time_end 0.01"
    return case(f"empty_{throat}_{cells}", "constriction", f"{changes} -domain_cells {3 * cells},{cells}", measure)


def through(throat: float, cells: int = 32, pictures: Path | None = None) -> Case:
    """Return a vesicle: transit, largest drop, least gap in the throat and where, the drop against its place."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "constriction.png", (0, 0.2, 0.3, 0.4, 0.5, 0.6), rows=3)
        x = series["center_x"]
        inside = (x > AROUND[0]) & (x < AROUND[1])
        gap, time = least({name: series[name][inside] for name in ("time", "gap")})
        drop, _ = least({"time": series["time"], "gap": -series["pressure_drop"]})
        enter, leave = np.interp(AROUND, x, series["time"])
        place = np.linspace(0.7, 2.2, 61)
        return {
            "transit": leave - enter,
            "drop": -drop,
            "gap": gap,
            "at": float(np.interp(time, series["time"], x)),
            "curve": np.round(np.interp(place, x, series["pressure_drop"]), 2).tolist(),
        }

    changes = f"-obstacle_throat {throat} -domain_cells {3 * cells},{cells}"
    if cells > 32:
        changes += " -vesicle_markers 121 -time_step 0.0025"
    return case(f"{throat}_{cells}", "constriction", changes, measure)


def lubrication(throat: float) -> float:
    """Return the pressure drop of the channel without a vesicle, flux 1, by 12 nu INT dx/height^3."""
    x = (np.arange(4096) + 0.5) / 4096
    height = throat + (1 - throat) * (1 + np.cos(2 * np.pi * x)) / 2
    return float(12 * np.mean(height**-3) + 24)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    home = results.path.parent
    free = {throat: results.get(empty(throat)) for throat in THROATS}
    runs = {(throat, 32): results.get(through(throat)) for throat in THROATS if throat != 0.36}
    runs[0.36, 32] = with_pictures(results, through(0.36, pictures=home), "constriction.png")
    runs[0.36, 64] = results.get(through(0.36, 64))
    figure, (panel,) = new_figure(8, 5)
    for throat in THROATS:
        panel.semilogy(np.linspace(0.7, 2.2, 61), runs[throat, 32]["curve"], lw=1.2, label=f"throat {throat:g}")
    plain_ticks(panel, y=(50, 100, 200, 400))
    dress(panel, grid="both", xlabel="place of the centre", ylabel="pressure drop")
    panel.legend(frameon=False, fontsize=8)
    save_figure(figure, home / "constriction_drop.png")
    rows = [
        [throat, cells, f"{free[throat]['drop']:.2f}", f"{lubrication(throat):.1f}", f"{one['drop']:.1f}"]
        + [f"{one['transit']:.4f}", f"{one['gap']:.4f}"]
        for (throat, cells), one in sorted(runs.items(), key=lambda item: (-item[0][0], item[0][1]))
    ]
    header = [
        "throat",
        "cells across",
        "drop without",
        "by lubrication theory",
        "largest drop with",
        "transit",
        "least gap",
    ]
    return {
        "throats": [header, *rows],
        "throat_off": f"{abs(100 * (free[EMPTY]['drop'] / EXACT - 1)):.2f}",
        "seconds": seconds(*free.values(), *runs.values()),
    }


SCENE = Scene("constriction", fill, long=True)
