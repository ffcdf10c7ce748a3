"""Lines that simulations are drawn against."""

import numpy as np


def ellipse_axes(reduced_area: float) -> tuple[float, float]:
    """Return semi-axes a > b = 1/a of the ellipse of area pi; `reduced_area` is V = 4 pi area/perimeter^2, in (0, 1)."""
    angle = np.linspace(0, 2 * np.pi, 512, endpoint=False)
    low, high = 1.0, 1e3
    for _ in range(70):
        a = 0.5 * (low + high)
        perimeter = np.mean(np.hypot(a * np.sin(angle), np.cos(angle) / a)) * 2 * np.pi
        low, high = (a, high) if 4 * np.pi**2 / perimeter**2 > reduced_area else (low, a)
    return low, 1 / low


def keller_skalak_angle(a: float, b: float) -> float:
    """Return the steady inclination (radians) of a tank-treading ellipse in shear, the fluids alike.

    cos(2 theta) = (a^2 - b^2)/(a^2 + b^2): Keller and Skalak, J. Fluid Mech. 120 (1982) 27, in two dimensions.
    """
    return 0.5 * np.arccos((a * a - b * b) / (a * a + b * b))
