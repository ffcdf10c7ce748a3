"""Closed curves through equally spaced labels, by their Fourier series."""

from __future__ import annotations

import numpy as np


def trigonometric(values: np.ndarray, count: int, shift: float = 0.0) -> np.ndarray:
    """Return the trigonometric polynomial through periodic values, at other labels.

    Parameters
    ----------
    values : ndarray, shape (n, ...)
        Values at the labels 0, 1, ..., n - 1 of the period n.
    count : int
        How many values are returned, at least n: at the labels k n/count.
    shift : float
        Added to the labels, in units of the spacing of `values`.

    Returns
    -------
    ndarray, shape (count, ...)
        The polynomial of least degree; with n even the cosine of n/2 waves has no phase.
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
