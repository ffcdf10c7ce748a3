"""Run the studies; the paper's are written beside what it printed."""

from __future__ import annotations

from pathlib import Path
from typing import Callable

from studies.common.tables import table, write_csv
from petves.views.plot import dress, new_figure, save_figure
from studies.common.engine import Case, NotRun, Results
from studies.common.paper import ITERATIONS
from studies.common.scenes import CELLS, option_file
from studies.reproduction.convergence import convergence
from studies.reproduction.coupled import coupled_results
from studies.reproduction.ends import cost, end_figure
from studies.reproduction.race import race
from studies.reproduction.runs import decay, energy, energy_start, iterations, sizes
from studies.reproduction.scene_report import channel, equilibrium, tank_treading
from studies.reproduction.scenes import QUIET

TESTS = {
    "none": ("none", "none, relative h^2"),
    "none_absolute": ("none", "none, absolute: L2 norm of the surface divergence below h^2"),
    "ilu": ("ilu", "PCILU, relative h^2"),
    "ilu_absolute": ("ilu", "PCILU, absolute: L2 norm of the preconditioned residual, a tension, below h^2"),
    "tight": ("tight", "PCILU, relative 1e-12"),
}
"""Our stopping tests: the paper's column that each stands beside, and a description."""

ENERGY_CELLS = {True: 32, False: 64}
"""1/h of the energy study, in quick mode or not: dt = h^2 takes 3/h^2 steps."""


def write(
    folder: str | Path, quick: bool = False, ranks: int = 2, only: str | None = None, run: bool = True
) -> list[Path]:
    """Run what is not there yet; write tables and pictures, the page FOLDER.md beside the folder, tables.md and coupled.md
    in it.

    Quick: coarse grids only, minutes. `ranks`: of the split scheme's runs. `only`: "paper" or "coupled". Without `run`
    nothing of the paper's part is run; a section whose runs are missing says so.
    """
    folder = Path(folder)
    written = []
    if only != "coupled":
        written.append(_paper(folder, quick, ranks, run))
    if only != "paper":
        written.append(coupled_results(folder, quick))
    return written


def _paper(folder: Path, quick: bool, ranks: int, run: bool) -> Path:
    """Run the paper's studies; write tables.md and return the page, FOLDER.md beside the folder."""
    results = Results(folder / "results.json", ranks, run)
    first = {
        "Figure 2": lambda: _energy(results, folder, ENERGY_CELLS[quick]),
        "Tables 1 to 3": lambda: _convergence(results, folder, "relax", quick),
        "Table 4": lambda: _iterations(results, folder, "relax", quick),
        "Tables 5 to 7": lambda: _convergence(results, folder, "shear", quick),
        "Table 8": lambda: _iterations(results, folder, "shear", quick),
        "Figure 5": lambda: cost(results, folder, quick),
    }
    second = {
        "Less error in less time": lambda: race(results, folder, quick),
        "Section 5.4": lambda: equilibrium(results, folder, quick),
        "Section 5.5": lambda: channel(results, folder, quick),
        "Section 5.6": lambda: tank_treading(results, folder, quick),
    }
    text = "\n".join([_tables_head(), *_sections(first)]) + "\n"
    (folder / "tables.md").write_text(text.replace(f"]({folder.name}/", "]("))
    path = folder.with_suffix(".md")
    path.write_text("\n".join([_head(quick, ranks, folder.name), *_sections(second)]) + "\n")
    return path


def _sections(sections: dict[str, Callable[[], list[str]]]) -> list[str]:
    """Return the lines of sections; of one whose runs are missing, which."""
    text = []
    for title, lines in sections.items():
        try:
            text += lines()
        except NotRun as missing:
            text.append(f"## {title}\n\nNot run yet: {missing}.\n")
    return text


def _head(quick: bool, ranks: int, name: str) -> str:
    command = "make reproduce QUICK=1" if quick else "make reproduce"
    return (
        "# The paper's scenes, tables and figures, repeated\n\n"
        "The scenes of Ong and Lai, J. Comput. Phys. 408 (2020) 109277, run by two methods: for those who know the paper and want to see\n"
        "which of its numbers hold, and what they cost.\n\n"
        "- *The paper's method* is `-scheme_type split`: kernel ib6, backward Euler, unsteady Stokes flow, PCILU with 200 levels in nested\n"
        "  dissection.\n"
        "- *The default* of petves is what the files of runs/ say: coupled, order 3, near field.\n\n"
        f"This page has sections 5.4 to 5.6. Others have [sections 5.1 to 5.3]({name}/tables.md), [the coupled scheme with the paper's\n"
        f"membrane]({name}/coupled.md), and [iterations of the tension solve]({name}/tension.md) of split.\n\n"
        "h is the side of a cell, V the reduced area, R0 the size, E_B the bending energy ([glossary](glossary.md)). none, unsteady and\n"
        "convective are the [models of inertia](fluid.md#inertia-of-the-fluid).\n\n"
        f"`{command}` writes the page, with split on {ranks} ranks and the default on one. {name}/results.json has every run's options and commit.\n"
    )


def _tables_head() -> str:
    return (
        "# Sections 5.1 to 5.3 of the paper, repeated\n\n"
        "Figures 2 to 5 and Tables 1 to 8 of Ong and Lai (2020), by their method: an ellipse with semi-axes 0.2 and 0.5 in [-1,1]^2 with\n"
        "walls, nu = 1, c_b = 0.01, disturbance form, start with sigma = 0. [reproduction.md](../reproduction.md) says how the page is made.\n"
    )


def _convergence(results: Results, folder: Path, kind: str, quick: bool) -> list[str]:
    """Return Tables 1 to 3 and Fig 3, or Tables 5 to 7 and Fig 4."""
    return convergence(results, folder, kind, quick) + end_figure(results, folder, kind, quick)


def _cells(results: Results, kind: str, quick: bool) -> list[int]:
    """Return the values of 1/h: sizes, and those with runs that are there."""
    there = [n for n in CELLS if any(results.has(case) for case in iterations(kind, n).values())]
    return sorted({*sizes(quick), *there})


def _iterations(results: Results, folder: Path, kind: str, quick: bool) -> list[str]:
    """Tables 4 and 8: mean tension iterations."""
    number, how = {"relax": (4, "Fluid at rest, dt = h/2, t = 1"), "shear": (8, "Shear rate 1, dt = h/4, t = 5")}[kind]
    rows, shown = [], []
    cells = _cells(results, kind, quick)
    cases = {n: iterations(kind, n) for n in cells}
    for test, (column, label) in TESTS.items():
        asked = [n in sizes(quick) or results.has(cases[n][test]) for n in cells]
        found = [results.get(cases[n][test])["tension_its"] if ask else None for n, ask in zip(cells, asked)]
        paper = [ITERATIONS[kind][column][CELLS.index(n)] for n in cells]
        rows += [[f"1/{n}", test, x, y] for n, x, y in zip(cells, found, paper) if x is not None]
        shown.append([label, *(f"not run ({y})" if x is None else f"{x:.1f} ({y})" for x, y in zip(found, paper))])
    write_csv(folder / f"table{number}.csv", ["h", "stopping_test", "tension_its", "paper"], rows)
    about = f"{how}, 1/h markers (2.3 h apart). "
    if kind == "shear":
        about += "Rows as in Table 4.\n"
    else:
        about += (
            "Mean iterations of a tension solve; in brackets the paper's column that the\n"
            "line stands beside. Relative and absolute: of the residual that GMRES sees, preconditioned from the left. L2 norm:\n"
            "(SUM a_k^2 ds)^(1/2) over the edges. These runs say `-tension_ksp_pc_side left`; the program's default is right.\n"
        )
    return [f"## Table {number}: tension iterations\n", about, *table(["", *(f"h = 1/{n}" for n in cells)], shown)]


def _energy(results: Results, folder: Path, n: int) -> list[str]:
    """Figure 2: energy against time for three time steps."""
    figure, (axes,) = new_figure(6, 4)
    shown, rows = [], []
    styles = ("-", "--", ":")
    for (name, case), style in zip(energy(n).items(), styles):
        found = results.get(case)
        axes.plot(found["time"], found["energy"], style, label=rf"$\Delta t = {name}$")
        rows += [[name, t, e] for t, e in zip(found["time"], found["energy"])]
        shown.append([name, *(f"{x:+.2e}" for x in (*found["rise_first_two"], found["rise_later"]))])
    own = results.get(Case("energy_ours", option_file("energy") | QUIET, decay))
    axes.plot(own["time"], own["energy"], "k-", lw=0.8, label="runs/energy.opts")
    shown.append(["runs/energy.opts", *(f"{x:+.2e}" for x in (*own["rise_first_two"], own["rise_later"]))])
    dress(axes, 10, xlabel="time $t$", ylabel="$E/E_0$")
    save_figure(figure, folder / "energy_decay.png")
    write_csv(folder / "energy_decay.csv", ["dt", "time", "energy_over_initial"], rows)
    about = (
        f"Fluid at rest, h = 1/{n}, t = 3, both GMRES solves to 1e-12. Change of E/E_0 in a step; the first two\n"
        "steps start from sigma = 0, which is not the tension of the initial shape.\n"
    )
    lines = table(["dt", "step 1", "step 2", "largest later"], shown)
    picture = f"![E/E_0 against time]({folder.name}/energy_decay.png)\n"
    return ["## Figure 2: energy\n", about, *lines, picture, *_energy_starts(results, n < 64)]


def _energy_starts(results: Results, quick: bool) -> list[str]:
    """Return what the first steps do on finer grids: in quick mode to h = 1/128 and what is there."""
    rows = []
    for n in CELLS:
        for name in ("h", "h/2"):
            case = energy_start(n, name)
            if quick and n > 128 and not results.has(case):
                continue
            one = results.get(case)
            small = [*(f"{x:+.1e}" for x in one["rise"]), f"{one['largest']:+.1e}", str(one["step"])]
            rows.append([f"1/{n}", name, *small, f"{one['peak']:.4f}", f"{one['end']:.4f}"])
    about = (
        "To t = 1/8 by grid. The paper has its energies fall in every step at h = 1/256. Here the split scheme, started from sigma = 0 and\n"
        "with every solve to 1e-12, gains energy in its first steps when dt = h, at h = 1/256 five percent; not when dt = h/2. The proof is for\n"
        "the unsplit scheme. Later the energy falls in every step (h = 1/256, dt = h, t = 1/8 to 3; E/E_0 = 0.8207 at the end).\n"
    )
    header = ["h", "dt", "step 1", "step 2", "step 3", "largest rise", "in step", "largest E/E_0", "E/E_0 at t = 1/8"]
    return [about, *table(header, rows)]
