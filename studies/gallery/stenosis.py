"""Twenty vesicles through a stenosis: pressure drop, who is past it, gaps."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, film, least, moments, seconds, with_pictures

COUNT = 20
CHANGES = {"": "", "fine": "-domain_cells 256,64 -vesicle_markers 51"}


def asymmetry(x: np.ndarray) -> float:
    """Return how far columns of five, shape (20,) of places along the channel, are from their mirror image."""
    return float(np.abs(x.reshape(-1, 5) - x.reshape(-1, 5)[:, ::-1]).max())


def through(name: str, pictures: Path | None = None) -> Case:
    """Return a run: largest drop, least gap, places at the end."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "stenosis.png", (0, 0.5, 1, 2), rows=2)
            film(folder, pictures / "stenosis.gif", rate=8, width=640)
        drop, _ = least({"time": series["time"], "gap": -series["pressure_drop"]})
        x = np.array([series[f"center_x_{k + 1}"][-1] for k in range(COUNT)])
        return {"drop": -drop, "gap": np.nanmin(series["gap"]), "x": x.tolist()}

    return case(name, "stenosis", CHANGES[name], measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    coarse = with_pictures(results, through("", results.path.parent), "stenosis.png", "stenosis.gif")
    fine = results.get(through("fine"))
    return {
        "stenosis_drop": f"{coarse['drop']:.1f} and {fine['drop']:.1f}",
        "stenosis_gap": f"{coarse['gap']:.4f} and {fine['gap']:.4f}",
        "stenosis_asymmetry": f"{asymmetry(np.array(fine['x'])):.0e}",
        "seconds": seconds(coarse, fine),
    }


SCENE = Scene("stenosis", fill, long=True)
