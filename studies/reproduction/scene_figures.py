"""The pictures of sections 5.4 to 5.6."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from petves.theory import ellipse_axes
from petves.views.plot import dress, new_figure, save_figure
from studies.common.curves import trigonometric
from studies.common.paper import SHEAR, SHEAR_FREE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TENSION = r"$\sigma R_0^2/c_b$"


def membrane(
    axes: Axes,
    markers: list,
    tension: list,
    limits: tuple[float, float] | None = None,
    shift: float = 0.0,
    before: float = 0.0,
):
    """Draw a smooth closed curve coloured by tension, which is given `before` edges before the markers; return the lines."""
    from matplotlib.collections import LineCollection

    points = np.asarray(markers)
    n = len(points)
    curve = trigonometric(points, 1024) + [shift, 0]
    where = np.arange(1024) / 1024
    along = np.interp(where, (np.arange(-1, n + 2) - before) / n, np.take(tension, np.arange(-1, n + 2), mode="wrap"))
    lines = LineCollection(np.stack([curve, np.roll(curve, -1, axis=0)], axis=1), cmap="coolwarm", lw=2.5)
    lines.set_array(along)
    lines.set_clim(*(limits or (min(tension), max(tension))))
    axes.add_collection(lines)
    axes.autoscale_view()
    axes.set_aspect("equal")
    return lines


def equilibrium(found: dict[float, dict], path: Path) -> Path:
    """Draw Fig 6: first and last shapes by V, with tension."""
    figure, axes = new_figure(13, 3.6, len(found), equal=True)
    for panel, (v, one) in zip(axes, found.items()):
        first = trigonometric(np.asarray(one["frames"]["markers"][0]), 512)
        panel.plot(*np.vstack([first, first[:1]]).T, "k:", lw=1)
        lines = membrane(panel, one["frames"]["markers"][-1], one["frames"]["tension"][-1])
        panel.set(title=f"$V$ = {v}", xlabel="$x$", xlim=(-0.75, 0.75), ylim=(-1.25, 1.25))
        figure.colorbar(lines, ax=panel, location="bottom", shrink=0.9, label=TENSION)
    axes[0].set_ylabel("$y$")
    return save_figure(figure, path)


def channel_strip(found: dict[int, dict], path: Path, spacing: float = 2.0) -> Path:
    """Draw Fig 8: shapes at nine times in the frame of the vesicle, one panel for each c_0."""
    figure, axes = new_figure(11, 11, rows=len(found), equal=True)
    for panel, (offset, one) in zip(axes, found.items()):
        shapes = list(zip(one["frames"]["time"], one["frames"]["markers"], one["frames"]["tension"]))[:9]
        limits = min(min(s[2]) for s in shapes[1:]), max(max(s[2]) for s in shapes[1:])
        for k, (time, markers, tension) in enumerate(shapes):
            middle = float(np.mean(markers, axis=0)[0])
            lines = membrane(panel, markers, tension, limits, spacing * k - middle)
            panel.plot(spacing * k, np.mean(markers, axis=0)[1], "k.", ms=4)
            panel.text(spacing * k, 0.15, f"$t$ = {time:.0f}", ha="center", fontsize=8)
        panel.axhline(3, ls="--", color="gray", lw=0.8)
        panel.set(xlim=(-1.2, 17.2), ylim=(0, 6), ylabel="$y$", title=f"$c_0$ = {('0', '$R_0$', '$-R_0$')[offset]}")
        panel.set_xticks([])
        figure.colorbar(lines, ax=panel, label=TENSION)
    return save_figure(figure, path)


def channel_curves(height: dict[str, dict], slips: dict[str, dict], path: Path) -> Path:
    """Draw height over R_0, and velocity minus u_max over c_b/(nu R_0^2), against time."""
    figure, axes = new_figure(11, 4, 2)
    for label, one in height.items():
        axes[0].plot(one["time"], one["height"], label=label)
    for label, one in slips.items():
        axes[1].plot(one["saved"][1:], one["slip"][1:], label=label)
    for panel, label in zip(axes, (r"$(y_c - 3)/R_0$", r"$(U - u_{\max})\,\nu R_0^2/c_b$")):
        dress(panel, 8, xlabel="time $t$", ylabel=label)
    return save_figure(figure, path)


def transient(one: dict, rate: float, path: Path) -> Path:
    """Draw Fig 9: shapes with a tracked marker at ten times."""
    times = one["frames"]["time"]
    figure, axes = new_figure(13, 5, 5, 2, equal=True)
    for panel, k in zip(axes, (0, 1, 2, 3, 4, 6, 8, 12, 16, len(times) - 1)):
        markers, tension = one["frames"]["markers"][k], one["frames"]["tension"][k]
        lines = membrane(panel, markers, tension, (-17, 1))
        panel.plot(*markers[0], "ko", ms=5)
        middle = float(np.mean(markers, axis=0)[0])
        title = rf"$\dot\gamma t$ = {rate * times[k]:.0f}"
        panel.set(title=title, xlim=(middle - 1.3, middle + 1.3), ylim=(2.7, 5.3))
    figure.colorbar(lines, ax=list(axes), label=TENSION, shrink=0.8)
    return save_figure(figure, path)


def transient_curves(one: dict, rate: float, path: Path) -> Path:
    """Draw Fig 9's tension against the phase angle at late times, and the inclination against time."""
    figure, (last, angle) = new_figure(11, 4, 2)
    for k in (8, 12, 16, len(one["frames"]["time"]) - 1):
        order = np.argsort(one["phase"][k])
        label = rf"$\dot\gamma t$ = {rate * one['frames']['time'][k]:.0f}"
        last.plot(np.asarray(one["phase"][k])[order], np.asarray(one["frames"]["tension"][k])[order], ".-", label=label)
    dress(last, 8, xlabel=r"$\varphi/\pi$", ylabel=TENSION)
    angle.plot(rate * np.asarray(one["time"]), one["theta"])
    dress(angle, xlabel=r"$\dot\gamma t$", ylabel=r"inclination $\theta/\pi$")
    return save_figure(figure, path)


def shapes(found: dict[tuple[float, int], dict], path: Path) -> Path:
    """Draw Fig 10: the steady shapes, a row for each chi, a column for each V."""
    reduced, chis = sorted({v for v, _ in found}), sorted({chi for _, chi in found})
    figure, axes = new_figure(14, 9.5, len(reduced), len(chis), equal=True)
    for panel, (chi, v) in zip(axes, product(chis, reduced)):
        one = found[v, chi]["frames"]
        lines = membrane(panel, one["markers"][-1], one["tension"][-1])
        panel.set(title=rf"$V$ = {v}, $\chi$ = {chi}", xlim=(2.7, 5.3), ylim=(3.0, 5.0))
        figure.colorbar(lines, ax=panel, label=TENSION, location="bottom", aspect=30)
    return save_figure(figure, path)


def keller_skalak(reduced_area: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return inclination over pi and frequency over rate of an ellipse with fixed shape: atan(b/a), a b/(a^2 + b^2)."""
    axes = [ellipse_axes(v) for v in np.ravel(reduced_area)]
    ratio = np.array([b / a for a, b in axes]).reshape(np.shape(reduced_area))
    return np.arctan(ratio) / np.pi, ratio / (1 + ratio**2)


def against_reduced_area(found: dict[tuple[float, int], dict], path: Path) -> Path:
    """Draw Fig 11: inclination and frequency against V, with Keller-Skalak and boundary integral values."""
    figure, axes = new_figure(11, 4.4, 2)
    line = np.linspace(0.45, 0.99, 100)
    for panel, quantity, curve in zip(axes, ("theta", "omega_over_rate"), keller_skalak(line)):
        panel.plot(line, curve, "k-", label="Keller-Skalak, 2-D")
        for chi, mark in zip((1, 10, 100), "os^"):
            points = [(v, one[quantity]) for (v, c), one in found.items() if c == chi]
            panel.plot(*zip(*points), mark, mfc="none", ms=8, label=rf"petves, $\chi$ = {chi}")
        k = quantity != "theta"
        panel.plot([v for v, _ in SHEAR["box"]], [x[k] for x in SHEAR["box"].values()], "r+", label="BI, same box")
        free = [(v, x[k]) for (v, chi), x in SHEAR_FREE.items() if chi == 100]
        panel.plot(*zip(*free), "bx", label=r"BI, unbounded, $\chi$ = 100")
        dress(panel, 8, xlabel="reduced area $V$", ylabel=(r"$\theta/\pi$", r"$\omega/\dot\gamma$")[k])
    return save_figure(figure, path)
