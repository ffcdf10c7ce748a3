"""Numbers printed by Ong and Lai, J. Comput. Phys. 408 (2020) 109277, for comparison, and targets of other methods."""

from __future__ import annotations

CONVERGENCE = {
    "relax": {
        "u": (8.607e-3, 3.649e-3, 1.698e-3, 6.923e-4),
        "v": (6.878e-3, 3.649e-3, 1.489e-3, 6.296e-4),
        "p": (1.079e-2, 6.405e-3, 3.808e-3, 1.928e-3),
        "X": (2.696e-3, 6.229e-4, 1.565e-4, 3.603e-5),
        "Y": (1.235e-3, 3.045e-4, 8.664e-5, 1.899e-5),
        "sigma": (9.463e-2, 4.700e-2, 2.336e-2, 1.162e-2),
    },
    "shear": {
        "u": (1.657e-2, 6.636e-3, 2.640e-3, 8.427e-4),
        "v": (1.287e-2, 5.215e-3, 2.087e-3, 6.895e-4),
        "p": (1.672e-4, 3.671e-5, 2.253e-5, 1.065e-5),
        "X": (1.239e-2, 5.046e-3, 2.078e-3, 6.881e-4),
        "Y": (1.279e-2, 5.358e-3, 2.205e-3, 7.060e-4),
        "sigma": (3.555e-1, 1.421e-1, 5.859e-2, 2.224e-2),
        "omega": (1.236e-2, 4.706e-3, 1.867e-3, 5.879e-4),
    },
}
"""Tables 1 and 2 (section 5.2), 5, 6 and 7 (section 5.3): L2 differences from the run on h = 1/512."""

TABLE_3 = {
    "area": (2.075e-4, 1.055e-4, 5.363e-5, 2.884e-5),
    "length": (1.132e-4, 1.061e-4, 6.964e-5, 3.989e-5),
}
"""Table 3, section 5.2: |A - A_0|/A_0 and |L - L_0|/L_0 at t = 1."""

TABLE_7 = {
    "area": (4.733e-3, 2.695e-3, 1.410e-3, 7.185e-4),
    "length": (5.362e-3, 2.723e-3, 1.371e-3, 6.880e-4),
}
"""Table 7, section 5.3: |A - A_0|/A_0 and |L - L_0|/L_0 at t = 5."""

ITERATIONS = {
    "relax": {"none": (4.6, 10.1, 20.6, 40.8), "ilu": (2.4, 2.7, 3.0, 3.2), "tight": (8.6, 13.5, 16.1, 16.7)},
    "shear": {"none": (5.2, 11.4, 26.6, 53.6), "ilu": (1.6, 2.2, 3.6, 5.0), "tight": (14.1, 15.5, 18.8, 20.0)},
}
"""Tables 4 (section 5.2) and 8 (section 5.3): mean GMRES iterations of a tension solve, without preconditioner at h^2,
with incomplete LU at h^2, and with it at 1e-12."""

SHEAR = {
    "box": {
        (0.5, 10): (0.08984, 0.23074),
        (0.7, 10): (0.12559, 0.31938),
        (0.9, 10): (0.17441, 0.42761),
        (0.5, 1): (0.08894, 0.23035),
        (0.7, 1): (0.12556, 0.32195),
        (0.9, 1): (0.17438, 0.42836),
    },
    "channel": {
        (0.5, 10): (0.08696, 0.22895),
        (0.7, 10): (0.12343, 0.31665),
        (0.9, 10): (0.17302, 0.42331),
        (0.5, 1): (0.08549, 0.22833),
        (0.7, 1): (0.12324, 0.31901),
        (0.9, 1): (0.17297, 0.42399),
    },
}
"""Steady tank-treading of unit area by (V, chi): inclination over pi and frequency over the shear rate. Box: velocity
(rate y, 0) on all sides of 8 x 8; channel: walls 8 apart. Spectral boundary integrals, uncertainty 2e-5."""

SHEAR_FREE = {
    (0.5, 1): (0.0830489, 0.2298308),
    (0.7, 1): (0.1221917, 0.3216719),
    (0.9, 1): (0.1723600, 0.4282403),
    (0.5, 10): (0.0857897, 0.2304035),
    (0.7, 10): (0.1226758, 0.3192450),
    (0.9, 10): (0.1724349, 0.4275119),
    (0.5, 100): (0.0895693, 0.2227146),
    (0.7, 100): (0.1238375, 0.3142703),
    (0.9, 100): (0.1725456, 0.4268458),
}
"""The same in unbounded Stokes flow, uncertainty 1e-6: the box adds 1 to 7 percent to the angle."""

REST = {
    0.5: (8.69552, 2.731, 0.4466),
    0.6: (7.42166, 2.7019, 0.6534),
    0.7: (6.24184, 2.652, 0.8737),
    0.8: (5.14219, 2.5723, 1.1172),
    0.9: (4.11172, 2.4392, 1.4083),
}
"""Equilibrium in fluid at rest by V: E_B R0/c_b (circle: pi), width and mid height over R0. Spectral boundary
integral."""

RELAXATION = {
    0.25: (0.16394623726346955, 0.19269986244461246, 0.4900953401805742),
    0.5: (0.15918000327362275, 0.18736232689959337, 0.4863058205145576),
    1: (0.15685202410037752, 0.18381877207760294, 0.48228658550843395),
    2: (0.15653076264858798, 0.18440784348750042, 0.4801598322791011),
    3: (0.15652623858506232, 0.18452296051379943, 0.4798971309848963),
}
"""Ellipse (0.2, 0.5), c_b = 0.01, nu = 1 in unbounded quasi-steady Stokes flow, by time: bending energy, half extents
in x and y. Spectral boundary integral."""

POISEUILLE = {0.5: 0.9133, 1: 0.83414, 2: 0.67334, 4: 0.3431, 6: 0.0997}
"""Unbounded quasi-steady Poiseuille flow, Ca = nu u_max R0^4/(c_b L_y^2) = 10, V = 0.7: height of the centroid over R0
by time over nu R0^3/c_b, of an ellipse along the flow released at R0. Two boundary integrals agree to 2e-3."""

PARACHUTE = (1.42892, -5.68062)
"""The same flow, centred, steady: aspect of the second moments, mean velocity minus u_max over c_b/(nu R0^2)."""

BOUNDARY_INTEGRAL_CODES = {
    "libinVes2D (Octave, N = 64)": (200 * 0.106, 6e-5 / 0.122676, None),
    "Ves2Dpy (Python, N = 64)": (46.5, 1 - 0.11970 / 0.122676, 1 - 0.3075 / 0.319245),
    "dense spectral NumPy (N = 96)": (2.0, 1e-5 / 0.122676, None),
}
"""Boundary integral codes on V = 0.7, chi = 10 in unbounded shear, one thread, from an ellipse to steady tank-treading:
seconds, relative errors of inclination and of frequency (None: not stated; 6e-5 and 1e-5 are of the angle over pi). The
first takes 200 steps of rate dt = 0.05. Stated to this project; docs/evidence.md has runs of both."""


def shear_errors(theta: float, omega: float, reduced_area: float, chi: float, box: str = "box") -> tuple[float, float]:
    """Return the relative errors of an inclination over pi and of a frequency over the rate, against SHEAR."""
    exact = SHEAR[box][reduced_area, chi]
    return theta / exact[0] - 1, omega / exact[1] - 1
