"""Sweep: the steady inclination in shear against the reduced area, and the line of Keller and Skalak's theory.

Inside and outside fluid being the same, their theory for an ellipse of semi-axes a > b in two dimensions reduces to
cos(2 theta) = (a^2 - b^2)/(a^2 + b^2).
"""

import numpy as np
from common import settings

import petves
from petves.views.plot import new_figure, save_figure
from petves.theory import ellipse_axes, keller_skalak_angle


def steady_angle(reduced_area: float, cells: int, time_end: float) -> float:
    """Return the inclination when the membrane's shape has come to rest, or at `time_end`."""
    with petves.Simulation(
        domain_box=(-2.5, 2.5, -2.5, 2.5),
        domain_cells=(cells, cells),
        flow_type="shear",
        vesicle_area=1,
        vesicle_reduced_area=reduced_area,
        vesicle_angle=20,  # degrees
        vesicle_bending=0.3,
        time_step=0.1,
        time_end=time_end,
        time_steady_tol=1e-3,
        output_every=100,
    ) as sim:
        sim.run()
        return sim.inclination


chosen = settings(__doc__.splitlines()[0])
areas = (0.7, 0.9) if chosen.short else (0.55, 0.65, 0.75, 0.85, 0.95)
angles = [steady_angle(V, *((40, 2) if chosen.short else (64, 15))) for V in areas]
for V, angle in zip(areas, angles):
    print(
        f"V = {V:.2f}   angle/pi: {angle / np.pi:.4f} simulated, {keller_skalak_angle(*ellipse_axes(V)) / np.pi:.4f} theory"
    )

figure, (axes,) = new_figure(6, 4)
line = np.linspace(0.5, 0.995, 60)
axes.plot(line, [keller_skalak_angle(*ellipse_axes(V)) / np.pi for V in line], "k-", label="Keller and Skalak")
axes.plot(areas, np.array(angles) / np.pi, "o", label="petves")
axes.set(xlabel="reduced area $V$", ylabel=r"inclination $\theta/\pi$", ylim=(0, 0.26))
axes.grid(alpha=0.3)
axes.legend(frameon=False)
print(save_figure(figure, chosen.folder / "inclination.png"))
