"""A run that goes on, drawn anew into a page of its folder until it ends."""

from __future__ import annotations

import contextlib
import fcntl
import html
import time
from pathlib import Path

from petves.files import shown, writing
from petves.run import RunError
from petves.views.figures import PLAIN, Look, filled
from petves.views.plot import plot_run


def watch(folder: str | Path, every: float = 10, look: Look = PLAIN) -> Path:
    """Draw a run that goes on into watch.html of its folder, anew until it ends; the page reloads itself in a browser.

    Parameters
    ----------
    folder : str or Path
        The run's ``-output_dir``. The pictures are those of `petves.plot`.
    every : float
        Seconds between two drawings.
    look : Look
        How the pictures look.

    Returns
    -------
    Path
        The page, as it is at the end.

    Raises
    ------
    RunError
        When there is no such folder.
    """
    page = Path(folder) / "watch.html"
    if not page.parent.is_dir():
        raise RunError(f"{folder}: no such folder; give the -output_dir of a run")
    while goes_on(page.parent):
        _draw(page, every, look)
        time.sleep(every)
    return _draw(page, None, look)


def goes_on(folder: Path) -> bool:
    """Return whether a process works in a run's folder: it holds the lock on run.lock."""
    with contextlib.suppress(FileNotFoundError), (folder / "run.lock").open() as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except OSError:
            return True
    return False


def _draw(page: Path, every: float | None, look: Look) -> Path:
    """Draw the pictures and the page, without a saved time yet the page alone; `every` is None when the run has ended."""
    told = "The run has ended, or stopped." if every is None else f"The run goes on. Drawn at {time.strftime('%X')}."
    try:
        pictures = plot_run(page.parent, look)
    except RunError as error:
        pictures, told = [], f"{told} {error}"
    parts = {
        "REFRESH": "" if every is None else f'<meta http-equiv="refresh" content="{every:g}">',
        "TITLE": html.escape(f"petves: {shown(page.parent.resolve().name)}"),
        "TOLD": html.escape(told),
        "PICTURES": "\n".join(f'<img src="{x.name}?{x.stat().st_mtime_ns}" alt="{x.stem}">' for x in pictures),
    }
    with writing(page) as fresh:
        fresh.write_text(filled("watch.html", parts), encoding="utf-8")
    return page
