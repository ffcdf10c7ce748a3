"""A sheared suspension: two kinds of vesicles packed at random into a channel, how they align, and a film of it."""

import numpy as np
from common import settings

import petves
from petves.views.movie import movie
from petves.views.plot import new_figure, save_figure

chosen = settings(__doc__)
folder = chosen.folder / "suspension"
order = []


def look(sim: petves.Simulation) -> None:
    """Keep the mean of exp(2 i angle) over all vesicles: its size says how well they are aligned."""
    order.append(np.exp(2j * sim.each("inclination")).mean())


with petves.Simulation(
    domain_box=(0, 6, 0, 4) if chosen.short else (0, 12, 0, 6),
    domain_cells=(72, 48) if chosen.short else (192, 96),
    domain_bc_x="periodic",
    flow_type="shear",
    flow_center_y=2 if chosen.short else 3,
    fluid_inertia="none",
    vesicle_packing=0.3,  # area fraction: the number of vesicles follows
    vesicle_mixture=(0.75, 0.25),  # three floppy ones for each small and round one
    vesicle_area=(1, 0.5),
    vesicle_reduced_area=(0.7, 0.9),
    vesicle_bending=(0.1, 1),
    vesicle_markers=32,
    time_step=0.05,
    time_end=0.2 if chosen.short else 6,
    output_every=0.1,
    output_dir=folder,
    output_overwrite=True,
) as sim:
    print(f"{sim.vesicles} vesicles, area fraction {sim.area / (24 if chosen.short else 72):.3f}")
    sim.run(callback=look)
    time = sim.history["time"][1:]

run = petves.load(folder, "numpy")
print(f"areas of the kinds: {run.each('area')[0].max():.3g} and {run.each('area')[0].min():.3g}")
print(f"order |<exp(2 i angle)>|: {abs(order[0]):.3f} after the first step, {abs(order[-1]):.3f} at t = {time[-1]:g}")
figure, (axes,) = new_figure(6, 4)
axes.plot(time, np.abs(order))
axes.set(xlabel="time $t$", ylabel=r"order $|\langle e^{2i\theta}\rangle|$", ylim=(0, 1))
axes.grid(alpha=0.3)
print(save_figure(figure, chosen.folder / "suspension.png"))
print(movie(folder, chosen.folder / "suspension.gif", rate=10))
