"""Two vesicles pass each other in shear flow: each is pushed off its streamline."""

import numpy as np
from common import settings

import petves
from petves.views.plot import new_figure, save_figure

chosen = settings(__doc__)
centers, outlines = [], []


def look(sim: petves.Simulation) -> None:
    """Keep the centres of every step and the outlines of some."""
    centers.append([sim.each("center_x"), sim.each("center_y")])
    if sim.steps % 60 == 1:
        outlines.append(sim.markers.copy())


with petves.Simulation(
    domain_box=(-4, 4, -2, 2),
    domain_cells=(64, 32) if chosen.short else (160, 80),
    domain_bc_x="periodic",
    flow_type="shear",
    vesicle_count=2,
    vesicle_center=(-1.6, 0.4, 1.6, -0.4),
    vesicle_angle=25,
    vesicle_area=0.6,
    vesicle_reduced_area=0.85,
    vesicle_bending=0.1,
    time_step=0.05,
    time_end=0.5 if chosen.short else 8,
    output_every=100,
) as sim:
    sim.run(callback=look)
    start = sim.start

x, y = np.array(centers).transpose(1, 2, 0)  # [vesicle, step]
print(f"offset across the flow: {y[0, 0] - y[1, 0]:.3f} before, {y[0, -1] - y[1, -1]:.3f} at t = {sim.time:g}")
figure, (axes,) = new_figure(8, 4)
for v, color in enumerate(("C0", "C1")):
    axes.plot(x[v], y[v], "-", color=color, lw=2, label=f"centre of vesicle {v + 1}")
    for outline in outlines:
        ring = outline[start[v] : start[v + 1]]
        axes.plot(*np.vstack([ring, ring[:1]]).T, "-", color=color, lw=0.7, alpha=0.5)
axes.set(xlabel="$x$ (length)", ylabel="$y$ (length)", aspect="equal")
axes.legend(frameon=False)
print(save_figure(figure, chosen.folder / "two_vesicles.png"))
