"""Restart: half a run, the other half from its checkpoint, and the same numbers as a straight run."""

import numpy as np
from common import settings

import petves

chosen = settings(__doc__)
cells = 32 if chosen.short else 96
end = 0.1 if chosen.short else 1.0
scene = dict(domain_cells=(cells, cells), flow_type="shear", time_step=0.01, output_every=0.05, output_overwrite=True)

with petves.Simulation(output_dir=chosen.folder / "straight", time_end=end, **scene) as sim:
    sim.run()
    straight = sim.markers.copy()

with petves.Simulation(output_dir=chosen.folder / "halves", time_end=end / 2, **scene) as sim:
    sim.run()
    checkpoint = sim.checkpoint()

with petves.Simulation.restart(checkpoint, time_end=end) as sim:  # options from resolved.opts beside the checkpoint
    print(f"goes on from step {sim.steps}, time {sim.time:g}")
    sim.run()
    print(f"largest difference of the markers: {np.abs(sim.markers - straight).max():g}")
    assert np.array_equal(sim.markers, straight)

series = petves.load(chosen.folder / "halves", "numpy").series
print(f"one series of {len(series['time'])} rows from t = {series['time'][0]:g} to {series['time'][-1]:g}")
