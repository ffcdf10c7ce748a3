"""A simulation under way, drawn in a notebook."""

from __future__ import annotations

import io
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from petves.errors import Error
from petves.views.figures import dress, new_figure

if TYPE_CHECKING:
    from petves.simulation import Callback, Simulation


class Live:
    """A callback of `Simulation.run` that draws membranes and solids, bending energy and inclination where it is made.

    The picture is replaced every second, and at the end of a run to time_end; then another callback is called, if any.
    """

    def __init__(self, simulation: Simulation, then: Callback | None = None) -> None:
        try:
            from IPython.display import display
        except ImportError:
            raise Error("live: IPython is not installed; allowed: in a notebook") from None
        self.then, self.drawn, self.end = then, time.monotonic(), float(simulation.options["time_end"])
        self.handle = display(picture(simulation), display_id=True)

    def __call__(self, simulation: Simulation) -> Any:
        """Draw, and return what the other callback says."""
        if self.handle and (time.monotonic() - self.drawn >= 1.0 or simulation.time >= self.end):
            self.handle.update(picture(simulation))
            self.drawn = time.monotonic()
        return self.then(simulation) if self.then else None


def picture(sim: Simulation) -> Any:
    """Return the picture of a simulation's present state, as IPython shows it."""
    from IPython.display import Image

    figure, axes = new_figure(12, 3.6, columns=3)
    box = np.array([float(x) for x in sim.options["domain_box"].split(",")])
    sides, wrapped = box[1::2] - box[::2], [sim.options[f"domain_bc_{c}"] == "periodic" for c in "xy"]
    for points in sim.obstacles:
        axes[0].fill(*points.T, "0.6")
    for vesicle, points in enumerate(np.split(sim.markers, sim.start[1:-1]) if sim.vesicles else []):
        periods = wrapped * np.floor((points.mean(axis=0) - box[::2]) / sides)
        axes[0].fill(*(points - periods * sides).T, fill=False, ec=f"C{vesicle % 10}")
    dress(axes[0], xlabel="$x$ (length)", ylabel="$y$ (length)", title=f"$t$ = {sim.time:.4g}")
    axes[0].set(xlim=box[:2], ylim=box[2:], aspect="equal")
    history, names = sim.history, {"energy_bending": "bending energy", "inclination": r"inclination $\theta$"}
    for panel, (name, label) in zip(axes[1:], names.items()):
        panel.plot(history["time"], history[name])
        dress(panel, xlabel="time $t$", ylabel=label)
    file = io.BytesIO()
    figure.savefig(file, dpi=80)
    return Image(file.getvalue())
