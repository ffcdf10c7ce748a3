"""A film of the membrane over the flow."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np

from petves.progress import progress_bar
from petves.run import Run, RunError
from petves.views.plot import FIELDS, draw_membranes, new_figure

SUFFIXES = (".mp4", ".gif")


def movie(
    folder: str | Path, output: str | Path | None = None, field: str = "speed", rate: float = 15, width: int = 720
) -> Path:
    """Film a run: a picture a saved time.

    Parameters
    ----------
    folder : str or Path
        The run's ``-output_dir``.
    output : str or Path, optional
        File to write, .mp4 (needs ffmpeg) or .gif; movie.mp4 in the folder, or movie.gif without ffmpeg.
    field : str
        What is under the membrane: "speed" or "pressure".
    rate : float
        Pictures a second.
    width : int
        Width in pixels.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    RunError
        When the run cannot be read, or the file not be written this way.
    """
    run = Run.read(folder)
    ffmpeg = shutil.which("ffmpeg") is not None
    path = Path(output) if output else run.folder / ("movie.mp4" if ffmpeg else "movie.gif")
    if path.suffix not in SUFFIXES:
        raise RunError(f"{path}: allowed: a name that ends in {' or '.join(SUFFIXES)}")
    if path.suffix == ".mp4" and not ffmpeg:
        raise RunError(f"{path}: ffmpeg is not installed; install it, or ask for a .gif")
    if field not in FIELDS:
        raise RunError(f"field {field}: unknown; allowed: {', '.join(FIELDS)}")
    _film(run, path, field, rate, width)
    return path


def _film(run: Run, path: Path, field: str, rate: float, width: int) -> None:
    from matplotlib.animation import FFMpegWriter, PillowWriter

    frames = range(len(run.time))
    values = FIELDS[field].values
    highest = max((float(np.max(np.abs(values(*run.fields(frame))))) for frame in frames), default=0.0) or 1.0
    sides = run.box[1] - run.box[0], run.box[3] - run.box[2]
    inches = width / 100
    height = 2 * round(50 * np.clip((inches - 1.6) * sides[1] / sides[0] + 0.9, 2.0, 1.5 * inches)) / 100  # even pixels
    figure, (axes,) = new_figure(inches, height)
    kind = FIELDS[field]
    low = -highest if kind.signed else 0.0
    image = axes.imshow(
        values(*run.fields(0)), origin="lower", extent=run.box, cmap=kind.cmap, vmin=low, vmax=highest, aspect="equal"
    )
    figure.colorbar(image, ax=axes, label=kind.label, shrink=0.85)
    axes.set(xlabel="$x$ (length)", ylabel="$y$ (length)", xlim=run.box[:2], ylim=run.box[2:])
    limits = (run.tension.min(), run.tension.max()) if run.vesicles else (0.0, 1.0)
    if path.suffix == ".mp4":
        writer = FFMpegWriter(fps=rate, codec="libx264", extra_args=["-pix_fmt", "yuv420p", "-loglevel", "error"])
    else:
        writer = PillowWriter(fps=rate)
    with writer.saving(figure, str(path), 100), progress_bar(len(frames), unit="frames") as bar:
        for frame in frames:
            image.set_data(values(*run.fields(frame)))
            drawn = draw_membranes(axes, run, frame, limits, kind.line)
            axes.set_title(f"$t$ = {run.time[frame]:.4g}")
            writer.grab_frame()
            for artist in drawn:
                artist.remove()
            bar(frame + 1)
