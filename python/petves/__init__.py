"""petves from Python: run simulations, read, draw, compare and reproduce runs."""

import pkgutil
from typing import Any

from petves.errors import Error

__version__ = "0.2.0"
_HOME = {
    "Run": "run:Run",
    "RunError": "run:RunError",
    "Simulation": "simulation:Simulation",
    "compare": "views.compare:compare",
    "load": "dataset:load",
    "movie": "views.movie:movie",
    "numbers": "laboratory:numbers",
    "plot": "views.plot:plot_run",
    "quantities": "quantities:",
    "report": "views.report:report",
    "sweep": "sweeps:sweep",
    "watch": "views.watch:watch",
}
"""The module of each name and the name there; a module's without one."""
__all__ = ["Error", *_HOME]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used: reading runs needs no PETSc, simulating no HDF5."""
    if name not in _HOME:
        raise AttributeError(f"module 'petves' has no attribute {name!r}")
    return pkgutil.resolve_name(f"petves.{_HOME[name]}")


def __dir__() -> list[str]:
    """Return the public names, those that are not imported yet too."""
    return sorted([*__all__, "__doc__", "__file__", "__name__", "__path__", "__version__"])
