"""Two vesicles that a potential holds together turn in shear."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, moments, seconds, with_pictures

EXACT = {(0.5, 1.5): 36.34, (0.5, 3.5): 28.46, (1.0, 1.5): 20.73, (1.0, 3.5): 17.91}
"""Period by rate and H: Quaife, Veerapaneni and Young (2019)."""


def doublet(rate: float, strength: float, markers: int, pictures: Path | None = None) -> Case:
    """Return the period from an eighth of a turn on, and the least gap."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "doublet.png", (0, 7, 14, 21), (-2.2, 2.2, -1.9, 1.9))
        x, y = (series[f"center_{c}_2"] - series[f"center_{c}_1"] for c in "xy")
        turned = -np.unwrap(np.arctan2(y, x))
        first, last = (np.interp(t, turned, series["time"]) for t in (np.pi / 4, 9 * np.pi / 4))
        return {"period": last - first, "gap": series["gap"].min()}

    changes = f"-flow_rate {rate} -contact_potential {strength} -vesicle_markers {markers}"
    end = f"-time_end {1.4 * EXACT[rate, strength]!r}"
    return case(f"{rate:g}_{strength:g}_{markers}", "doublet", f"{changes} {end}", measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    rows, runs = [], []
    for (rate, strength), exact in EXACT.items():
        drawn = (rate, strength) == (0.5, 3.5)
        one = doublet(rate, strength, 45, results.path.parent if drawn else None)
        found = with_pictures(results, one, "doublet.png") if drawn else results.get(one)
        fine = results.get(doublet(rate, strength, 65))
        off = f"{100 * (found['period'] / exact - 1):+.1f} %"
        rows.append(
            [rate, strength, f"{found['period']:.2f}", f"{fine['period']:.2f}", exact, off, f"{found['gap']:.3f}"]
        )
        runs += [found, fine]
    header = ["rate", "H", "45 markers", "65 markers", "published", "off by", "least gap"]
    return {"doublets": [header, *rows], "seconds": seconds(*runs)}


SCENE = Scene("doublet", fill)
