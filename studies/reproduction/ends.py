"""Figs 3 and 4, the ends of the runs of sections 5.2 and 5.3, and Fig 5, what a step costs."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.run import Run
from studies.common.tables import table, write_csv
from petves.views.plot import dress, new_figure, save_figure
from studies.common.curves import about_centroid
from studies.common.engine import Case, Results
from studies.common.scenes import option_file, split_options
from studies.reproduction.convergence import finest, split_state
from studies.reproduction.runs import iterations
from studies.reproduction.scene_figures import membrane
from studies.reproduction.scenes import QUIET

SETTINGS = {"relax": "relax", "shear": "shear_convergence"}
BLOCKS, ARROWS = 128, 16  # of the fields that are kept, a side
COST_STEPS = {32: (100, 500), 64: (50, 250), 128: (10, 50), 256: (4, 16), 512: (2, 6)}
LABELS = {"none": "none, $h^2$", "ilu": "PCILU, $h^2$", "tight": "PCILU, $10^{-12}$"}


def end_figure(results: Results, folder: Path, kind: str, quick: bool) -> list[str]:
    """Draw Fig 3 (relax) or 4 (shear): the membrane with tension, tension against the phase angle; in shear the flow too."""
    n = min(256, finest(results, kind, quick))
    name = f"figure_{kind}_{n}"
    theirs = results.derive(name, split_options(kind, n), lambda: _kept(split_state(results, kind, n)))
    ours = results.get(Case(f"figure_{kind}_ours", option_file(SETTINGS[kind]) | QUIET, _ours))
    number = {"relax": 3, "shear": 4}[kind]
    figure, (left, right) = new_figure(12, 5.2 if kind == "shear" else 4.6, 2)
    if kind == "shear":
        edges = np.linspace(-1, 1, BLOCKS + 1)
        pressure = np.asarray(theirs["p"])
        high = np.abs(pressure).max()
        mesh = left.pcolormesh(edges, edges, pressure, cmap="RdBu_r", vmin=-high, vmax=high, rasterized=True)
        figure.colorbar(mesh, ax=left, label="pressure $p$", location="bottom", shrink=0.6)
        at = (np.arange(ARROWS) + 0.5) * 2 / ARROWS - 1
        left.quiver(at, at, theirs["u"], theirs["v"], scale=14, width=0.003)
    lines = membrane(left, theirs["markers"], theirs["tension"], before=0.5)
    figure.colorbar(lines, ax=left, label=r"tension $\sigma$")
    limits = (-1, 1) if kind == "shear" else (-0.6, 0.6)
    left.set(xlabel="$x$", ylabel="$y$", xlim=limits, ylim=limits, xticks=np.linspace(*limits, 5))
    right.plot(*_against_phase(theirs), "-", label=f"the paper's method, $h$ = 1/{n}")
    right.plot(*ours["curve"], ".", label=f"runs/{SETTINGS[kind]}.opts")
    dress(right, 8, xlabel=r"$\varphi/\pi$", ylabel=r"tension $\sigma$", xlim=(-1, 1))
    path = save_figure(figure, folder / f"fig{number}_{kind}.png")
    return [f"![Fig {number}: the membrane at the end, its tension]({folder.name}/{path.name})\n"]


def _kept(state: dict[str, np.ndarray]) -> dict[str, object]:
    """Return what the figure needs of a state, rounded."""
    found: dict[str, object] = {"markers": np.round(state["markers"], 5).tolist()}
    found["tension"] = np.round(state["tension"], 4).tolist()
    for name, size in (("p", BLOCKS), ("u", ARROWS), ("v", ARROWS)):
        block = len(state[name]) // size
        found[name] = np.round(state[name].reshape(size, block, size, block).mean(axis=(1, 3)), 3).tolist()
    return found


def _ours(_: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
    run = Run.read(folder)
    angle = run.phase_angle(-1) / np.pi
    order = np.argsort(angle)
    return {"curve": [np.round(x[order], 4).tolist() for x in (angle, run.tension[-1])]}


def _against_phase(one: dict[str, list]) -> tuple[np.ndarray, np.ndarray]:
    """Return the phase angle of the edges' midpoints over pi, in order, and the tension there."""
    points = np.asarray(one["markers"])
    middle = (points + np.roll(points, 1, axis=0)) / 2 - points + about_centroid(points)
    angle = np.arctan2(middle[:, 1], middle[:, 0]) / np.pi
    order = np.argsort(angle)
    return angle[order], np.asarray(one["tension"])[order]


def cost(results: Results, folder: Path, quick: bool) -> list[str]:
    """Draw Fig 5: seconds a step, and of all steps to t = 5, against the number of cells."""
    cells = [n for n in COST_STEPS if not quick or n < 512 or f"cost_{n}_none_2" in results.entries]
    size = np.array([4 * n**2 for n in cells])
    found = {name: [_cost(results, n, name) for n in cells] for name in LABELS}
    step = {name: [seconds for seconds, _ in pairs] for name, pairs in found.items()}
    figure, panels = new_figure(11, 4.4, 2)
    for panel, count, power in zip(panels, (np.ones(len(cells)), 20 * np.array(cells)), (1, 1.5)):
        for (name, label), mark in zip(LABELS.items(), "os^"):
            panel.loglog(size, np.array(step[name]) * count, mark + "-", mfc="none", label=label)
        line = size**power * np.log(size)
        label = r"$N\log N$" if power == 1 else r"$N^{3/2}\log N$"
        panel.loglog(size, line / line[-1] * step["ilu"][-1] * count[-1], "k--", label=label)
        of = "a step" if power == 1 else "of all steps to $t$ = 5"
        dress(panel, 8, xlabel="cells $N$", ylabel=f"CPU seconds {of}")
    save_figure(figure, folder / "fig5_cost.png")
    rows = [[LABELS[k].replace("$", ""), *(f"{s:.4f}, {count:.0f}" for s, count in row)] for k, row in found.items()]
    write_csv(folder / "fig5_cost.csv", ["cells", *step], [[a, *b] for a, b in zip(size, zip(*step.values()))])
    about = (
        "Section 5.3 with 1/h markers, one rank, a shared machine. Processor seconds, and scalar fast solves, of a step near the start (a\n"
        "late one has fewer: the bending solve has less to do): of a longer run less a shorter one. In all: times 5/dt, so N^(3/2) log N\n"
        "where a step costs N log N; the paper calls both linearithmic. A step costs more than that by the solves that it needs.\n"
    )
    head = ["", *(f"{2 * n}^2" for n in cells)]
    return [
        "## Figure 5: cost\n",
        about,
        *table(head, rows),
        f"![Seconds against cells]({folder.name}/fig5_cost.png)\n",
    ]


def _cost(results: Results, n: int, name: str) -> tuple[float, float]:
    """Return the processor time and the fast solves of a step: of a longer run less a shorter one."""
    found = []
    for steps in COST_STEPS[n]:
        options = iterations("shear", n)[name].options | {"-time_end": repr(steps * 0.25 / n)}
        case = Case(f"cost_{n}_{name}_{steps}", options, lambda series, _: {"solves": series["nsolve"].sum()})
        found.append(results.get(case))
    first, last = COST_STEPS[n]
    return tuple((found[1][key] - found[0][key]) / (last - first) for key in ("cpu_seconds", "solves"))
