"""The exact unsteady flow around a circle that swings about its middle."""

import numpy as np


def swinging_torque(radius, outer, omega):
    """The amplitude of the torque on a circle that swings with exp(i omega t) at speed r, viscosity 1, of the fluid
    up to a circle at rest and of that inside: u'' + u'/r - u/r^2 = i omega u by Chebyshev's points."""
    n = 40
    x = np.cos(np.pi * np.arange(n + 1) / n)
    c = np.r_[2, np.ones(n - 1), 2] * (-1.0) ** np.arange(n + 1)
    D = np.outer(c, 1 / c) / (np.subtract.outer(x, x) + np.eye(n + 1))
    D -= np.diag(D.sum(1))
    total = 0
    for low, high in ((radius, outer), (1e-3 * radius, radius)):
        r, d = low + (high - low) * (x + 1) / 2, 2 * D / (high - low)
        A = (d @ d + d / r[:, None] - np.diag(1 / r**2 + 1j * omega)).astype(complex)
        A[0], A[n] = np.eye(n + 1)[[0, n]]
        b = np.zeros(n + 1, complex)
        inner = high == radius
        b[0 if inner else n] = radius
        slope = (d @ np.linalg.solve(A, b))[0 if inner else n]
        total += (-1 if inner else 1) * 2 * np.pi * radius**2 * (slope - 1)
    return total
