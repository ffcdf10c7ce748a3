"""Pictures of runs: curves through markers, windows that go along, sheets without overlaps, what a look refuses."""

import dataclasses
import re

import numpy as np
import pytest
from harness import run_petves

import petves
from petves.curves import trigonometric
from petves.run import CURVE, Run
from petves.views.field import FIELDS, SOLID, draw_field, draw_membranes, draw_solids, reach
from petves.views.figures import Look, legend_above, new_figure, new_sheet
from petves.views.plot import is_steady, plot_conservation, plot_energy, plot_run
from petves.views.report import report
from petves.views.window import Window
from petves.views.words import key_numbers

pytestmark = pytest.mark.xdist_group("pictures")  # its tests share a run

OPTIONS = "-domain_box 0,4,0,2 -domain_cells 48,24 -domain_bc_x periodic -flow_type poiseuille -flow_half_width 1"
OPTIONS += " -flow_center_y 1 -flow_peak_velocity 3 -vesicle_semi_axes .3,.4 -vesicle_center 3.3,1"
OPTIONS += " -fluid_inertia none -time_step .1 -time_end .4 -output_every .2"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return Run.read(run_petves(tmp_path_factory.mktemp("pictures") / "run", OPTIONS).folder)


@pytest.mark.parametrize("n", [9, 10])
@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_trigonometric_polynomials_are_met(n, shift):
    wave = lambda s: np.stack([1 + np.cos(2 * np.pi * 3 * s / n), np.sin(2 * np.pi * 4 * s / n)], axis=-1)
    fine = np.arange(5 * n) / 5 + shift
    np.testing.assert_allclose(trigonometric(wave(np.arange(n)), 5 * n, shift), wave(fine), atol=1e-13)


def test_curve_passes_through_the_markers(run):
    outline, curve = run.outline(-1), run.curve(-1)
    np.testing.assert_allclose(curve[::CURVE], outline, atol=1e-13)
    chords = np.linalg.norm(np.diff(outline, axis=0), axis=1).sum()
    arcs = np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()
    length = run.series["length"][-1]
    assert chords < arcs < length and length - arcs < 0.04 * (length - chords), "a polygon of so many more sides"
    assert len(run.curve_tension(-1)) == len(curve) - 1


def test_window_goes_along(run):
    """The vesicle is in the middle, its velocity is taken off, and each value is that of the place in the box."""
    assert run.centroid(-1)[0] > 4, "it has left the box"
    window = Window(run, -1, 1)
    (x, y), (u, v, p) = window.cell_centers(), window.fields()
    np.testing.assert_allclose(window.limits, [-2, 2, 0, 2])
    assert x[0] - run.h / 2 <= -2 and x[-1] + run.h / 2 >= 2 and u.shape == (len(y), len(x))
    own_u, _, own_p = run.fields(-1)
    columns = np.floor((x + run.centroid(-1)[0]) % 4 / run.h).astype(int)
    gradient = -2 * 3 / 1**2  # nu, peak velocity and half width are 1, 3 and 1
    np.testing.assert_allclose(p, own_p[:, columns] + gradient * x, atol=1e-12)
    np.testing.assert_allclose(u, own_u[:, columns] - run.series["velocity_x"][-1], atol=1e-14)
    (image,) = window.images(0)
    assert abs(image[:-1].mean(axis=0)[0]) < 0.02
    still = Window(run, -1)
    np.testing.assert_array_equal(still.fields()[0], own_u)
    assert all(-0.8 < points[:, 0].min() and points[:, 0].max() < 4.8 for points in still.images(0))


@pytest.mark.parametrize("follow", [None, 1])
def test_solids_are_filled(follow, run):
    """A ring of fluid across the seam, solid around it and in its middle; then the middle one alone."""
    from matplotlib.colors import to_rgb

    t = np.arange(30) * np.pi / 15
    circle = lambda radius: np.stack([3.9 + radius * np.cos(t), 1 + radius * np.sin(t)], axis=1)
    inner, outer = circle(0.3), circle(0.8)[::-1]
    places = {3.9: True, 0.1: True, 0.4: False, 3.3: False, 2.0: True}
    for obstacles, around in (([inner, outer], True), ([inner], False), ([], None)):
        solid = dataclasses.replace(run, obstacles=obstacles, obstacle_kinds=["closed"] * len(obstacles))
        window = Window(solid, -1, follow)
        figure, (axes,) = new_figure(8, 4)
        axes.set(xlim=window.limits[:2], ylim=window.limits[2:])
        draw_solids(axes, window)
        figure.canvas.draw()
        pixels = np.asarray(figure.canvas.buffer_rgba())[::-1, :, :3] / 255
        for x, solid in places.items():
            middle = sum(window.limits[:2]) / 2
            seen = (x - window.origin[0] - middle + 2) % 4 + middle - 2  # its image in the window
            column, row = axes.transData.transform((seen, 1.05)).astype(int)
            expected = bool(obstacles) and (around if x == 2.0 else solid)
            assert np.allclose(pixels[row, column], to_rgb(SOLID), atol=0.01) == expected, (x, len(obstacles))


def test_colours_leave_out_a_few_cells(run):
    """Where they have much more than all others; the bar then has arrows."""
    values = np.linspace(-1, 2, 1000).reshape(20, 50)
    assert reach(values) == 2 and reach(0 * values) == 1
    values[0, :3] = -5
    assert 1.9 < reach(values) < 2.1
    window = Window(run, -1)
    most = np.abs(FIELDS["speed"].values(window)).max()
    for high, film, ends in ((0, 0, "neither"), (1.01, 0, "neither"), (0.9, 0, "max"), (1.01, 1.02, "max")):
        figure, (axes, bar) = new_figure(8, 4, columns=2)
        image = draw_field(axes, FIELDS["speed"], window, Look(), high * most, film * most)
        assert figure.colorbar(image, cax=bar).extend == ends, (high, film)


def test_membranes_of_small_vesicles_are_thin(run):
    widths = []
    for inches in (8, 2, 0.1):
        figure, (axes,) = new_figure(inches, 4)
        limits = run.tension[-1].min(), run.tension[-1].max()
        widths.append(draw_membranes(axes, run, -1, limits, "black")[-1].get_linewidth()[0])
    assert widths[0] == 0.6 * 4 > widths[1] > widths[2] == 0.6


@pytest.mark.parametrize(
    "form, first, letters", [("svg", b"<?xml", rb"<text[^>]*>relative error</text>"), ("pdf", b"%PDF", b"/FontFile2")]
)
def test_formats(form, first, letters, run):
    """Their letters are letters, not outlines."""
    paths = plot_run(run.folder, Look(format=form, dpi=50, width=5, cmap="cividis", follow=1))
    assert [path.name for path in paths] == [f"{name}.{form}" for name in NAMES]
    pages = [path.read_bytes() for path in paths]
    assert all(page.startswith(first) and b"/Type3" not in page for page in pages)
    assert all(re.search(letters, page) for page in (pages if form == "pdf" else pages[2:3]))


NAMES = ("energy", "field", "conservation", "motion", "tension", "shapes")


def test_looks_that_cannot_be_are_refused(run):
    for words, line in (
        (dict(format="jpg"), "format jpg: unknown; allowed: png, pdf, svg"),
        (dict(dpi=0), "dpi 0: out of range"),
        (dict(width=1), "width 1: out of range"),
        (dict(cmap="rainbowish"), "cmap rainbowish: unknown"),
    ):
        with pytest.raises(petves.Error, match=line):
            Look(**words)
    with pytest.raises(petves.Error, match="follow 2: no such vesicle; allowed: 1 to 1"):
        plot_run(run.folder, Look(follow=2))


@pytest.mark.parametrize("aspect", [0.1, 1, 2, 20])
@pytest.mark.parametrize("width", [None, 3.4, 10])
def test_nothing_overlaps_or_is_cut(aspect, width):
    """Panels and bars with their numbers and names, in boxes flat and tall, in a column of a journal and wider."""
    sheet = new_sheet(aspect, 1, panels=2, last=True, look=Look(width=width))
    for axes in sheet.panels:
        axes.set(xlabel="$x$ (length)", ylabel="$y$ (length)", xlim=(0, aspect), ylim=(0, 1))
    for axes in [*sheet.bars, sheet.last]:
        axes.set(xlabel=r"pressure $p$ (length$^2$/time$^2$)", yticks=[])
    assert width is None or sheet.figure.get_figwidth() == pytest.approx(width, rel=1e-6)
    boxes = [axes.get_tightbbox(sheet.figure.canvas.get_renderer()) for axes in sheet.figure.axes]
    inside = sheet.figure.bbox.padded(1)
    assert all(inside.x0 <= b.x0 and b.x1 <= inside.x1 and inside.y0 <= b.y0 and b.y1 <= inside.y1 for b in boxes)
    overlaps = [(i, j) for i, a in enumerate(boxes) for j, b in enumerate(boxes) if i < j and a.overlaps(b)]
    assert not overlaps


def test_legend_stands_over_the_data():
    figure, (axes,) = new_figure(6, 4)
    for k in range(3):
        axes.plot([0, 1], [k, 1], label=f"energy number {k}")
    legend_above(axes)
    figure.canvas.draw()
    legend, panel = axes.get_legend().get_window_extent(), axes.get_window_extent()
    assert legend.y0 >= panel.y1 - 1 and legend.y1 <= figure.bbox.y1 + 1


def test_capsules_lengthen_without_an_error(run):
    """Of an unstressed start the energies are over their largest sum, and a length that may change has no error."""
    zero, series = run.series["time"] * 0, dict(run.series)
    series |= {f"energy_{name}": zero for name in ("bending", "kinetic", "gravity", "contact")}
    stretched = dataclasses.replace(run, series=series | {"energy_stretching": np.linspace(1e-27, 2, len(zero))})
    assert plot_energy(stretched).axes[0].lines[0].get_ydata()[-1] == 1
    assert [line.get_label()[:4] for line in plot_conservation(stretched).axes[0].lines] == ["area"]


def test_a_is_steady_is_told():
    time = np.linspace(0, 10, 101)
    assert is_steady(time, 2 + np.exp(-time)) and is_steady(time, 2 * np.exp(-time), scale=2)
    assert not is_steady(time, time) and not is_steady(time, np.full(101, np.nan))
    assert not is_steady(time, 2 * np.exp(-time)), "what falls to nothing, over its last value"


def test_key_numbers_are_all_known(run, tmp_path):
    """No empty cells, also of a run that has not ended; of several vesicles totals."""
    unfinished = Run.read(run.folder)
    unfinished.summary = {}
    names = [name for name, value in key_numbers(unfinished) if value]
    assert len(names) == len(key_numbers(unfinished)) and "ranks" not in names and "last inclination" in names
    pair = OPTIONS + " -vesicle_count 2 -vesicle_center 1,1,3,1 -time_end 0"
    two = Run.read(run_petves(tmp_path / "pair", pair).folder)
    rows = dict(key_numbers(two))
    assert float(rows["area of all vesicles"]) == pytest.approx(two.series["area"][0], rel=1e-4)
    page = report(two.folder).read_text()
    assert "<td></td>" not in page and "last mean axis" in page
