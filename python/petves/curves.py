"""Curves through markers, by Fourier series, and the closed outlines of obstacles whose own curves are not closed."""

import numpy as np

KINDS = ("closed", "spanning", "open")  # as run.h5 numbers them
FARTHEST = 6  # spacings between the last marker of an open curve and its wall


def trigonometric(values: np.ndarray, count: int, shift: float = 0.0) -> np.ndarray:
    """Return the trigonometric polynomial of least degree through periodic values, at other labels.

    `values`, shape (n, ...), are at the labels 0, 1, ..., n - 1 of the period n. The result, shape (count, ...) with count at
    least n, is at the labels shift + k n/count. With n even the cosine of n/2 waves has no phase.
    """
    n = len(values)
    modes = np.fft.rfft(values, axis=0)
    if n % 2 == 0 and count > n:
        modes[-1] *= 0.5  # its other half is at minus n/2
    waves = np.arange(len(modes)).reshape(-1, *[1] * (values.ndim - 1))
    return np.fft.irfft(modes * np.exp(2j * np.pi * waves * shift / n), count, axis=0) * (count / n)


def smooth_curve(points: np.ndarray, fold: int) -> np.ndarray:
    """Return the closed curve through points (n, 2): `fold` places for each, the first repeated at the end."""
    smooth = trigonometric(points, fold * len(points))
    return np.vstack([smooth, smooth[:1]])


def open_curve(points: np.ndarray, fold: int) -> np.ndarray:
    """Return points (fold (n - 1) + 1, 2) on the open curve through n points: a sine series about its chord."""
    chord, count = np.linspace(points[0], points[-1], len(points)), fold * (len(points) - 1)
    away = points - chord
    around = np.vstack([away, -away[-2:0:-1]])
    return trigonometric(around, 2 * count)[: count + 1] + np.linspace(points[0], points[-1], count + 1)


def _to_wall(three: np.ndarray, axis: int, wall: float, fold: int) -> np.ndarray:
    """Return places from the last of three points on along their parabola, to a wall or to where it is nearest to it."""
    first, middle, last = three
    at = np.arange(FARTHEST * fold + 1)[:, None] / fold
    places = last + at * (3 * last - 4 * middle + first) / 2 + at**2 * (first - 2 * middle + last) / 2
    away = (places[:, axis] - wall) * np.sign(last[axis] - wall)
    count = np.argmax(away <= 0) if (away <= 0).any() else np.argmin(away)
    places[count:, axis] = wall
    return places[: max(count, 1) + 1]


def spanning_curve(points: np.ndarray, span: np.ndarray, fold: int) -> np.ndarray:
    """Return points (fold n + 1, 2) on a curve through n points that goes on after `span`."""
    n = len(points)
    smooth = trigonometric(points - span * np.arange(n)[:, None] / n, fold * n)
    smooth += span * np.arange(fold * n)[:, None] / (fold * n)
    return np.vstack([smooth, smooth[:1] + span])


def span_of(points: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Return the period, shape (2,), that a spanning curve with these markers takes."""
    run = points[-1] - points[0]
    axis = int(np.argmax(np.abs(run)))
    span = np.zeros(2)
    span[axis] = np.copysign(box[2 * axis + 1] - box[2 * axis], run[axis])
    return span


def solid_outline(curves: list[np.ndarray], kinds: list[str], k: int, box: np.ndarray, fold: int) -> np.ndarray:
    """Return the closed outline, shape (m + 1, 2), of the solid at curve k: counter-clockwise, clockwise around fluid.

    An open curve is closed by its wall, a spanning one by the next spanning curve on its left that runs the other way, or
    by the side of the box.
    """
    points = curves[k]
    if kinds[k] == "closed":
        return smooth_curve(points, fold)
    if kinds[k] == "open":
        curve = open_curve(points, fold)
        ends = curve[[0, -1]]
        side = int(np.argmin([np.abs(ends[:, side // 2] - box[side]).max() for side in range(4)]))
        begin, end = (_to_wall(three, side // 2, box[side], fold) for three in (points[2::-1], points[-3:]))
        return np.vstack([begin[:0:-1], curve, end[1:], begin[-1:]])
    span = span_of(points, box)
    curve = spanning_curve(points, span, fold)
    across = int(span[0] != 0)  # the direction from one such curve to the next
    left = np.sign(span[0]) if across else -np.sign(span[1])
    others = [c for c, kind in zip(curves, kinds) if kind == "spanning" and np.dot(span_of(c, box), span) < 0]
    away = {left * (other[:, across].mean() - points[:, across].mean()): other for other in others}
    if beyond := [distance for distance in away if distance > 0]:
        other = away[min(beyond)]
        back = spanning_curve(other, span_of(other, box), fold)
        back[:, 1 - across] += curve[-1, 1 - across] - back[0, 1 - across]
    else:
        back = curve[::-1].copy()
        back[:, across] = box[2 * across + (left > 0)]
    return np.vstack([curve, back, curve[:1]])
