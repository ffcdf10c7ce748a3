from petves.dataset import load as load
from petves.errors import Error as Error
from petves.run import Run as Run
from petves.run import RunError as RunError
from petves.simulation import Simulation as Simulation

__version__: str
__all__ = ["Error", "Run", "RunError", "Simulation", "load"]
