"""Custom flow: an extension whose axis turns. The vesicle follows the axis at a distance.

u_inf = rate (cos(2 w t) x + sin(2 w t) y, sin(2 w t) x - cos(2 w t) y) is a potential flow at every time, so it solves
the unsteady Stokes equations exactly.
"""

import numpy as np
from common import settings

import petves
from petves.views.plot import new_figure, save_figure

chosen = settings(__doc__.splitlines()[0])
RATE, TURN = 0.5, 0.2


def flow(x: np.ndarray, y: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Return u and v at the points x, y at time t."""
    c, s = RATE * np.cos(2 * TURN * t), RATE * np.sin(2 * TURN * t)
    return c * x + s * y, s * x - c * y


with petves.Simulation(
    flow=flow,
    domain_box=(-2, 2, -2, 2),
    domain_cells=(40, 40) if chosen.short else (80, 80),
    vesicle_area=1,
    vesicle_reduced_area=0.75,
    vesicle_bending=0.1,
    time_step=0.05,
    time_end=1 if chosen.short else 8,
    output_every=100,
) as sim:
    sim.run()
    time, angle = sim.history["time"], np.unwrap(sim.history["inclination"], period=np.pi)

lag = TURN * time[-1] - angle[-1]
print(f"after t = {time[-1]:.3g} the vesicle lies {lag:.3f} rad behind the axis of extension")
figure, (axes,) = new_figure(6, 4)
axes.plot(time, TURN * time, "k--", label="axis of extension")
axes.plot(time, angle, label="vesicle")
axes.set(xlabel="time $t$", ylabel="angle (radians)")
axes.grid(alpha=0.3)
axes.legend(frameon=False)
print(save_figure(figure, chosen.folder / "custom_flow.png"))
