"""Calls of Python functions in a step with a callback that asks for what users ask for: their number is the cost."""

import sys

import petves

calls = 0


def watch(_frame, event, _function):
    global calls
    calls += event in ("call", "c_call")


def look(sim):
    return sim.inclination, sim.markers, sim.tension, sim.energy


with petves.Simulation(domain_cells=(32, 32), flow_type="shear", time_step=0.005, output_every=10) as sim:
    sim.run(until=0.1)
    sys.setprofile(watch)
    sim.run(until=0.2, callback=look)
    sys.setprofile(None)
print(calls / 20)
