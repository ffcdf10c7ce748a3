"""Run the studies; the paper's are written beside what it printed."""

from __future__ import annotations

from pathlib import Path

from petves.coupled_report import coupled_results
from petves.paper import CELLS, ITERATIONS, TABLE_7
from petves.plot import new_figure, save_figure
from petves.run import RunError
from petves.studies import Results, energy, iterations, sizes, table_7
from petves.tables import table, write_csv

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


def reproduce(folder: str | Path, quick: bool = False, ranks: int = 2, only: str | None = None) -> list[Path]:
    """Run what is not there yet, then write the tables and the pictures.

    Parameters
    ----------
    folder : str or Path
        Where results.json, coupled.json, the CSV tables, pictures, reproduction.md and coupled.md go.
    quick : bool
        Coarse grids only: minutes, not hours.
    ranks : int
        MPI ranks of the paper's studies.
    only : "paper" or "coupled", optional
        One of the two groups of studies.

    Returns
    -------
    list of Path
        reproduction.md, coupled.md.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RunError(f"{folder}: cannot be made ({error.strerror})") from None
    written = []
    if only != "coupled":
        written.append(_paper(folder, quick, ranks))
    if only != "paper":
        written.append(coupled_results(folder, quick, ranks))
    return written


def _paper(folder: Path, quick: bool, ranks: int) -> Path:
    """Run the paper's studies; return reproduction.md."""
    results = Results(folder / "results.json", ranks)
    text = [_head(quick, ranks)]
    for kind in ("relax", "shear"):
        text += _iterations(results, folder, kind, quick)
    text += _conservation(results, folder, quick)
    text += _energy(results, folder, ENERGY_CELLS[quick])
    path = folder / "reproduction.md"
    path.write_text("\n".join(text) + "\n")
    return path


def _head(quick: bool, ranks: int) -> str:
    command = "make reproduce QUICK=1" if quick else "make reproduce"
    return (
        "# The paper's studies, repeated\n\n"
        "Ong and Lai, J. Comput. Phys. 408 (2020) 109277, beside petves, `-scheme_type split`. Ellipse with semi-axes\n"
        "0.2 and 0.5 in [-1,1]^2 with walls, nu = 1, c_b = 0.01, kernel ib6, disturbance form, start with sigma = 0.\n"
        f"Written by `{command}` on {ranks} ranks; results.json holds every run's options.\nPCILU: 200 levels, ordering nd.\n"
    )


def _conservation(results: Results, folder: Path, quick: bool) -> list[str]:
    """Table 7: shear, dt = h/4, t = 5."""
    rows, shown = [], []
    for n in sizes(quick):
        found = results.get(table_7(n))
        area, length = abs(found["area_error"]), abs(found["length_error"])
        paper = [TABLE_7[name][CELLS.index(n)] for name in ("area", "length")]
        rows.append([f"1/{n}", area, paper[0], length, paper[1]])
        text = [f"{area:.4e}", f"{paper[0]:.3e}", f"{100 * (area / paper[0] - 1):+.1f} %"]
        text += [f"{length:.4e}", f"{paper[1]:.3e}", f"{100 * (length / paper[1] - 1):+.1f} %"]
        shown.append([f"1/{n}", *text])
    write_csv(folder / "table7.csv", ["h", "area_error", "area_paper", "length_error", "length_paper"], rows)
    about = (
        "Shear rate 1, dt = h/4, t = 5, markers 1.5 h apart (50, 98, 196, 392), both GMRES solves to 1e-12, relative.\n"
    )
    header = ["h", "area error", "paper", "difference", "length error", "paper", "difference"]
    return ["## Table 7: area and length\n", about, *table(header, shown)]


def _iterations(results: Results, folder: Path, kind: str, quick: bool) -> list[str]:
    """Tables 4 and 8: mean tension iterations."""
    number, how = {"relax": (4, "Fluid at rest, dt = h/2, t = 1"), "shear": (8, "Shear rate 1, dt = h/4, t = 5")}[kind]
    rows, shown = [], []
    cases = {n: iterations(kind, n) for n in sizes(quick)}
    for test, (column, label) in TESTS.items():
        found = [results.get(cases[n][test])["tension_its"] for n in sizes(quick)]
        paper = [ITERATIONS[kind][column][CELLS.index(n)] for n in sizes(quick)]
        rows += [[f"1/{n}", test, x, y] for n, x, y in zip(sizes(quick), found, paper)]
        shown.append([label, *(f"{x:.1f} ({y})" for x, y in zip(found, paper))])
    write_csv(folder / f"table{number}.csv", ["h", "stopping_test", "tension_its", "paper"], rows)
    about = (
        f"{how}, 1/h markers (2.3 h apart). Mean iterations of a tension solve; in brackets the paper's column that the\n"
        "line stands beside. Relative and absolute: of the residual that GMRES sees, preconditioned from the left. L2 norm:\n"
        "(SUM a_k^2 ds)^(1/2) over the edges. These runs say `-tension_ksp_pc_side left`; the program's default is right.\n"
    )
    return [
        f"## Table {number}: tension iterations\n",
        about,
        *table(["", *(f"h = 1/{n}" for n in sizes(quick))], shown),
    ]


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
    axes.set(xlabel="time $t$", ylabel="$E/E_0$")
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    save_figure(figure, folder / "energy_decay.png")
    write_csv(folder / "energy_decay.csv", ["dt", "time", "energy_over_initial"], rows)
    about = (
        f"Fluid at rest, h = 1/{n}, t = 3, both GMRES solves to 1e-12. Change of E/E_0 in a step; the first two\n"
        "steps start from sigma = 0, which is not the tension of the initial shape.\n"
    )
    lines = table(["dt", "step 1", "step 2", "largest later"], shown)
    return ["## Figure 2: energy\n", about, *lines, "![E/E_0 against time](energy_decay.png)\n"]
