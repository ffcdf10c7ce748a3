"""Cost model of a coupled step in a channel: counted work times rates fitted to the measurements, and a network."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

LATENCY = 2e-6  # of a message (s)
BANDWIDTH = 1e9  # of a rank (bytes/s): 64 ranks of a node share 64e9
MARKERS = 137 / 512  # a column: the scene of the bench, ds = 1.9 h
ROWS = 0.15  # part of all rows that membranes reach: the bench's vesicle with its stencils
COLUMNS = 0.25  # and of the columns, within which forces are cleared, spread and squared
FELT = 0.3  # of the modes above and below them, that feel a force there
BYTES = 8
SORTED = 0.6e-6  # rows and stencils of a marker sorted on every rank, a step (docs/evidence.md, A thousand vesicles)


@dataclass
class Scene:
    """A step to predict: n x n cells, vesicles of so many markers each, iterations a step, part of the rows with membranes."""

    n: int
    markers: float
    its: float = 1.0
    vesicles: float = 1.0
    rows: float = ROWS

    @property
    def felt(self) -> float:
        """Part of the modes of all rows that a solve of the membranes' forces alone goes through."""
        return self.rows + FELT * (1 - self.rows)

    @property
    def all_markers(self) -> float:
        """Markers of all vesicles."""
        return self.vesicles * self.markers


@dataclass
class Rates:
    """Seconds a flop of the solves, a byte of grid data, a step whatever its size, a marker's own work, an operation of the
    dense problem."""

    flop: float
    byte: float
    step: float
    marker: float
    dense: float


def solve_flops(s: Scene) -> float:
    """Flops a cell of a step's solves: the sum of the states before, its curl and the recurrences of the first, those of the
    further ones, and two transforms of the membranes' rows in each."""
    return 30 + 12 * s.its * s.felt + (s.its + 1) * 5 * s.rows * np.log2(s.n)


def solve_bytes(s: Scene) -> float:
    """Bytes a cell: three states read, y written and read three times, the flow written; in a further solve y and the flow
    where they are felt; the membranes' rows of forces."""
    return BYTES * (3 + 4 + 1 + 4 * s.its * s.felt + 2 * s.rows)


def step_bytes(s: Scene) -> float:
    """Bytes a cell of a step outside the solves: forces cleared, spread and squared in the membranes' window."""
    return BYTES * 4 * s.rows * (COLUMNS if s.vesicles == 1 else 1)


def dense_operations(s: Scene) -> float:
    """Products of the dense problem's factors and of the near field, M^2 each."""
    return s.vesicles * s.markers**2 * (s.its + 1)


def fit(measured: list[tuple[Scene, float, float]], byte: float) -> tuple[Rates, float]:
    """Return the rates that come closest to the seconds of fast solves and of the rest, and the largest deviation.

    Parameters
    ----------
    measured : list of (Scene, float, float)
        Seconds a step of the fast solves and of the rest, on one rank.
    byte : float
        Seconds a byte, from copies of an array.
    """
    scenes, fast, rest = ([m[k] for m in measured] for k in range(3))
    cells = np.array([s.n**2 for s in scenes], float)
    grid = np.array([[c * solve_flops(s)] for s, c in zip(scenes, cells)])
    moved = cells * byte * np.array([solve_bytes(s) for s in scenes])
    flop, off = _closest(grid, np.array(fast), moved)
    work = np.array([[1, s.all_markers, dense_operations(s)] for s in scenes], float)
    markers = np.array([s.all_markers for s in scenes])
    known = cells * byte * np.array([step_bytes(s) for s in scenes]) + SORTED * markers
    (step, marker, dense), more = _closest(work, np.array(rest), known)
    return Rates(float(flop[0]), byte, float(step), float(marker), float(dense)), max(off, more)


def _closest(work: np.ndarray, seconds: np.ndarray, known: np.ndarray) -> tuple[np.ndarray, float]:
    """Return rates not below zero with work @ rates + known close to the seconds, relatively, and the largest deviation: a
    rate that would be negative is left out."""
    a, b = work / seconds[:, None], 1 - known / seconds
    scale = np.abs(a).max(axis=0)
    kept = np.full(len(scale), True)
    while True:
        rates = np.zeros(len(scale))
        rates[kept] = np.linalg.lstsq(a[:, kept] / scale[kept], b, rcond=None)[0] / scale[kept]
        if not (rates < 0).any():
            return rates, float(np.abs(a @ rates - b).max())
        kept &= rates >= 0


def _all_to_all(ranks: int, numbers: float) -> float:
    """Return the seconds in which each rank sends so many numbers, shared out among all: one by one, or in log2(ranks) rounds."""
    sent, rounds = numbers * BYTES / BANDWIDTH, np.log2(ranks)
    return min((ranks - 1) * LATENCY + sent, rounds * (LATENCY + sent / 2))


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
        field divided among ranks, markers known where they are. "pencil": shared, the membranes' rows transposed to columns
        and back.
    """
    solves, c, w, log = s.its + 1, s.n**2 / ranks, s.n + 2, np.log2(max(ranks, 2))
    ours, alone = layout == "petves", ranks == 1
    grid = c * (r.flop * solve_flops(s) + r.byte * (solve_bytes(s) + step_bytes(s)))
    markers = r.marker * s.all_markers + r.dense * dense_operations(s)
    share = np.ceil(s.vesicles / ranks) / s.vesicles if ours else 1 / ranks
    heard = s.all_markers if ours else max(s.markers, s.all_markers / ranks)  # markers that a rank hears of
    found = {"grid": grid, "markers": r.step + markers * share}
    found["replicated"] = SORTED * s.all_markers / (1 if ours else ranks)
    found |= {"chain": 0.0, "messages": 0.0}
    if alone:
        return found
    found["messages"] = (s.its + 7) * 2 * log * (LATENCY + 2 * BYTES * heard / BANDWIDTH)
    if layout in ("petves", "shared"):  # four numbers a mode to the rank that closes it, and back
        found["chain"] = solves * r.byte * 60 * BYTES * w
        found["messages"] += solves * (
            2 * _all_to_all(ranks, 4 * w) + 2 * log * LATENCY + 2 * ranks * BYTES / BANDWIDTH
        )
        found["messages"] += 2 * (LATENCY + w * BYTES / BANDWIDTH)  # the rows next to a slab
    else:
        found["messages"] += solves * 2 * (np.sqrt(ranks) * LATENCY + s.rows * c * BYTES / BANDWIDTH)
    return found


def seconds(s: Scene, r: Rates, ranks: int, layout: str) -> float:
    """Return the seconds a step."""
    return sum(parts(s, r, ranks, layout).values())


def finer(n: int) -> Scene:
    """Return the bench's vesicle in its box on n x n cells."""
    return Scene(n, MARKERS * n)


def more(n: int) -> Scene:
    """Return a box of n x n cells that grows, with as many vesicles an area, each as on 512 x 512 cells; membranes are in all
    rows, and a step takes more iterations (docs/evidence.md, A thousand vesicles).
    """
    return Scene(n, MARKERS * 512, its=6, vesicles=(n / 512) ** 2, rows=1)


def last_useful(n: int, r: Rates, layout: str) -> int:
    """Return the ranks, 64 doubled as long as twice as many are 1.4 times faster, n at most."""
    ranks = 64
    while 2 * ranks <= n and seconds(more(n), r, ranks, layout) > 1.4 * seconds(more(n), r, 2 * ranks, layout):
        ranks *= 2
    return ranks
