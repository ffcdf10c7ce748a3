"""petves from Python: run simulations, read, draw, compare and reproduce runs."""

from __future__ import annotations

from typing import Any

from petves.errors import Error

__version__ = "0.2.0"
__all__ = ["Error", "Run", "RunError", "Simulation", "load"]
_HOME = {"Run": "run", "RunError": "run", "Simulation": "simulation", "load": "dataset"}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used: reading runs needs no PETSc, simulating no HDF5."""
    if name not in _HOME:
        raise AttributeError(f"module 'petves' has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module(f"petves.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    """Return the public names, those that are not imported yet too."""
    return sorted([*__all__, "__doc__", "__file__", "__name__", "__path__", "__version__"])
