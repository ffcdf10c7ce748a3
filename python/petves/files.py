"""Reading files that may be damaged, or are just being written; writing files whole."""

import contextlib
import json
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

from petves.errors import RunError

T = TypeVar("T")

#: What Python, NumPy and h5py raise at a file that is not as a run writes it.
BROKEN = (OSError, ValueError, LookupError, TypeError, AttributeError, RuntimeError, ArithmeticError, MemoryError)
#: Seconds before a file is read again: of a run that goes on it may be half written.
PAUSES = (0.01, 0.02, 0.05, 0.1, 0.2)


def read_file(path: Path, read: Callable[[Path], T], hint: str = "") -> T:
    """Return ``read(path)``, tried again a few times; RunError with the file's name when it is missing or broken.

    What `read` raises as RunError is not tried again. `hint` ends the message.
    """
    pauses = iter(PAUSES)
    while path.is_file():
        try:
            return read(path)
        except BROKEN as error:
            pause, why = next(pauses, None), f"{type(error).__name__}: {error}".splitlines()[0]
            if pause is None:
                raise RunError(f"{path}: cannot be read ({why}){hint}") from None
            time.sleep(pause)
    raise RunError(f"{path}: no such file")


def read_summary(path: Path) -> dict[str, Any]:
    """Return what summary.json has; read it with `read_file`."""
    summary = json.loads(path.read_text(errors="surrogateescape"))
    if not isinstance(summary, dict):
        raise ValueError("not an object")
    return summary


@contextlib.contextmanager
def writing(path: Path) -> Iterator[Path]:
    """Yield a name to write to; the file comes to `path`, in a folder that is made for it, when it is whole.

    A link at `path` is refused, as its file may be anything of the user's; RunError also when nothing can be written.
    """
    if path.is_symlink() or (path.exists() and not path.is_file()):
        raise RunError(f"{path}: cannot be written (it is a link, a folder or a device); allowed: the name of a file")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".petves-", dir=path.parent) as place:
            yield Path(place) / path.name
            (Path(place) / path.name).replace(path)
    except OSError as error:
        raise RunError(f"{path}: cannot be written ({error.strerror or error}); allowed: a folder with space") from None


def write_text(path: Path, text: str) -> Path:
    """Write a file that is whole or as it was; return its path."""
    with writing(path) as fresh:
        fresh.write_text(text, encoding="utf-8", errors="surrogateescape")
    return path


def shown(path: str | Path) -> str:
    """Return a path as text that any file can hold: bytes of its name that are not UTF-8 are replaced."""
    return str(path).encode("utf-8", "surrogateescape").decode("utf-8", "replace")
