"""Progress bars, where a person looks on."""

from __future__ import annotations

import contextlib
import sys
from typing import Any, Callable, Iterator


@contextlib.contextmanager
def progress_bar(
    end: float, begin: float = 0.0, show: bool | None = None, unit: str = ""
) -> Iterator[Callable[[float], Any]]:
    """Show how far a quantity has come on its way to `end`, on standard error.

    Parameters
    ----------
    end, begin : float
        Where it goes and where it starts.
    show : bool, optional
        Whether to; when left out, if standard error is a terminal.
    unit : str
        What is counted: "" for time.

    Yields
    ------
    callable
        ``bar(value)`` moves it.
    """
    try:
        from tqdm import tqdm
    except ImportError:
        tqdm = None
    shown = sys.stderr.isatty() if show is None else show
    if tqdm is None or not shown or end <= begin:
        yield lambda value: None
        return
    layout = "{l_bar}{bar}| {n:.4g}/{total:.4g}" + (f" {unit}" if unit else "") + " [{elapsed}<{remaining}]"
    with tqdm(total=end, initial=begin, file=sys.stderr, bar_format=layout) as bar:
        yield lambda value: bar.update(value - bar.n)
