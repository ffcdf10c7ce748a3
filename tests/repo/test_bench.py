"""The bench: its programs run, what they count keeps the bounds of docs/evidence.md, a bench that was stopped goes on,
and the fits find what they are given."""

import json
import os
import sys

import numpy as np
import pytest
from harness import PROGRAMS, ROOT, mpirun

sys.path.insert(0, str(ROOT / "bench"))
import bench  # noqa: E402
import model  # noqa: E402
import report  # noqa: E402

BENCHES = PROGRAMS.parent / "bench"


def objects(program: str, options: str, ranks: int = 1) -> list[dict]:
    done = mpirun([str(BENCHES / program), *options.split()], ranks)
    assert done.returncode == 0, done.stdout + done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def steps(options: str, warmup: int, count: int) -> dict[str, object]:
    (found,) = objects("bench_step", f"-bench_warmup {warmup} -bench_steps {count} {bench.SCENE} {options}")
    return found


@pytest.mark.parametrize("ranks", [1, 2])
def test_fast_solves_are_timed(ranks):
    """Three fields and a Stokes solve in three boxes; every back end's residual is small."""
    lines = objects("bench_solve", f"-cells 32 -repeats 3 -hypre {'true' if ranks == 1 else 'false'}", ranks)
    found = [(line["box"], line["what"]) for line in lines]
    assert found == [(box, what) for box in ("walls", "channel", "periodic") for what in ("u", "v", "p", "stokes")]
    for line in lines:
        assert line["ranks"] == ranks and line["cells"] == 32
        for name in ("copy", "fftw_tridiagonal", "fftw", "hypre"):
            if name in line:
                assert len(line[name]) == 3 and min(line[name]) > 0
        if line["what"] != "stokes":
            assert line["fftw_tridiagonal_residual"] < 1e-12 and line["fftw_residual"] < 1e-12
            assert ("hypre" in line) == (ranks == 1) and line.get("hypre_residual", 0) < 1e-11


@pytest.mark.parametrize("box", ["channel", "periodic"])
def test_coupled_takes_few_solves_in_steady_tank_treading(box):
    """At most 15 scalar solves in every step, from t = 8 on, at the default tolerance of 1e-6."""
    found = steps(f"{bench.BOXES[box]} -scheme_type coupled -domain_cells 96,96", 320, 60)
    assert max(found["nsolve"]) <= 15 and min(found["coupled_its"]) > 0


@pytest.mark.skipif(bool(os.environ.get("SANITIZE")), reason="the sanitizers take memory of their own")
@pytest.mark.parametrize("box", bench.BOXES)
def test_memory_a_cell(box):
    """Growth of the peak memory from 256^2 to 512^2 cells: at most 60 doubles a cell."""
    scene = f"{bench.BOXES[box]} -scheme_type coupled -domain_cells"
    memory = [steps(f"{scene} {n},{n}", 1, 4)["memory"] for n in (256, 512)]
    assert (memory[1] - memory[0]) / (512**2 - 256**2) / 8 <= 60


def test_stopped_bench_goes_on(tmp_path, monkeypatch):
    """Rounds in turn; what is in the file is not measured again."""
    made = []

    def fake(run):
        made.append(run.name)
        if len(made) == 4:
            raise KeyboardInterrupt
        return [{"step": [1.0]}]

    monkeypatch.setattr(bench, "measure", fake)
    runs = [bench.Run("a", "", "", rounds=3), bench.Run("b", "", "", rounds=2)]
    with pytest.raises(KeyboardInterrupt):
        bench.run_item("item", runs, tmp_path)
    bench.run_item("item", runs, tmp_path)
    assert made == ["a", "b", "a", "b", "b", "a"]
    assert list(json.loads((tmp_path / "item.json").read_text())) == ["a #0", "b #0", "a #1", "b #1", "a #2"]


def test_items_have_the_sizes_of_the_targets():
    """Both ranks, every box, 128^2 to 2048^2; QUICK has the same items."""
    full, quick = (bench.items(value) for value in (False, True))
    assert list(full) == list(quick)
    assert {run.name for run in full["size"]} >= {f"coupled {n} channel 1" for n in (128, 256, 512, 1024, 2048, 4096)}
    assert {run.name for run in full["ranks"]} >= {f"coupled 1000x480 suspension {r}" for r in (1, 2)}
    assert {run.name for run in full["share"]} >= {f"{s} 512 {b} {r}" for s in ("split", "coupled") for b in bench.BOXES for r in (1, 2)}  # fmt: skip


def test_tables_have_what_was_measured(tmp_path):
    """The tables of docs/performance are those of bench/results."""
    for path in report.report(ROOT / "bench" / "results", tmp_path):
        kept = ROOT / "docs" / "performance" / path.name
        assert kept.is_file() and (path.suffix != ".csv" or path.read_text() == kept.read_text()), path.name


def test_fits_find_what_they_are_given():
    """N log N has no deviation from itself; rates put into the model come out of the fit."""
    cells = np.array([128, 256, 512, 1024])
    c, deviation = report._deviation(cells, 3e-9 * cells**2 * np.log2(cells**2))
    assert c == pytest.approx(3e-9) and np.abs(deviation).max() < 1e-12
    rates = model.Rates(2e-10, 1e-10, 4e-5, 3e-6, 5e-9)
    measured = []
    for s in map(model.finer, cells):
        solve = s.n**2 * (rates.flop * model.solve_flops(s) + rates.byte * model.solve_bytes(s))
        measured.append((s, solve, model.seconds(s, rates, 1, "petves") - solve))
    found, deviation = model.fit(measured, rates.byte)
    assert found.flop == pytest.approx(rates.flop) and found.marker == pytest.approx(rates.marker)
    assert found.dense == pytest.approx(rates.dense) and found.step == pytest.approx(rates.step) and deviation < 1e-9
