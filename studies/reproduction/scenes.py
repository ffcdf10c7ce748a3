"""The scenes of sections 5.4 to 5.6: runs of the option files in runs/, and what is kept of each."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.run import Run
from studies.common.curves import aspect, at_rest, radius, trigonometric
from studies.common.engine import Case, Series
from studies.common.scenes import BENDING, CHANNEL_V, ILU, PEAK, cells as grid, option_file, words

REDUCED_AREAS, CHIS = (0.5, 0.6, 0.7, 0.8, 0.9), (1, 10, 100)
WINDOWS = (6, 12, 24, 48, 384)
QUIET = words("-checkpoint_every 0")


def shear_rate(reduced_area: float, chi: float) -> float:
    """Return the rate of shear of section 5.6."""
    return chi * BENDING / radius(reduced_area) ** 3


def frames(run: Run, times: list[float]) -> dict[str, list]:
    """Return markers and sigma R0^2/c_b, both rounded, at the saved times nearest to those given."""
    at = [int(np.abs(run.time - t).argmin()) for t in times]
    scale = (run.series["length"][0] / (2 * np.pi)) ** 2 / run.c_b
    return {
        "time": [round(float(run.time[k]), 6) for k in at],
        "markers": [np.round(run.markers[k], 5).tolist() for k in at],
        "tension": [np.round(run.edge_tension(k) * scale, 4).tolist() for k in at],
    }


def _cost(series: Series) -> dict[str, object]:
    return {"steps": len(series["time"]) - 1, "step_seconds": series["wall"].sum()}


def measure_rest(series: Series, folder: Path) -> dict[str, object]:
    run = Run.read(folder)
    r0 = series["length"][0] / (2 * np.pi)
    found = at_rest(series, folder)
    scaled = {"energy": found["energy"] * r0 / run.c_b, "drift": found["drift"]}
    scaled |= {key: found[key] / r0 for key in ("width", "mid_height")}
    ends = {"area_error": series["area_error"][-1], "length_error": series["length_error"][-1]}
    return scaled | ends | {"frames": frames(run, [0, run.time[-1]])} | _cost(series)


def equilibrium(reduced_area: float) -> Case:
    """Return section 5.4 with the default scheme."""
    options = option_file("equilibrium") | QUIET | {"-vesicle_reduced_area": repr(reduced_area)}
    return Case(f"equilibrium_{reduced_area}", options, measure_rest)


def equilibrium_paper(reduced_area: float, n: int) -> Case:
    """Return section 5.4 with the paper's method on h = 1/n, dt = h/4, to t = 100: about 3 nu R0^3/c_b."""
    options = option_file("paper/equilibrium") | QUIET | ILU
    options |= grid(4 * n) | words(f"-time_step {0.25 / n!r} -time_end 100")
    options |= words(f"-vesicle_reduced_area {reduced_area!r} -output_every 50 -vesicle_angle 90")
    del options["-time_steady_tol"]
    return Case(f"equilibrium_paper_{n}_{reduced_area}", options, measure_rest, may_fail=True)


def _channel(series: Series, folder: Path, r0: float = radius(CHANNEL_V)) -> dict[str, object]:
    run = Run.read(folder)
    time = np.linspace(0, series["time"][-1], 61)
    center = np.stack([np.interp(time, series["time"], series[f"center_{x}"]) for x in "xy"])
    speed = run.velocity.mean(axis=1)
    shapes = [trigonometric(x) for x in run.markers]
    return {
        "time": list(time),
        "travel": list((center[0] - center[0, 0]) / r0),
        "height": list((center[1] - 3) / r0),
        "saved": list(run.time),
        "slip": list((speed[:, 0] - PEAK) * r0**2 / BENDING),
        "aspect": [aspect(x) for x in shapes],
        "extent": [list(np.ptp(x, axis=0) / r0) for x in shapes],
        "frames": frames(run, list(np.linspace(0, 96, 9)) + [run.time[-1]]),
        "area_error": series["area_error"][-1],
    } | _cost(series)


def channel(
    offset: int, window: int = 12, inertia: str = "none", cells: int = 8, time_end: float = 96, dt: float = 0.12
) -> Case:
    """Return section 5.5 with the default scheme: c_0 = offset R0, window length, cells a unit of length."""
    options = option_file("poiseuille") | QUIET | words(f"-fluid_inertia {inertia} -time_end {time_end:g}")
    options |= words(f"-domain_box 0,{window},0,6") | grid(window * cells, 6 * cells)
    options |= words(f"-vesicle_center {min(window, 12) / 2:g},{3 + offset * radius(CHANNEL_V)!r}")
    options |= words(f"-time_step {dt!r} -output_every {400 if window > 100 else 4}")
    return Case(f"channel_{offset}_{window}_{inertia}_{cells}_{time_end:g}", options, _channel, may_fail=True)


def channel_end(offset: int, cells: int, reduced_area: float, time_end: float) -> Case:
    """Return section 5.5 on its way to an end state: window 12, none, u_max dt/h = 1.3; any reduced area."""
    case = channel(offset, cells=cells, time_end=time_end, dt=0.96 / cells)
    r0 = radius(reduced_area)
    case.options |= {"-vesicle_reduced_area": repr(reduced_area), "-vesicle_center": f"6,{3 + offset * r0!r}"}
    case.options |= {"-output_every": repr(time_end / 60)}

    def measure(series: Series, folder: Path) -> dict[str, object]:
        found = _channel(series, folder, r0)
        return {key: found[key] for key in ("time", "height", "saved", "slip", "aspect", "area_error", "steps")}

    name = f"channel_end_{offset}_{cells}_{reduced_area}_{time_end:g}"
    return Case(name, case.options, measure, may_fail=True)


def channel_models(model: str) -> Case:
    """Return c_0 = R0 with a step short enough for convection (CFL 0.45), the same for each model."""
    case = channel(1, inertia=model, dt=0.04)
    case.name = f"channel_model_{model}"
    return case


def channel_paper(offset: int, n: int, window: int, time_end: float) -> Case:
    """Return section 5.5 with the paper's method on h = 1/n: dt = h/(8 u_max), unsteady, window of the length given."""
    options = option_file("paper/poiseuille") | QUIET | ILU
    options |= words(f"-domain_box 0,{window},0,6") | grid(window * n, 6 * n)
    options |= words(f"-vesicle_center 6,{3 + offset * radius(CHANNEL_V)!r} -time_step {1 / (8 * n * PEAK)!r}")
    options |= words(f"-time_end {time_end:g} -output_every 4")
    return Case(f"channel_paper_{offset}_{n}_{window}_{time_end:g}", options, _channel, may_fail=True)


def _tank_treading(series: Series, folder: Path) -> dict[str, object]:
    run = Run.read(folder)
    summary = {
        "theta": series["inclination"][-1] / np.pi,
        "omega": series["frequency"][-1],
        "drift": abs(np.interp(0.9 * series["time"][-1], series["time"], series["inclination"]) / np.pi),
        "area_error": series["area_error"][-1],
        "length_error": series["length_error"][-1],
    }
    return summary | {"frames": frames(run, [0, run.time[-1]])} | _cost(series)


def tank_treading(reduced_area: float, chi: float, n: int = 64) -> Case:
    """Return section 5.6 with the default scheme on n^2 cells: rate dt = 0.05, to rate t = 12."""
    rate = shear_rate(reduced_area, chi)
    options = option_file("shear") | QUIET | words(f"-vesicle_reduced_area {reduced_area!r} -flow_rate {rate!r}")
    options |= {"-domain_box": "0,8,0,8"}  # four walls, as in the paper
    del options["-domain_bc_x"]
    options |= grid(n) | words(f"-time_step {0.05 / rate!r} -time_end {12 / rate!r} -output_every {4 / rate!r}")
    return Case(f"tank_treading_{n}_{reduced_area}_{chi}", options, _tank_treading)


def tank_treading_paper(reduced_area: float, chi: float, n: int) -> Case:
    """Return section 5.6 with the paper's method on h = 1/n: rate dt = h/8, to rate t = 12."""
    rate = shear_rate(reduced_area, chi)
    options = option_file("paper/shear") | QUIET | ILU | words(f"-vesicle_angle 20 -flow_rate {rate!r}") | grid(8 * n)
    options |= words(f"-vesicle_reduced_area {reduced_area!r} -time_step {0.125 / n / rate!r}")
    options |= words(f"-time_end {12 / rate!r} -output_every {4 / rate!r}")
    del options["-time_steady_tol"]
    return Case(f"tank_treading_paper_{n}_{reduced_area}_{chi}", options, _tank_treading, may_fail=True)


def _transient(series: Series, folder: Path) -> dict[str, object]:
    run = Run.read(folder)
    angles = [np.round(run.phase_angle(k) / np.pi, 4).tolist() for k in range(len(run.time))]
    every = np.linspace(0, len(series["time"]) - 1, 121).round().astype(int)
    inclination = np.unwrap(2 * series["inclination"][every]) / 2 / np.pi
    return {
        "frames": frames(run, list(run.time)),
        "phase": angles,
        "time": list(series["time"][every]),
        "theta": list(inclination),
    } | _cost(series)


def transient() -> Case:
    """Return Fig 9: V = 0.5, chi = 1, released across the flow, to rate t = 40."""
    rate = shear_rate(0.5, 1)
    case = tank_treading(0.5, 1)
    options = case.options | {"-vesicle_angle": "90", "-time_end": repr(40 / rate), "-output_every": repr(2 / rate)}
    return Case("transient", options, _transient)
