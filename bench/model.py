"""Cost model of a coupled step in a channel: counted work times rates fitted to the measurements, and a network."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

LATENCY = 2e-6  # of a message (s)
BANDWIDTH = 1e9  # of a rank (bytes/s): 64 ranks of a node share 64e9
MARKERS = 181 / 512  # a column: the scene of the bench, ds = 1.5 h
REFRESH = 8  # steps that the dense factors last
BYTES = 8


@dataclass
class Scene:
    """A step to predict: n x n cells, vesicles of so many markers each, Stokes solves and iterations a step."""

    n: int
    markers: float
    stokes: float = 3.0
    its: float = 2.0
    vesicles: float = 1.0


@dataclass
class Rates:
    """Seconds a flop of the row solves, a byte of grid data, a flop on the markers."""

    flop: float
    byte: float
    dense: float


def solve_flops(s: Scene) -> float:
    """Flops a cell of one Stokes solve: three row transforms back, two forward once a step, recurrences and stencils."""
    return 2.5 * (3 + 2 / s.stokes) * np.log2(s.n) + 37


def solve_bytes(s: Scene) -> float:
    """Bytes a cell of one Stokes solve: rows read and written by the recurrences, the stencils and the transforms."""
    return 24 * BYTES


def step_bytes(s: Scene) -> float:
    """Bytes a cell of a step outside the solves: history, guess, norms, and the sum of the kept products."""
    return (40 + 5 * s.its) * BYTES


def dense_flops(s: Scene) -> float:
    """Flops on the markers: the factors of R every step, those of N and C every REFRESH steps, their use."""
    m, log = s.markers, np.log2(max(s.markers, 2))
    each = m**3 * (16 / 3 + 14 / REFRESH) + m**2 * (20 * log + (600 + 40 * log) / REFRESH + 22 * (s.its + 1))
    return s.vesicles * each


def fit(measured: list[tuple[Scene, float, float]], byte: float) -> tuple[Rates, float]:
    """Return the rates that come closest to the seconds of fast solves and of the rest, and the largest deviation.

    Parameters
    ----------
    measured : list of (Scene, float, float)
        Seconds a step of the fast solves and of the rest, on one rank.
    byte : float
        Seconds a byte, from copies of an array.
    """
    fast = np.array([[s.stokes * s.n**2 * f(s) for f in (solve_flops, solve_bytes)] for s, _, _ in measured])
    rest = np.array([[dense_flops(s), s.n**2 * step_bytes(s)] for s, _, _ in measured])
    rates, deviation = [], 0.0
    for work, seconds in ((fast, [m[1] for m in measured]), (rest, [m[2] for m in measured])):
        a, b = work[:, 0] / seconds, 1 - work[:, 1] * byte / seconds  # relative
        rates.append(max(float(a @ b / (a @ a)), 0.0))
        deviation = max(deviation, np.abs(a * rates[-1] - b).max())
    return Rates(rates[0], byte, rates[1]), float(deviation)


def parts(s: Scene, r: Rates, ranks: int, layout: str) -> dict[str, float]:
    """Return the seconds a step by cause: the grid's work, the markers', the closing of the slabs' chain, messages.

    Parameters
    ----------
    s, r : Scene, Rates
        What is solved, and how fast.
    ranks : int
        MPI ranks.
    layout : str
        "slab": as it is. "shared": slabs, the work on markers shared by the ranks. "doubling": and the chain of slabs
        closed by recursive doubling. "pencil": shared, rows transposed to columns and back.
    """
    c, w, log = s.n**2 / ranks, s.n + 2, np.log2(max(ranks, 2))
    alone = ranks == 1
    work = c * (s.stokes * (r.flop * solve_flops(s) + r.byte * solve_bytes(s)) + r.byte * step_bytes(s))
    whole = s.vesicles if layout == "slab" else max(1, s.vesicles / ranks)  # vesicles that a rank hears of
    reductions = (s.its + 7) * 2 * log * (LATENCY + 2 * BYTES * whole * s.markers / BANDWIDTH)
    found = {"grid": work, "markers": r.dense * dense_flops(s), "chain": 0.0, "messages": 0.0 if alone else reductions}
    if layout != "slab":
        found["markers"] /= ranks
    if alone:
        return found
    if layout in ("slab", "shared"):
        found["chain"] = (
            s.stokes * r.byte * 60 * BYTES * ranks * w
        )  # two numbers a mode and rank, each rank all of them
        all_of_it = 3 * ranks * (2 * w + s.n / ranks) * BYTES
        found["messages"] += s.stokes * (2 * log * LATENCY + all_of_it / BANDWIDTH)
    elif layout == "doubling":
        found["chain"] = s.stokes * r.byte * 60 * BYTES * log * w
        found["messages"] += s.stokes * log * (2 * LATENCY + 3 * 4 * w * BYTES / BANDWIDTH)
    else:
        found["messages"] += s.stokes * 5 * (np.sqrt(ranks) * LATENCY + c * BYTES / BANDWIDTH)
    return found


def seconds(s: Scene, r: Rates, ranks: int, layout: str) -> float:
    """Return the seconds a step."""
    return sum(parts(s, r, ranks, layout).values())


def finer(n: int) -> Scene:
    """Return the bench's vesicle in its box on n x n cells."""
    return Scene(n, MARKERS * n)


def more(n: int) -> Scene:
    """Return a box of n x n cells that grows, with as many vesicles an area, each as on 512 x 512 cells."""
    return Scene(n, MARKERS * 512, vesicles=(n / 512) ** 2)


def last_useful(n: int, r: Rates, layout: str) -> int:
    """Return the ranks, 64 doubled as long as twice as many are 1.4 times faster, n at most."""
    ranks = 64
    while 2 * ranks <= n and seconds(more(n), r, ranks, layout) > 1.4 * seconds(more(n), r, 2 * ranks, layout):
        ranks *= 2
    return ranks
