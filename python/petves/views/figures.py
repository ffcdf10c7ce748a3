"""What all pictures share: how they look, figures without a display, files."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from petves.errors import RunError
from petves.files import writing

FORMATS = ("png", "pdf", "svg")
MANY = 8  # vesicles above which none has a name
LEGEND = 10  # size of its letters
FONTS = {"pdf.fonttype": 42, "svg.fonttype": "none"}  # letters as letters, which journals ask for


@dataclass(frozen=True)
class Look:
    """How pictures are to look.

    Attributes
    ----------
    format : str
        "png", "pdf" or "svg".
    dpi : float
        Dots an inch, of png and of the fields inside pdf and svg.
    width : float, optional
        Width of each picture in inches; letters keep their size. Left out: each picture has its own.
    cmap : str, optional
        matplotlib's colour map of the speed, "viridis" when left out: like those of pressure and tension it can be read by
        colour-blind readers and in grey.
    follow : int, optional
        The vesicle, 1 for the first, in whose frame fields and outlines are drawn, in a periodic box.
    """

    format: str = "png"
    dpi: float = 120
    width: float | None = None
    cmap: str | None = None
    follow: int | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be drawn."""
        if self.format not in FORMATS:
            raise RunError(f"format {self.format}: unknown; allowed: {', '.join(FORMATS)}")
        if not 10 <= self.dpi <= 2400:
            raise RunError(f"dpi {self.dpi:g}: out of range; allowed: 10 to 2400")
        if self.width is not None and not 2 <= self.width <= 60:
            raise RunError(f"width {self.width:g}: out of range; allowed: 2 to 60 inches")
        if self.cmap is not None and self.cmap not in matplotlib.colormaps:
            raise RunError(f"cmap {self.cmap}: unknown; allowed: matplotlib's, such as viridis, cividis, magma, gray")


PLAIN = Look()


def blank_figure(width: float, height: float, layout: str | None = None) -> Figure:
    """Return an empty figure that needs no display; its sides are in inches."""
    return FigureCanvasAgg(Figure(figsize=(width, height), layout=layout)).figure


def new_figure(
    width: float, height: float, columns: int = 1, rows: int = 1, equal: bool = False, look: Look = PLAIN
) -> tuple[Figure, np.ndarray]:
    """Return a figure that needs no display, and its axes, row by row; equal: of equal scales in x and y.

    A look's width stands in place of `width`; the height goes with it as far as letters have room.
    """
    if look.width is not None:
        width, height = look.width, max(height * look.width / width, 1.0 + 1.7 * rows)
    figure = blank_figure(width, height, "compressed" if equal else "constrained")
    return figure, figure.subplots(rows, columns, squeeze=False).ravel()


LEFT, RIGHT, BELOW, ABOVE = 0.8, 0.3, 0.6, 0.4  # what stands around a panel, in inches
BAR, UNDER_BAR = 0.14, 0.56  # a colour bar, and its numbers and name
WIDE = 1.6  # a box wider than this, over its height, has its panels one above the other
NARROW = 3.2  # width of a colour bar where its panel is narrower, for its name
TICK = 0.62  # inches that a number takes below a colour bar
LEAST = 2.0  # width that a panel has at least beside another one


@dataclass
class Sheet:
    """A figure of panels of one shape, each with a colour bar below, and a last bar for all of them."""

    figure: Figure
    panels: list[Axes]
    bars: list[Axes]
    last: Axes | None


def new_sheet(
    wide: float, high: float, panels: int, bars: bool = True, last: bool = False, look: Look = PLAIN
) -> Sheet:
    """Return a sheet whose panels have the sides of a box, all in inches, so that nothing overlaps or is cut.

    Panels stand side by side, or one above the other where the box is wide.
    """
    around = LEFT + RIGHT
    flat = wide > WIDE * high or (look.width is not None and look.width / panels - around < LEAST)
    rows = panels if flat else 1
    columns = panels // rows
    across = look.width / columns - around if look.width is not None else 8.0 if flat else 4.8
    tall = min(across * high / wide, 9.0)
    each = max(tall * wide / high, across if look.width is not None else min(across, NARROW))
    across = tall * wide / high
    row = ABOVE + tall + BELOW + bars * (BAR + UNDER_BAR)
    width, height = columns * (LEFT + each + RIGHT), rows * row + last * (BAR + UNDER_BAR)
    figure = blank_figure(width, height)

    def place(left: float, bottom: float, w: float, h: float) -> Axes:
        return figure.add_axes((left / width, bottom / height, w / width, h / height))

    sheet = Sheet(figure, [], [], place(LEFT, UNDER_BAR, width - LEFT - RIGHT, BAR) if last else None)
    for k in range(panels):
        left = LEFT + (k % columns) * (LEFT + each + RIGHT)
        bottom = height - (k // columns + 1) * row
        sheet.panels.append(place(left + (each - across) / 2, bottom + row - ABOVE - tall, across, tall))
        if bars:
            sheet.bars.append(place(left, bottom + UNDER_BAR, each, BAR))
    return sheet


def add_bar(place: Axes, mappable: ScalarMappable, label: str) -> None:
    """Draw a colour bar with as many numbers as its width takes."""
    inches = place.get_window_extent().width / place.figure.dpi
    ticks = MaxNLocator(max(2, int(inches / TICK)), steps=[1, 2, 2.5, 5, 10], min_n_ticks=2)
    place.figure.colorbar(mappable, cax=place, label=label, ticks=ticks, orientation="horizontal")


def filled(name: str, parts: dict[str, str]) -> str:
    """Return a page of this folder with the parts in their places, __NAME__ each; those in a part stay as they are."""
    page = (Path(__file__).parent / name).read_text(encoding="utf-8")
    return re.sub(f"__({'|'.join(parts)})__", lambda found: parts[found[1]], page)


def save_figure(figure: Figure, path: Path, look: Look = PLAIN) -> Path:
    """Write a picture in the look's format; return its path."""
    path = path.with_suffix(f".{look.format}")
    dates = {"png": {}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}  # the same run, the same file
    with writing(path) as fresh, matplotlib.rc_context(FONTS):
        figure.savefig(fresh, dpi=look.dpi, metadata=dates[look.format])
    return path


def dress(axes: Axes, legend: float = 0, grid: str = "major", **names: Any) -> None:
    """Set what is named, draw a grid (major, minor or both) and, in letters of a size, a legend."""
    axes.set(**names)
    axes.grid(alpha=0.3, which=grid)
    if legend:
        axes.legend(frameon=False, fontsize=legend)


def legend_above(axes: Axes, columns: int = 3) -> None:
    """Draw the legend over the axes, where there are no data, in at most so many columns: as many as the width takes."""
    place = dict(loc="lower left", bbox_to_anchor=(-0.02, 1.0), borderaxespad=0.1, columnspacing=1.2)
    for count in range(columns, 0, -1):
        legend = axes.legend(frameon=False, fontsize=LEGEND, ncols=count, **place)
        if legend.get_window_extent().width <= axes.figure.bbox.width - LEFT * axes.figure.dpi:
            return
