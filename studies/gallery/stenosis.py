"""Twenty vesicles through a stenosis: pressure drop, who is past it, gaps."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, film, least, moments, seconds, with_pictures

COUNT, PAST = 20, 2.5
"""Vesicles; where the stenosis ends."""
GRIDS = {"": "128 x 32, 31, 0.01", "long": "128 x 32, 31, 0.02", "fine": "256 x 64, 51, 0.01"}
CHANGES = {"": "", "long": "-time_step 0.02", "fine": "-domain_cells 256,64 -vesicle_markers 51"}


def asymmetry(x: np.ndarray) -> float:
    """Return how far columns of five, shape (20,) of places along the channel, are from their mirror image."""
    return float(np.abs(x.reshape(-1, 5) - x.reshape(-1, 5)[:, ::-1]).max())


def through(name: str, pictures: Path | None = None) -> Case:
    """Return a run: largest and mean drop, how many are past at the end, least gap, places at the end."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "stenosis.png", (0, 0.5, 1, 2), rows=2)
            film(folder, pictures / "stenosis.gif", rate=8, width=640)
        drop, at = least({"time": series["time"], "gap": -series["pressure_drop"]})
        x = np.array([series[f"center_x_{k + 1}"][-1] for k in range(COUNT)])
        return {
            "drop": -drop,
            "at": at,
            "mean": np.mean(series["pressure_drop"]),
            "gap": np.nanmin(series["gap"]),
            "x": x.tolist(),
        }

    return case(name, "stenosis", CHANGES[name], measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    runs = {name: results.get(through(name)) for name in CHANGES if name}
    runs[""] = with_pictures(results, through("", results.path.parent), "stenosis.png", "stenosis.gif")
    fine = np.array(runs["fine"]["x"])
    rows = []
    for name, words in GRIDS.items():
        one, x = runs[name], np.array(runs[name]["x"])
        off = "" if name == "fine" else f"{np.abs(x - fine).max():.3f}"
        rows.append(
            f"| {' | '.join(words.split(', '))} | {one['drop']:.1f} | {one['mean']:.1f} | {one['gap']:.4f} | {int((x > PAST).sum())} | {off} |"
        )
    return {
        "stenosis_rows": "\n".join(rows),
        "stenosis_asymmetry": f"{asymmetry(fine):.0e}",
        "stenosis_seconds": seconds(*runs.values()),
    }


SCENE = Scene("stenosis", fill, long=True)
