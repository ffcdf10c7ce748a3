"""What the examples share: their command line, and a figure that needs no display."""

from __future__ import annotations

import argparse
from pathlib import Path


def settings(description: str) -> argparse.Namespace:
    """Return `folder`, where files go, and `short`, true for coarse grids and few steps."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("folder", nargs="?", default="out/examples", type=Path, help="where files go (out/examples)")
    parser.add_argument("--short", action="store_true", help="coarse and quick")
    chosen = parser.parse_args()
    chosen.folder.mkdir(parents=True, exist_ok=True)
    return chosen
