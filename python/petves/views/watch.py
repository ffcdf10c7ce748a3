"""What goes on, drawn anew: a run into a page of its folder, a simulation in a notebook."""

from __future__ import annotations

import contextlib
import fcntl
import html
import io
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from petves.errors import Error
from petves.files import shown, write_text
from petves.run import RunError
from petves.views.figures import PLAIN, Look, dress, filled, new_figure
from petves.views.plot import plot_run

if TYPE_CHECKING:
    from petves.simulation import Callback, Simulation


def watch(folder: str | Path, every: float = 10, look: Look = PLAIN) -> Path:
    """Draw a run that goes on into watch.html of its folder, anew until it ends, and return that page as it is then.

    The page reloads itself in a browser.

    Parameters
    ----------
    folder : str or Path
        The run's ``-output_dir``, `RunError` when there is none. The pictures are those of `petves.plot`.
    every : float
        Seconds between two drawings.
    look : Look
        How the pictures look.
    """
    page = Path(folder) / "watch.html"
    if not page.parent.is_dir():
        raise RunError(f"{folder}: no such folder; give the -output_dir of a run")
    while goes_on(page.parent):
        _draw(page, every, look)
        time.sleep(every)
    return _draw(page, None, look)


def goes_on(folder: Path) -> bool:
    """Return whether a process works in a run's folder: it holds the lock on run.lock."""
    with contextlib.suppress(FileNotFoundError), (folder / "run.lock").open() as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except OSError:
            return True
    return False


def _draw(page: Path, every: float | None, look: Look) -> Path:
    """Draw the pictures and the page, without a saved time yet the page alone; `every` is None when the run has ended."""
    told = "The run has ended, or stopped." if every is None else f"The run goes on. Drawn at {time.strftime('%X')}."
    try:
        pictures = plot_run(page.parent, look)
    except RunError as error:
        pictures, told = [], f"{told} {error}"
    parts = {
        "REFRESH": "" if every is None else f'<meta http-equiv="refresh" content="{every:g}">',
        "TITLE": html.escape(f"petves: {shown(page.parent.resolve().name)}"),
        "TOLD": html.escape(told),
        "PICTURES": "\n".join(f'<img src="{x.name}?{x.stat().st_mtime_ns}" alt="{x.stem}">' for x in pictures),
    }
    return write_text(page, filled("watch.html", parts))


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
