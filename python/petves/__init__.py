"""Reading, drawing and reproducing petves runs."""

from petves.run import Run, RunError

__all__ = ["Run", "RunError"]
