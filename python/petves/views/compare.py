"""Two runs side by side."""

from pathlib import Path

import numpy as np

from petves.files import shown
from petves.run import Run, RunFolder
from petves.views.plot import draw_outlines, dress, new_figure, save_figure

COUNTERS = ("step", "wall", "nsolve", "tension_its", "bending_its", "coupled_its")
SAME = 1e-9  # times closer than this part of a run are the same


def compare(first: str | Path, second: str | Path, output: str | Path | None = None) -> tuple[list[str], Path]:
    """Compare two runs: their options, their series and their membranes.

    Parameters
    ----------
    first, second : str or Path
        The runs' folders; `RunError` when one cannot be read.
    output : str or Path, optional
        The picture; compare.png in the first folder when left out.

    Returns
    -------
    lines : list of str
        Options that differ; last values and largest differences of the columns over the common time, the second run
        interpolated; largest distance of markers at common saved times.
    picture : Path
        Energy, inclination and last outlines of both.
    """
    runs = Run.read(first), Run.read(second)
    lines = _options(*runs) + _columns(*runs) + [_markers(*runs)]
    return lines, _draw(runs, Path(output) if output else runs[0].folder / "compare.png")


def _table(header: list[str], rows: list[list[str]]) -> list[str]:
    """Return the lines of a Markdown table, and an empty one."""
    return ["| " + " | ".join(line) + " |" for line in (header, ["---"] * len(header), *rows)] + [""]


def _options(a: RunFolder, b: RunFolder) -> list[str]:
    one, two = a.options(), b.options()
    names = [name for name in {**one, **two} if name != "output_dir" and one.get(name) != two.get(name)]
    if not names:
        return ["The options are the same.", ""]
    rows = [["-" + name, one.get(name, "not given"), two.get(name, "not given")] for name in names]
    return _table(["option", shown(a.folder), shown(b.folder)], rows)


def _columns(a: RunFolder, b: RunFolder) -> list[str]:
    end = min(a.series["time"][-1], b.series["time"][-1])
    at = a.series["time"][a.series["time"] <= end * (1 + SAME)]
    rows = []
    for name, values in a.series.items():
        if name in COUNTERS + ("time", "dt") or name not in b.series:
            continue
        own, other = values[: len(at)], np.interp(at, b.series["time"], b.series[name])
        gap = np.abs(own - other)
        largest = f"{np.nanmax(gap):.3e}" if np.isfinite(gap).any() else "none"
        rows.append([name, f"{own[-1]:.8g}", f"{other[-1]:.8g}", largest])
    return _table(["column", f"first at t = {end:g}", "second", "largest difference"], rows)


def _markers(a: RunFolder, b: RunFolder) -> str:
    pairs = [(i, j) for i, t in enumerate(a.time) for j in np.flatnonzero(np.isclose(b.time, t, rtol=0, atol=SAME))]
    one, two = (run.markers if isinstance(run, Run) else run.points for run in (a, b))
    if one.shape[1:] != two.shape[1:]:
        return f"Markers are not compared: {one[0, ..., 0].size} and {two[0, ..., 0].size} of them."
    if not pairs or not a.vesicles:
        return "Markers are not compared: there are no common saved times."
    gaps = [np.linalg.norm(one[i] - two[j], axis=-1).max() for i, j in pairs]
    return f"Markers: {max(gaps):.3e} apart at most (length) at {len(pairs)} common saved times, {gaps[-1]:.3e} at the last."


def _draw(runs: tuple[RunFolder, RunFolder], path: Path) -> Path:
    figure, axes = new_figure(13, 4, columns=3)
    for run, color, style in zip(runs, ("C0", "C1"), ("-", "--")):
        label, time = shown(run.folder), run.series["time"]
        axes[0].plot(time, sum(run.energies().values()), style, color=color, label=label)
        axes[1].plot(time, np.unwrap(run.series["inclination"], period=np.pi), style, color=color, label=label)
        if isinstance(run, Run):
            draw_outlines(axes[2], run, -1, color, style)
        else:
            axes[2].plot(*run.points[-1, ..., :2].reshape(-1, 2).T, ".", color=color, ms=2)
    power = 4 if isinstance(runs[0], Run) else 5
    dress(axes[0], 10, xlabel="time $t$", ylabel=f"energy (length$^{power}$/time$^2$)")
    dress(axes[1], xlabel="time $t$", ylabel=r"inclination $\theta$ (radians)")
    dress(axes[2], xlabel="$x$ (length)", ylabel="$y$ (length)", aspect="equal", title="last saved outlines")
    return save_figure(figure, path)
