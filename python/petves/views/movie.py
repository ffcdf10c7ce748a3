"""A film of the membrane over the flow."""

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.animation import FFMpegWriter, PillowWriter
from matplotlib.figure import Figure

from petves.files import writing
from petves.progress import progress_bar
from petves.run import Run, RunError, SurfaceRun
from petves.views.field import TENSION, box_sheet, draw_field, draw_membranes, draw_streamlines, field_kind, reach
from petves.views.figures import PLAIN, Look, add_bar
from petves.views.surfaces import plot_surfaces
from petves.views.window import Window

DOTS = 150  # an inch


def movie(
    folder: str | Path,
    output: str | Path | None = None,
    field: str = "speed",
    rate: float = 15,
    width: int = 1080,
    every: int = 1,
    begin: float | None = None,
    end: float | None = None,
    streamlines: bool = False,
    look: Look = PLAIN,
) -> Path:
    """Film a run: a picture a saved time; return the file. A bar shows how far it has come, where standard error is a terminal.

    Parameters
    ----------
    folder : str or Path
        The run's ``-output_dir``; `RunError` when it cannot be read.
    output : str or Path, optional
        File to write, .mp4 (needs ffmpeg) or .gif; movie.mp4 in the folder, or movie.gif without ffmpeg. `RunError` when it
        cannot be written.
    field : str
        What is under the membrane: speed, pressure, pressure_deviation, vorticity or stream_function.
    rate : float
        Pictures a second.
    width : int
        Width in pixels.
    every : int
        Take one saved time in so many.
    begin, end : float, optional
        First and last time; all saved times when left out.
    streamlines : bool
        Draw streamlines too; a film then takes several times as long.
    look : Look
        Colour map, and whether the picture goes along with a vesicle; a film has its own format and size.
    """
    run = Run.read(folder)
    ffmpeg = shutil.which("ffmpeg") is not None
    path = Path(output) if output else run.folder / ("movie.mp4" if ffmpeg else "movie.gif")
    if path.suffix not in (".mp4", ".gif"):
        raise RunError(f"{path}: allowed: a name that ends in .mp4 or .gif")
    if path.suffix == ".mp4" and not ffmpeg:
        raise RunError(f"{path}: ffmpeg is not installed; install it, or ask for a .gif")
    frames, look = chosen_frames(run, every, begin, end), replace(look, width=width / DOTS)
    if isinstance(run, SurfaceRun):
        figure = plot_surfaces(run, look, frames[0])
        draw = lambda frame: plot_surfaces(run, look, frame, frames, figure)
    else:
        figure, draw = _plane(run, frames, field, streamlines, look)
    # films have even numbers of pixels
    figure.set_size_inches(2 * np.round(figure.get_size_inches() * DOTS / 2) / DOTS)
    if path.suffix == ".mp4":
        writer = FFMpegWriter(fps=rate, codec="libx264", extra_args=["-pix_fmt", "yuv420p", "-loglevel", "error"])
    else:
        writer = PillowWriter(fps=rate)
    with writing(path) as fresh, writer.saving(figure, str(fresh), DOTS):
        with progress_bar(len(frames), unit="frames") as bar:
            for done, frame in enumerate(frames, 1):
                draw(frame)
                writer.grab_frame()
                bar(done)
    return path


def chosen_frames(run: Run | SurfaceRun, every: int, begin: float | None, end: float | None) -> np.ndarray:
    """Return the numbers of the saved times from `begin` to `end`, one in `every`."""
    if every < 1:
        raise RunError(f"every {every}: out of range; allowed: 1 or more")
    slack = 1e-9 * max(abs(run.time[-1]), abs(run.time[0]))
    low, high = (run.time[0] if begin is None else begin), (run.time[-1] if end is None else end)
    frames = np.flatnonzero((run.time >= low - slack) & (run.time <= high + slack))[::every]
    if not len(frames):
        allowed = f"times in {run.time[0]:g} to {run.time[-1]:g}"
        raise RunError(f"from {low:g} to {high:g}: no saved time; allowed: {allowed}")
    return frames


def _plane(
    run: Run, frames: np.ndarray, field: str, streamlines: bool, look: Look
) -> tuple[Figure, Callable[[int], None]]:
    """Return a figure, and what draws the membranes over a field at a saved time on it; colours are those of all frames."""
    kind = field_kind(field)
    windows = {frame: Window(run, frame, look.follow) for frame in frames}
    ends = [(reach(values), np.max(np.abs(values))) for values in map(kind.values, windows.values())]
    highest, most = np.max(ends, axis=0)
    limits = run.tension_range(frames)
    sheet = box_sheet(windows[frames[0]], look, panels=1, last=run.vesicles > 0)
    (panel,) = sheet.panels

    def draw(frame: int) -> None:
        panel.clear()
        image = draw_field(panel, kind, windows[frame], look, highest, most)
        drawn = draw_membranes(panel, run, frame, limits, kind.line, look.follow)
        if streamlines:
            draw_streamlines(panel, windows[frame])
        if frame == frames[0]:
            add_bar(sheet.bars[0], image, kind.label)
            if sheet.last is not None:
                add_bar(sheet.last, drawn[-1], TENSION)
        panel.set_title(f"$t$ = {run.time[frame]:.4g}", fontsize=10)

    return sheet.figure, draw
