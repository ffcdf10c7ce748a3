"""The work-precision diagrams: distances, envelopes, recommendations, resuming, what a handful of points must show."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from harness import PETVES

from studies.common.curves import material_distance, outline_distance
from studies.common.engine import Results
from studies.speed_accuracy import claim as chart_claim
from studies.speed_accuracy import page as report
from studies.speed_accuracy import scenes as study
from studies.speed_accuracy.pictures import envelope

RELAX = next(one for one in study.SCENES if one.name == "relax")


def ellipse(n: int, turn: float = 0.0) -> np.ndarray:
    angle = 2 * np.pi * (np.arange(n) + turn) / n
    return np.stack([0.2 * np.cos(angle), 0.5 * np.sin(angle)], axis=1)


def test_distances():
    """The outline's distance knows neither where markers are on it nor where it is; the material one knows both."""
    fine = ellipse(101)
    assert material_distance(ellipse(31), fine) < 1e-5
    assert material_distance(ellipse(31) + [3e-3, 4e-3], fine) == pytest.approx(5e-3, rel=1e-2)
    moved = ellipse(31, turn=0.3)
    assert material_distance(moved, fine) > 1e-2
    assert outline_distance(moved + [3, 4], fine) < 1e-6
    circle = np.stack([np.cos(a := np.arange(65) * 2 * np.pi / 65), np.sin(a)], axis=1)
    assert outline_distance(1.02 * circle, circle) == pytest.approx(0.02, rel=1e-3)


def test_envelope_is_what_no_cheaper_point_equals():
    costs, errors = np.array([3.0, 1, 2, 4, 5]), np.array([1e-2, 1e-1, 2e-1, 1e-2, 1e-3])
    assert envelope(costs, errors).tolist() == [1, 0, 4]


def test_recommended_is_the_cheapest_that_keeps_every_error():
    """A point whose errors cancel, so that a finer one is worse, does not count."""

    def row(cells: int, dt: float, seconds: float, largest: float, **other: object) -> dict:
        found = {"scheme": study.BEST, "message": "", "solves": 1.0, "cells": cells, "dt": f"{dt}", "tolerance": "0"}
        return found | {"cpu_seconds": seconds, "largest": largest} | other

    rows = [
        row(64, 0.1, 2.0, 5e-3),
        row(64, 0.05, 3.0, 8e-4),
        row(32, 0.1, 0.7, 2e-4),  # by chance
        row(32, 0.05, 0.8, 5e-2),
        row(96, 0.1, 4.0, 4e-3),
        row(96, 0.05, 5.0, 9e-4),
        row(16, 0.1, 0.5, "", scheme="split", message="not finite"),
        row(32, 0.1, 0.6, 1e-4, scheme="split"),
    ]
    assert report.cheapest(rows, study.EXACT, 1e-2) is rows[0]
    assert report.cheapest(rows, study.EXACT, 1e-3) is rows[1]
    assert report.cheapest(rows, study.EXACT, 1e-4) is None
    assert report.cheapest(rows, ("split",), 1e-2) is rows[7]


def test_points_are_distinct_and_every_scheme_is_there():
    for one in report.ALL:
        names = [one.case(point, 0, {}).name for point in one.points]
        assert len(set(names)) == len(names)
        schemes = {point.scheme for point in one.points}
        least = study.SCHEMES if one in study.SCENES else study.EXACT
        assert set(least) <= schemes <= set(study.SCHEMES)


def test_a_handful_of_points(tmp_path, monkeypatch):
    """Coupled with corrections on 24^2 cells beats split on 64^2 in error and work; penalty with explicit bending and a
    large step stops and is listed; what has run is not run again."""
    monkeypatch.setenv("PETVES", PETVES)
    monkeypatch.setattr(report, "ROUNDS", 2)
    monkeypatch.setattr(chart_claim, "REPEATS", 1)
    whole = chart_claim.candidates
    few = lambda kind: [c for c in whole(kind) if "_24_0.003_0.0001_0" in c.name]
    monkeypatch.setattr(chart_claim, "candidates", few)
    fine = chart_claim.fine_options
    coarse = {"-domain_cells": "64,64", "-time_adapt_tol": "1e-4"}
    monkeypatch.setattr(chart_claim, "fine_options", lambda kind: fine(kind) | coarse)
    points = study.Point("split", 64, dt=1 / 64), study.Point("penalty", 64, dt=1 / 4)
    points = study.Point(study.BEST, 24, tolerance=5e-4), *points
    stiff = lambda point: study.relax_options(point) | ({"-vesicle_bending": "1"} if point.dt == 1 / 4 else {})
    scene = replace(RELAX, points=points, reference=RELAX.reference | coarse, other={}, options=stiff)
    paths = report.write(tmp_path, scenes=(scene,), finest=32)
    names = "chart.csv recommended.csv levels.csv tables.md claim.csv relax_seconds.png relax_solves.png"
    assert {p.name for p in paths} == set(names.split())
    assert all(p.stat().st_size for p in paths)
    with (tmp_path / "chart.csv").open(newline="") as file:
        ours, split, penalty = csv.DictReader(file)
    assert all(row["runs"] == "2" and float(row["cpu_seconds"]) > 0 for row in (ours, split, penalty))
    assert all(float(row["largest"]) == max(float(row["shape"]), float(row["energy"])) for row in (ours, split))
    assert 10 * float(ours["shape"]) < float(split["shape"]) < 0.02
    assert 2 * float(ours["solves"]) < float(split["solves"])
    assert penalty["message"] and not penalty["shape"] and not split["message"]
    assert penalty["message"] in (tmp_path / "tables.md").read_text()
    with (tmp_path / "recommended.csv").open(newline="") as file:
        found = [(row["level"], row["cells"]) for row in csv.DictReader(file)]
        assert found == [(level, "24") for level in ("0.01", "0.001", "0.0001")]
    with (tmp_path / "claim.csv").open(newline="") as file:
        found = list(csv.DictReader(file))
    assert [row["scene"] for row in found] == ["relax", "relax", "relax", "shear", "shear"]
    for mine, theirs in ((found[0], found[1]), (found[3], found[4])):
        assert float(mine["error"]) <= float(theirs["error"])
        assert 8 * 24**2 * float(mine["solves"]) < 64**2 * float(theirs["solves"])
    assert float(found[2]["error"]) == pytest.approx(float(found[1]["error"]), rel=0.01)  # solves to 1e-12

    monkeypatch.setattr("studies.common.engine.run_program", lambda *words: pytest.fail("run again"))
    monkeypatch.setattr(report, "picture", lambda *words: tmp_path)  # drawn once
    kept = (tmp_path / "chart.csv").read_text()
    report.write(tmp_path, scenes=(scene,), finest=32)
    assert (tmp_path / "chart.csv").read_text() == kept
    results = Results(tmp_path / "chart.json")
    assert all(entry["commit"] and entry["measures"]["cpu_seconds"] > 0 for entry in results.entries.values())
