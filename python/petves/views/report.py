"""One self-contained HTML file about a run."""

import base64
import io
import json
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import colormaps

from petves.files import read_file, shown, write_text
from petves.run import Run, RunFolder
from petves.views.field import reach
from petves.views.figures import MANY, PLAIN, filled
from petves.views.plot import plot_conservation, plot_energy, plot_motion, plot_shapes, plot_tension
from petves.views.surfaces import plot_course, plot_surfaces
from petves.views.window import Window
from petves.views.words import key_numbers, scene_in_words

FRAMES = 81  # saved times kept at most
COLOURS = ("viridis", "RdBu_r", "plasma")  # of speed, pressure and tension
PIXELS = 96  # of a field's longer side
CAPTIONS = {
    plot_energy: "Energy.",
    plot_motion: "How the vesicles lie and turn; dotted: steady values.",
    plot_conservation: "What the scheme loses of area and length.",
    plot_tension: "Tension around the membrane at the last saved time.",
    plot_shapes: "Outlines.",
}
IN_SPACE = {
    plot_surfaces: "The surfaces at the last saved time, coloured by tension.",
    plot_course: "Energy, angle and axes.",
    plot_conservation: "What the scheme loses of area and volume.",
}


def report(folder: str | Path, output: str | Path | None = None) -> Path:
    """Write a report of a run and return it: the scene in words, key numbers, plots, the membrane playable with a slider.

    Parameters
    ----------
    folder : str or Path
        The run's ``-output_dir``; `RunError` when it cannot be read.
    output : str or Path, optional
        File to write; report.html in the folder when left out. It needs no other file and no network.
    """
    run = Run.read(folder)
    told = read_file(run.folder / "resolved.opts", lambda _: (key_numbers(run), scene_in_words(run)))
    rows = "".join(f"<tr><td>{escape(name)}</td><td>{escape(value)}</td></tr>" for name, value in told[0])
    words = "".join(f"<p>{escape(text)}</p>" for text in told[1])
    data = _data(run) if isinstance(run, Run) else None  # surfaces have no view with a slider, but pictures
    few = " The dot is marker 0, a point of the membrane; dotted: the first outline." if run.vesicles <= MANY else ""
    membranes = f"Membranes are coloured by their tension.{few} " if run.vesicles else ""
    parts = {
        "TITLE": escape(f"petves: {shown(run.folder.resolve().name)}"),
        "WORDS": words,
        "NUMBERS": rows,
        "NOTE": f"{membranes}The colours of the fluid span the range of each time, but for a few cells that have much more.",
        "PLOTS": _plots(run),
        "OPTIONS": escape("\n".join(f"-{name} {value}".rstrip() for name, value in run.options().items())),
        "DATA": json.dumps(data, separators=(",", ":")).replace("</", "<\\/"),
    }
    return write_text(Path(output) if output else run.folder / "report.html", filled("report.html", parts))


def _plots(run: RunFolder) -> str:
    """Return the plots as figures with embedded pictures."""
    figures = []
    for draw, caption in (CAPTIONS if isinstance(run, Run) else IN_SPACE).items():
        if draw is not plot_energy and not run.vesicles:
            continue
        file = io.BytesIO()
        draw(run).savefig(file, dpi=PLAIN.dpi)
        picture, caption = base64.b64encode(file.getvalue()).decode(), escape(caption)
        image = f'<img alt="{caption}" src="data:image/png;base64,{picture}">'
        figures.append(f"<figure>{image}<figcaption>{caption}</figcaption></figure>")
    return "\n".join(figures)


def _data(run: Run) -> dict[str, Any]:
    """Return what the page draws: outlines, tension and fields of at most FRAMES saved times."""
    frames = run.spread_frames(FRAMES)
    digits = 5 - int(np.floor(np.log10(run.box[1] - run.box[0])))
    raw = [Window(run, frame).fields() for frame in frames]
    speed = _field([np.hypot(u, v) for u, v, _ in raw], False, "viridis", "speed (length/time)")
    pressure = _field([p for _, _, p in raw], True, "RdBu_r", "pressure (length²/time²)")

    def solids(frame: int) -> list[Any]:
        return [np.round(points, digits).tolist() for points in Window(run, frame).solids()]

    return {
        "box": [float(x) for x in run.box],
        "time": [float(t) for t in run.time[frames]],
        "start": [int(k) for k in run.start],
        "solids": solids(0),
        "solids_at": [solids(frame) for frame in frames] if len(run.obstacle_markers) else None,
        "periods": [float(period) for period in run.periods],
        "shift": 0.0 if run.options().get("membrane_derivative") == "spectral" else 0.5,
        "markers": np.round(run.markers[frames], digits).tolist(),
        "tension": [[float(f"{x:.4g}") for x in row] for row in run.tension[frames]],
        "tension_limits": run.tension_range(frames),
        "fields": {"speed": speed, "pressure": pressure},
        "colours": {name: _bytes(255 * colormaps[name](np.arange(256))[:, :3]) for name in COLOURS},
    }


def coarsen(values: np.ndarray) -> np.ndarray:
    """Return a field's means over square blocks, so that no side is longer than PIXELS."""
    block = -(-max(values.shape) // PIXELS)
    padded = np.pad(values, [(0, -n % block) for n in values.shape], mode="edge")
    ny, nx = (n // block for n in padded.shape)
    return padded.reshape(ny, block, nx, block).mean(axis=(1, 3))


def _bytes(values: np.ndarray) -> str:
    """Return numbers from 0 to 255 as text, a byte each."""
    return base64.b64encode(np.clip(np.round(values), 0, 255).astype(np.uint8).tobytes()).decode()


def _field(frames: list[np.ndarray], signed: bool, colours: str, label: str) -> dict[str, Any]:
    """Return a field of all frames in eight bits, each frame over its `reach`, from minus to plus if `signed`."""
    values = np.stack([coarsen(frame) for frame in frames])
    high = np.array([reach(frame) for frame in values])
    low = -high if signed else 0 * high
    share = (values - low[:, None, None]) / (high - low)[:, None, None]
    shape = [int(n) for n in values.shape[1:]]
    ends = {name: [float(f"{x:.4g}") for x in limit] for name, limit in (("low", low), ("high", high))}
    return {"values": _bytes(255 * share), "shape": shape, **ends, "colours": colours, "label": label}
