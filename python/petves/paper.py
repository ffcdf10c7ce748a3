"""Numbers printed by Ong and Lai, J. Comput. Phys. 408 (2020) 109277, for comparison, and targets of other methods."""

from __future__ import annotations

CELLS = (32, 64, 128, 256)
"""1/h of the columns below."""

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
