"""Cost model of a coupled step in a channel: counted work times rates fitted to the measurements, and a network."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

LATENCY = 2e-6  # of a message (s)
BANDWIDTH = 1e9  # of a rank (bytes/s): 64 ranks of a node share 64e9
MARKERS = 181 / 512  # a column: the scene of the bench, ds = 1.5 h
REFRESH = 8  # steps that the dense factors last
BYTES = 8
NEAR = 3e-6  # near field of a marker: placing it, a step (s; half of docs/performance.md, which is of a busy machine)
NEAR_PRODUCT = 0.3e-6  # and its product, an iteration
SORTED = 0.6e-6  # rows and stencils of a marker sorted on every rank, a step (docs/performance.md, A thousand vesicles)


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


def near_seconds(s: Scene) -> float:
    """Seconds of the near field of all markers on one rank."""
    return s.vesicles * s.markers * (NEAR + NEAR_PRODUCT * s.its)


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
    known = np.array([near_seconds(s) + SORTED * s.vesicles * s.markers for s, _, _ in measured])
    for work, seconds, other in ((fast, [m[1] for m in measured], 0), (rest, [m[2] for m in measured], known)):
        a, b = work[:, 0] / seconds, 1 - (work[:, 1] * byte + other) / seconds  # relative
        rates.append(max(float(a @ b / (a @ a)), 0.0))
        deviation = max(deviation, np.abs(a * rates[-1] - b).max())
    return Rates(rates[0], byte, rates[1]), float(deviation)


def parts(s: Scene, r: Rates, ranks: int, layout: str) -> dict[str, float]:
    """Return the seconds a step by cause: the grid's work, the markers', what every rank does of all markers, the closing of
    the slabs' chain, messages.

    Parameters
    ----------
    s, r : Scene, Rates
        What is solved, and how fast.
    ranks : int
        MPI ranks.
    layout : str
        "petves": as it is, slabs of the grid and whole vesicles on ranks. "shared": slabs, a vesicle's dense problem and near
        field divided among ranks, markers known where they are. "doubling": and the chain of slabs closed by recursive
        doubling. "pencil": shared, rows transposed to columns and back.
    """
    c, w, log = s.n**2 / ranks, s.n + 2, np.log2(max(ranks, 2))
    ours, alone = layout == "petves", ranks == 1
    grid = c * (s.stokes * (r.flop * solve_flops(s) + r.byte * solve_bytes(s)) + r.byte * step_bytes(s))
    markers = r.dense * dense_flops(s) + near_seconds(s)
    share = np.ceil(s.vesicles / ranks) / s.vesicles if ours else 1 / ranks
    heard = s.vesicles if ours else max(1, s.vesicles / ranks)  # vesicles that a rank hears of
    found = {"grid": grid, "markers": markers * share}
    found["replicated"] = SORTED * s.vesicles * s.markers / (1 if ours else ranks)
    found |= {"chain": 0.0, "messages": 0.0}
    if alone:
        return found
    found["messages"] = (s.its + 7) * 2 * log * (LATENCY + 2 * BYTES * heard * s.markers / BANDWIDTH)
    if layout in ("petves", "shared"):  # two numbers a mode and rank, each rank all of them
        found["chain"] = s.stokes * r.byte * 60 * BYTES * ranks * w
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
