"""Quick start: a vesicle in shear flow, its angle and tank-treading frequency, and a picture. On any number of ranks."""

from petsc4py import PETSc
from common import settings

import petves
from petves.views.plot import plot_run

chosen = settings(__doc__)
folder = chosen.folder / "quick_start"
options = dict(
    domain_box=(-2, 2, -2, 2),
    domain_cells=(32, 32) if chosen.short else (96, 96),
    flow_type="shear",
    vesicle_area=1,
    vesicle_reduced_area=0.7,
    vesicle_bending=0.3,
    time_step=0.05,
    time_end=0.5 if chosen.short else 8,
    output_every=0.25,
    output_dir=folder,
    output_overwrite=True,
)
print_once = PETSc.Sys.Print  # by the first rank only


def report(sim: petves.Simulation) -> None:
    """Called after every step."""
    if sim.steps % 40 == 0:
        print_once(f"t = {sim.time:4.1f}   angle/pi = {sim.inclination / 3.141592653589793:.4f}")


with petves.Simulation(**options) as sim:
    print_once(f"{sim.vesicles} vesicle of {len(sim.markers)} markers, reduced area {sim.reduced_area:.3f}")
    sim.run(callback=report)
    print_once(f"tank-treading frequency {sim.frequency:.4f}, area error {sim.area_error:.1e}")
    print_once(f"tension from {sim.tension.min():.3f} to {sim.tension.max():.3f}")

if PETSc.COMM_WORLD.getRank() == 0:  # the files are complete once the simulation is closed
    for path in plot_run(folder):
        print(path)
