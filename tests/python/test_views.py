"""petves plot at the widths of journals, its pictures of one time, of columns and of quantities; kinds, bumps and films."""

import numpy as np
import pytest

import petves
from petves.run import Run
from petves.views import field, movie, plot
from petves.views.figures import Look
from petves.views.movie import movie as film
from petves.views.plot import plot_run
from petves.views.words import key_numbers, scene_in_words

pytestmark = pytest.mark.xdist_group("views")  # its tests share runs

CHANNEL = "-domain_box 0,3,0,1 -domain_cells 48,16 -domain_bc_x periodic -flow_type poiseuille -flow_half_width 0.5"
SCENES = {
    "throat": f"{CHANNEL} -flow_center_y 0.5 -flow_peak_velocity 1.5 -flow_drive flux -obstacle_shape constriction"
    " -obstacle_throat 0.6 -obstacle_length 1 -obstacle_center 1.5,0 -vesicle_area 0.1 -vesicle_reduced_area 0.8"
    " -vesicle_center 0.6,0.5 -vesicle_bending 0.1 -time_step 0.01 -time_end 0.2 -output_every 0.02",
    "pair": "-domain_box -4,4,-2,2 -domain_cells 64,32 -domain_bc_x periodic -flow_type shear -fluid_inertia none"
    " -vesicle_count 2 -vesicle_center -1,0.1,1,-0.1 -vesicle_area 1 -vesicle_reduced_area 0.8 -time_step 0.1"
    " -time_end 0.8 -output_every 0.1",
    "sinking": "-domain_box -3,3,-3,3 -domain_cells 32,32 -fluid_inertia none -fluid_gravity 0,-1"
    " -vesicle_density_difference 1 -vesicle_area 2 -vesicle_reduced_area 0.7 -time_step 0.05 -time_end 0.2",
    "free": "-domain_box -3,3,-3,3 -domain_cells 32,32 -domain_bc_x free -domain_bc_y free -fluid_inertia none"
    " -flow_type shear -vesicle_area 2 -vesicle_reduced_area 0.7 -time_step 0.05 -time_end 0.1",
    "two kinds": "-domain_box 0,8,0,4 -domain_cells 64,32 -domain_bc_x periodic -flow_type shear -flow_center_y 2"
    " -fluid_inertia none -vesicle_packing 0.3 -vesicle_mixture 0.5,0.5"
    " -vesicle_area 1,0.5 -vesicle_reduced_area 0.7,0.9 -vesicle_bending 0.1,1 -time_step 0.02 -time_end 0.08 -output_every 0.04",
}


@pytest.fixture(scope="module")
def folders(cached_run):
    return lambda name: cached_run(SCENES[name]).folder


@pytest.fixture
def figures(monkeypatch):
    """The figures by their file's name, in place of files."""
    kept = {}
    keep = lambda figure, path, look=None: kept.update({path.name: figure}) or path
    monkeypatch.setattr(plot, "save_figure", keep)
    return kept


def texts(figure):
    """Return the boxes, in pixels, of the letters that are drawn, with the text."""
    from matplotlib.text import Text

    figure.draw_without_rendering()
    renderer, found, hidden = figure.canvas.get_renderer(), {}, set()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            shown = axis._update_ticks() if axes.axison else []
            ticks = [tick for tick in (*axis.majorTicks, *axis.minorTicks) if tick not in shown]
            hidden |= {label for tick in ticks for label in (tick.label1, tick.label2)}
    for text in figure.findobj(Text):
        if text.get_visible() and text.get_text().strip() and text not in hidden:
            found[text] = text.get_window_extent(renderer)
    return [(text.get_text(), box.padded(-1)) for text, box in found.items()]


@pytest.mark.parametrize("width", [3.4, 5, 7])
@pytest.mark.parametrize("name", ["throat", "pair", "two kinds"])
def test_letters_lie_inside_and_apart(name, width, folders, figures):
    asked = dict(columns=["gap", "normal_stress_wall"], fields=["vorticity", "pressure_deviation"], walls=True)
    asked |= dict(points=[(0, 0.5), (1, 0.25)], line=(0, 0.5, 2, 0.5))
    plot_run(folders(name), Look(width=width, dpi=60))
    assert {"energy.png", "field.png", "motion.png", "shapes.png", "tension.png"} <= set(figures)
    plot_run(folders(name), Look(width=width, dpi=60), time=0.04, **asked)
    assert len(figures) == 11
    for picture, figure in figures.items():
        assert width is None or figure.get_figwidth() == pytest.approx(width, rel=1e-6)
        found, sheet = texts(figure), figure.bbox
        assert len(found) > 6
        for text, box in found:
            inside = sheet.x0 <= box.x0 and box.x1 <= sheet.x1 and sheet.y0 <= box.y0 and box.y1 <= sheet.y1
            assert inside, (picture, text)
        close = [(a, b) for i, (a, x) in enumerate(found) for b, y in found[:i] if x.overlaps(y)]
        assert not close, picture


def test_pictures_of_a_time_and_of_columns(folders):
    folder = folders("pair")
    names = [path.name for path in plot_run(folder, time=0.43)]
    assert names == ["field_t0.43.png", "tension_t0.43.png"]
    assert [path.name for path in plot_run(folder, columns=["gap", "area_1"])] == ["series.png"]
    assert [path.name for path in plot_run(folder, time=0.43, columns=["gap"])] == ["series.png", *names]
    for words, line in (
        (dict(time=2), "time 2: not in the run; allowed: 0 to 0.8"),
        (dict(columns=["gab"]), "column gab: not one of this run; gap is meant.; allowed: step, time, "),
        (dict(fields=["vortex"]), "field vortex: unknown; allowed: pressure, pressure_deviation, speed, vorticity, "),
        (dict(points=[(0, 3)]), "a point lies outside of the box; allowed: y from -2 to 2"),
    ):
        with pytest.raises(petves.Error, match=line) as error:
            plot_run(folder, **words)
        assert "\n" not in str(error.value)


def test_columns_that_are_drawn_unasked(folders, figures):
    """The gap of two vesicles, the drop and the torques of obstacles, with units; all of one name in a panel."""
    expected = {"pair": ["gap", "viscosity"], "throat": ["pressure_drop", "obstacle_torque"]}
    for name, columns in expected.items():
        figures.clear()
        plot_run(folders(name))
        panels = figures["series.png"].axes
        labels = [panel.get_ylabel().split("\n") for panel in panels]
        assert [label[0] for label in labels] == columns
        assert all(label[1].startswith("(length") for label in labels if label[0] != "viscosity")
    run = Run.read(folders("throat"))
    torques = [line.get_ydata() for line in panels[1].get_lines()]
    np.testing.assert_array_equal(torques, [run.series[f"obstacle_torque_{k}"] for k in (1, 2)])


def test_total_energy_is_that_of_all_parts(folders):
    """It falls while a vesicle sinks; the kinetic energy of unbounded fluid, which is not computed, is not drawn."""
    sinking = Run.read(folders("sinking"))
    assert set(sinking.energies()) == {"bending", "kinetic", "gravity"}
    total = sum(sinking.energies().values())
    assert (np.diff(total)[1:] < 0).all()
    assert not (np.diff(total - sinking.series["energy_gravity"])[1:] < np.diff(total)[1:]).any()
    assert set(Run.read(folders("free")).energies()) == {"bending"}


def test_an_angle_is_drawn_as_series_has_it_and_steady_with_the_rest(folders):
    run = Run.read(folders("pair"))
    run.series["inclination_1"] = np.linspace(1.6, 1.601, len(run.series["time"])) % np.pi
    run.series["inclination_1"][-1] -= np.pi  # a jump of the branch, not of the vesicle
    angles = plot.plot_motion(run).axes[0]
    drawn = angles.get_lines()[0].get_ydata()
    assert drawn[-1] == pytest.approx(run.series["inclination_1"][-1] / np.pi) and np.ptp(drawn) < 0.001
    assert not angles.texts, "the vesicles still come nearer to one another"


def test_kinds_have_colours_and_names(folders, figures):
    run = Run.read(folders("two kinds"))
    members, names = field.kinds_of(run)
    assert len(names) == 2 and sorted(np.bincount(members)) == [6, 7] and all("$V$" in name for name in names)
    assert len(set(run.bending[members == 0])) == 1
    plot_run(run.folder)
    legend = figures["shapes.png"].axes[0].get_legend()
    assert [text.get_text() for text in legend.get_texts()] == names
    lines = [c for c in figures["field.png"].axes[1].collections if c.get_array() is not None]
    assert len(lines) == 1 and lines[0].get_array().size > run.markers.shape[1], "the tension of all of them"


def test_a_bump_ends_at_the_foot_of_its_curve(folders):
    """runs/constriction.opts's bump on the bottom is half (1 + cos(2 pi (x - 1.5))) high: its feet are at 1 and 2."""
    solid = Run.read(folders("throat")).obstacle_curve(0)
    on_wall = solid[solid[:, 1] == 0]
    assert abs(on_wall[:, 0].min() - 1) < 0.06 and abs(on_wall[:, 0].max() - 2) < 0.06
    inside = solid[(solid[:, 1] > 0)]
    np.testing.assert_allclose(inside[:, 1], 0.1 * (1 + np.cos(2 * np.pi * (inside[:, 0] - 1.5))), atol=0.01)


def test_report_names_solids_forces_and_warnings(folders):
    run = Run.read(folders("throat"))
    run.summary["warnings"] = ["a film of one marker spacing"]
    words, numbers = scene_in_words(run), dict(key_numbers(run))
    assert "Solid bodies: 2, on a wall. The flux through the box is kept." in words
    assert words[-1] == "Warning: a film of one marker spacing"
    drop, gap = run.series["pressure_drop"][-1], run.series["gap"].min()
    assert float(numbers["last pressure drop"]) == pytest.approx(drop, rel=1e-3)
    assert float(numbers["least gap"]) == pytest.approx(gap, rel=1e-2)
    assert "last obstacle torque" in numbers
    assert "Solid bodies" not in "".join(scene_in_words(Run.read(folders("pair"))))


def test_films_have_a_bar_of_the_tension(folders, monkeypatch, tmp_path):
    kept = []
    sheets = movie.box_sheet
    monkeypatch.setattr(movie, "box_sheet", lambda *words, **more: kept.append(sheets(*words, **more)) or kept[-1])
    film(folders("pair"), tmp_path / "film.gif", every=4, field="vorticity", streamlines=True, width=600)
    figure = kept[0].figure
    assert "tension" in kept[0].last.get_xlabel() and "vorticity" in kept[0].bars[0].get_xlabel()
    assert kept[0].bars[0]._colorbar.extend == "neither"
    assert all(round(150 * side) % 2 == 0 for side in figure.get_size_inches())
    found = texts(figure)
    assert not [(a, b) for i, (a, x) in enumerate(found) for b, y in found[:i] if x.overlaps(y)]


def test_bar_of_a_film_has_arrows_for_later_pictures(folders, monkeypatch, tmp_path):
    """The first picture's largest speed is 1.938, the last one's 1.944."""
    kept = []
    add_bar = movie.add_bar
    monkeypatch.setattr(movie, "reach", lambda values: 1.94)
    monkeypatch.setattr(movie, "add_bar", lambda place, *more: kept.append(place) or add_bar(place, *more))
    film(folders("pair"), tmp_path / "film.gif", every=8, width=300)
    assert [place._colorbar.extend for place in kept] == ["max", "neither"]
