"""Cost model of a coupled step in a channel: counted work times rates fitted to the measurements, and a network."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

LATENCY = 2e-6  # of a message (s)
BANDWIDTH = 1e9  # of a rank (bytes/s): 64 ranks of a node share 64e9
MARKERS = 181 / 512  # a column: the scene of the bench, ds = 1.5 h
REFRESH = 8  # steps that the dense factors last
BYTES = 8


@dataclass
class Scene:
    """A step to predict: n x n cells, M markers, Stokes solves and iterations a step."""

    n: int
    markers: float
    stokes: float = 5.0
    its: float = 4.0


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
    return m**3 * (16 / 3 + 14 / REFRESH) + m**2 * (20 * log + (600 + 40 * log) / REFRESH + 22 * (s.its + 1))


def fit(measured: list[tuple[Scene, float, float]]) -> tuple[Rates, float]:
    """Return the rates, none negative, that come closest to seconds of fast solves and of the rest; largest deviation.

    Parameters
    ----------
    measured : list of (Scene, float, float)
        Seconds a step of the fast solves and of the rest, on one rank.
    """
    rows, values = [], []
    for s, fast, rest in measured:
        c = s.n**2
        rows += [
            [s.stokes * c * solve_flops(s), s.stokes * c * solve_bytes(s), 0],
            [0, c * step_bytes(s), dense_flops(s)],
        ]
        values += [fast, rest]
    a = np.array(rows) / np.array(values)[:, None]
    best = None
    for count in (1, 2, 3):
        for columns in combinations(range(3), count):
            x = np.zeros(3)
            x[list(columns)] = np.linalg.lstsq(a[:, columns], np.ones(len(values)), rcond=None)[0]
            error = np.sum((a @ x - 1) ** 2)
            if x.min() >= 0 and (best is None or error < best[0]):
                best = error, x
    return Rates(*best[1]), float(np.abs(a @ best[1] - 1).max())


def parts(s: Scene, r: Rates, ranks: int, layout: str) -> dict[str, float]:
    """Return the seconds a step by cause.

    Parameters
    ----------
    s, r : Scene, Rates
        What is solved, and how fast.
    ranks : int
        MPI ranks.
    layout : str
        "slab": as it is. "doubling": slabs, their chain closed by recursive doubling, marker work shared by the ranks.
        "pencil": rows transposed to columns and back, marker work shared.
    """
    c, w, log = s.n**2 / ranks, s.n + 2, np.log2(max(ranks, 2))
    alone = ranks == 1
    work = c * (s.stokes * (r.flop * solve_flops(s) + r.byte * solve_bytes(s)) + r.byte * step_bytes(s))
    reductions = (s.its + 7) * 2 * log * (LATENCY + 2 * BYTES * s.markers / BANDWIDTH)
    found = {"grid": work, "markers": r.dense * dense_flops(s), "chain": 0.0, "messages": 0.0 if alone else reductions}
    if layout != "slab":
        found["markers"] /= ranks
    if alone:
        return found
    if layout == "slab":
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


def scene(n: int) -> Scene:
    """Return the bench's scene on n x n cells."""
    return Scene(n, MARKERS * n)


def last_efficient(n: int, r: Rates, layout: str, shared: bool) -> int:
    """Return the largest power of two of ranks at which the grid's part alone is half of the step or more.

    shared: leave out the work on markers.
    """
    ranks = 1
    while 2 * ranks <= n:
        p = parts(scene(n), r, 2 * ranks, layout)
        if shared:
            p["markers"] = 0.0
        if p["grid"] < 0.5 * sum(p.values()):
            break
        ranks *= 2
    return ranks
