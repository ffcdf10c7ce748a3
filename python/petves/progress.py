"""Progress bars, where a person looks on."""

import contextlib
from typing import Callable, Iterator


@contextlib.contextmanager
def progress_bar(end: float, begin: float = 0.0, show: bool | None = None, unit: str = "") -> Iterator[Callable]:
    """Show how far a quantity has come from `begin` to `end`, on standard error: ``bar(value)`` moves it.

    Without `show` it is shown if standard error is a terminal. `unit` is what is counted, "" for time.
    """
    try:
        from tqdm import tqdm
    except ImportError:
        yield lambda value: None
        return
    layout = "{l_bar}{bar}| {n:.4g}/{total:.4g}" + (f" {unit}" if unit else "") + " [{elapsed}<{remaining}]"
    hidden = end <= begin or (None if show is None else not show)  # None: unless it is a terminal
    with tqdm(total=end, initial=begin, bar_format=layout, disable=hidden) as bar:
        yield (lambda value: None) if bar.disable else (lambda value: bar.update(value - bar.n))
