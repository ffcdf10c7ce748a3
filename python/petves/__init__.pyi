import petves.quantities as quantities
from petves.dataset import load as load
from petves.errors import Error as Error
from petves.laboratory import numbers as numbers
from petves.run import Run as Run
from petves.run import RunError as RunError
from petves.simulation import Simulation as Simulation
from petves.sweeps import sweep as sweep
from petves.views.compare import compare as compare
from petves.views.movie import movie as movie
from petves.views.plot import plot_run as plot
from petves.views.report import report as report
from petves.views.watch import watch as watch

__version__: str
__all__ = [
    "Error",
    "Run",
    "RunError",
    "Simulation",
    "compare",
    "load",
    "movie",
    "numbers",
    "plot",
    "quantities",
    "report",
    "sweep",
    "watch",
]
