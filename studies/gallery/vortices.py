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
from studies.common.scenes import RUNS, option_file, option_text, words
from studies.gallery.scene import Scene, Values, film, least, moments


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


def made(results: Results, file: str, changes: str, pictures: tuple[str, ...], draw) -> dict:
    """Return the measures of a run: energies, gap, worst errors of area and length; `draw(folder)` makes its pictures."""
    options = option_file(f"gallery/{file}") | words(changes)

    def measure() -> dict[str, object]:
        with tempfile.TemporaryDirectory() as name:
            command = [
                sys.executable,
                "-m",
                "studies.gallery.vortices",
                file,
                name,
                *option_text(words(changes)).split(),
            ]
            before = cpu_seconds()
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode:
                raise RunError(f"{file}: {done.stderr.strip().splitlines()[-1]}")
            spent = round(cpu_seconds() - before, 1)
            draw(Path(name))
            return measures(Path(name)) | {"cpu_seconds": spent}

    name = f"{file}_{changes.replace(' ', '_')}" if changes else file
    if not all((results.path.parent / picture).is_file() for picture in pictures):
        results.entries.pop(name, None)
    return results.derive(name, options, measure)


def measures(folder: Path) -> dict[str, object]:
    """Return what is kept of a run."""
    series = read_series(folder / "series.csv")
    gap, time = least(series)
    run = Run.read(folder)
    middle = np.array([run.markers[-1, a:b].mean(axis=0) for a, b in zip(run.start, run.start[1:])])
    energy = series["energy_bending"]
    return {
        "area": np.abs(series["area_error"]).max(),
        "length": np.abs(series["length_error"]).max(),
        "gap": gap,
        "gap_time": time,
        "energy": [energy[0], energy.max(), energy[-1]],
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

    four = made(results, "vortex", "", ("vortex.png",), draw_vortex)
    coarse = made(results, "vortex", "-domain_cells 32,32", (), lambda folder: None)
    many = made(results, "lattice", "", ("lattice.png", "lattice.gif"), draw_lattice)
    apart = np.abs(np.array(four["middle"]) - np.array(coarse["middle"])).max()
    return {
        "vortex_turned": f"{turned(four['middle']):.0e}",
        "vortex_apart": f"{apart:.0e}",
        "vortex_errors": f"{four['area']:.0e}, {four['length']:.0e}",
        "vortex_energy": ", ".join(f"{value:.4f}" for value in (four["energy"][0], four["energy"][2])),
        "vortex_gap": f"{four['gap']:.3f}",
        "lattice_shifted": f"{shifted(many['middle']):.0e}",
        "lattice_errors": f"{many['area']:.0e}, {many['length']:.0e}",
        "lattice_energy": ", ".join(f"{value:.3f}" for value in many["energy"]),
        "lattice_gap": f"{many['gap']:.3f}",
        "vortex_seconds": f"{four['cpu_seconds']:.0f}",
        "lattice_seconds": f"{many['cpu_seconds']:.0f}",
    }


SCENE = Scene("vortices", fill)


if __name__ == "__main__":
    main(*sys.argv[1:])
