"""Numbers printed by Ong and Lai, J. Comput. Phys. 408 (2020) 109277, for comparison."""

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
