"""Vesicles in a Taylor-Green flow, which comes from Python.

``PYTHONPATH=python:. python3 -m studies.gallery.vortices FILE DIR [-option value ...]`` runs runs/gallery/FILE.opts in it.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from petves.run import Run, RunError, read_series
from studies.common.engine import Results, cpu_seconds
from studies.common.scenes import RUNS, option_file, words
from studies.gallery.scene import Scene, Values, film, moments, seconds


def vortices(x: np.ndarray, y: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Return sin x cos y, -cos x sin y: period 2 pi, rate 1."""
    return np.sin(x) * np.cos(y), -np.cos(x) * np.sin(y)


def main(file: str, folder: str, *options: str) -> None:
    """Run an option file in the flow."""
    import petves

    changes = {name.removeprefix("-"): value for name, value in words(" ".join(options)).items()}
    scene = RUNS / "gallery" / f"{file}.opts"
    with petves.Simulation(scene, flow=vortices, quiet=False, **(changes | {"output_dir": folder})) as sim:
        print(sim.run())


def made(results: Results, file: str, pictures: tuple[str, ...], draw) -> dict:
    """Return the measures of a run: worst errors of area and length, places at the end; `draw(folder)` makes its pictures."""

    def measure() -> dict[str, object]:
        with tempfile.TemporaryDirectory() as name:
            command = [sys.executable, "-m", "studies.gallery.vortices", file, name]
            before = cpu_seconds()
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode:
                raise RunError(f"{file}: {done.stderr.strip().splitlines()[-1]}")
            spent = round(cpu_seconds() - before, 1)
            draw(Path(name))
            return measures(Path(name)) | {"cpu_seconds": spent}

    if not all((results.path.parent / picture).is_file() for picture in pictures):
        results.entries.pop(file, None)
    return results.derive(file, option_file(f"gallery/{file}"), measure)


def measures(folder: Path) -> dict[str, object]:
    """Return what is kept of a run."""
    series = read_series(folder / "series.csv")
    run = Run.read(folder)
    middle = np.array([run.markers[-1, a:b].mean(axis=0) for a, b in zip(run.start, run.start[1:])])
    return {
        "area": np.abs(series["area_error"]).max(),
        "length": np.abs(series["length_error"]).max(),
        "middle": np.round(middle, 6).tolist(),
    }


def turned(middle: list[list[float]]) -> float:
    """Return how far four vesicles are from being one another turned by a quarter about the vortex's middle."""
    place = (np.array(middle) - np.pi / 2) @ [1, 1j]
    return float(max(min(abs(1j * z - place)) for z in place))


def shifted(middle: list[list[float]]) -> float:
    """Return how far vesicles are from being one another moved by half a period in x and in y."""
    place = np.array(middle)
    apart = (place[:, None] + np.pi - place[None, :] + np.pi) % (2 * np.pi) - np.pi
    return float(np.hypot(*apart.transpose(2, 0, 1)).min(axis=1).max())


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    home = results.path.parent

    def draw_vortex(folder: Path) -> None:
        moments(folder, home / "vortex.png", (0, 2, 5, 10), (0, np.pi, 0, np.pi), rows=2, width=9)

    def draw_lattice(folder: Path) -> None:
        moments(folder, home / "lattice.png", (0, 0.6, 1.2, 2), rows=2, width=10)
        film(folder, home / "lattice.gif", width=560)

    four = made(results, "vortex", ("vortex.png",), draw_vortex)
    many = made(results, "lattice", ("lattice.png", "lattice.gif"), draw_lattice)
    return {
        "vortex_turned": f"{turned(four['middle']):.0e}",
        "lattice_shifted": f"{shifted(many['middle']):.0e}",
        "lattice_errors": f"{many['area']:.0e}, {many['length']:.0e}",
        "seconds": seconds(four, many),
    }


SCENE = Scene("vortices", fill)


if __name__ == "__main__":
    main(*sys.argv[1:])
