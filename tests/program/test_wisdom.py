"""-fftw_wisdom: what FFTW measured in one run serves the next."""

import pytest
from harness import run_petves
from refusals import SMALL, stops_with
from restarts import last_state

SCENE = "-scheme_type coupled -domain_cells 40,40 -time_step 0.01 -time_end 0.03 -fftw_plan measure"


@pytest.mark.parametrize("solver", ["fftw_tridiagonal", "fftw"])
@pytest.mark.parametrize("ranks", [1, 2])
def test_later_runs_plan_from_the_file(ranks, solver, tmp_path):
    """Measured plans vary from run to run, and from rank to rank; with the file they are the same, and so is every bit
    of the results. Such runs add nothing to the file."""
    path = tmp_path / "wisdom"
    options = f"{SCENE} -helmholtz_type {solver} -poisson_type {solver} -fftw_wisdom {path}"
    run_petves(tmp_path / "0", options, ranks)
    text = path.read_text()
    assert text.startswith("(fftw-") and text.count("\n") > 10
    changed = path.stat().st_mtime_ns
    runs = [run_petves(tmp_path / name, options, ranks) for name in "12"]
    assert path.read_text() == text and path.stat().st_mtime_ns == changed
    assert [p.name for p in tmp_path.iterdir() if p.name.startswith("wisdom")] == ["wisdom"]
    one, other = (last_state(run.folder) for run in runs)
    for name in one:
        assert one[name].tobytes() == other[name].tobytes(), name


def test_file_grows_with_other_transforms(tmp_path):
    """A scene of another width adds its plans and keeps the first ones."""
    path = tmp_path / "wisdom"
    run_petves(tmp_path / "0", f"{SCENE} -fftw_wisdom {path}")
    first = set(path.read_text().splitlines())
    run_petves(tmp_path / "1", f"{SCENE} -domain_cells 48,48 -fftw_wisdom {path}")
    assert first < set(path.read_text().splitlines())


@pytest.mark.parametrize("text", ["no wisdom\n", "", "(fftw-3.3.10 fftw_wisdom #x0 #x0 #x0 #x0\n)\n"])
def test_bad_wisdom_is_named(text, tmp_path):
    path = tmp_path / "wisdom"
    path.write_text(text)
    run = run_petves(tmp_path / "out", f"{SMALL} -fftw_wisdom {path}", 2, good=False, timeout=60)
    stops_with(run, [f"-fftw_wisdom {path}", "not wisdom", "allowed"])
    assert path.read_text() == text
