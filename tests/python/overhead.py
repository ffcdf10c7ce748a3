"""What Python and a callback a step add to 256^2 cells: processor time outside petves' C functions over time in them."""

import time

import petves
from petves import simulation

seconds = 0.0


def watched(function):
    """The C function, its time taken."""

    def call(*arguments):
        global seconds
        begin = time.process_time()
        result = function(*arguments)
        seconds += time.process_time() - begin
        return result

    return call


class Library:
    """libpetves with its step watched."""

    def __init__(self, lib):
        self.lib = lib
        self.SimulationAdvance = watched(lib.SimulationAdvance)

    def __getattr__(self, name):
        function = getattr(self.lib, name)
        setattr(self, name, function)  # found by itself from now on, as in the library
        return function


def look(sim):
    """A callback that asks for what users ask for; what they then compute is their own time."""
    return sim.inclination, sim.markers, sim.tension, sim.energy


loaded = simulation.library()
simulation.library = lambda: Library(loaded)
with petves.Simulation(domain_cells=(256, 256), flow_type="shear", time_step=0.005, output_every=10) as sim:
    sim.run(until=0.025)
    shares = []
    for block in range(32):  # of twenty steps: to begin a run takes as long as a dozen callbacks
        seconds, begin = 0.0, time.process_time()
        sim.run(until=sim.time + 0.1, callback=look)
        shares.append((time.process_time() - begin - seconds) / seconds)
print(f"{min(shares):.5f}")
