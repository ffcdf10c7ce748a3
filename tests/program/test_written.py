"""How much a run writes: frames by default, their precision, and what the run says of it."""

import numpy as np
import pytest
from harness import run_petves
from refusals import refused
from restarts import frames, without_wall

SMALL = "-domain_cells 32,32 -vesicle_semi_axes 0.4,0.5 -flow_type shear"
FIELDS = ("fluid/u", "fluid/v", "fluid/p", "vesicle/markers", "vesicle/velocity", "vesicle/tension")


@pytest.mark.parametrize(
    "end, every, count",
    [(0.25, 0.1, 4), (9.9, 0.1, 100), (9.91, 0.2, 51), (36, 0.5, 73), (99, 1, 100), (2.1e4, 500, 43)],
)
def test_a_run_has_at_most_100_frames(end, every, count, tmp_path):
    """Without vesicles, at rest, in steps that the times saved are multiples of; the end is saved too."""
    options = f"-vesicle_shape none -domain_cells 8,8 -time_step {every / 2} -time_end {end} -view"
    run = run_petves(tmp_path / "run", options)
    assert float(run.resolved["-output_every"]) == pytest.approx(every, rel=1e-9)
    times = run.saved("time", "run.h5")
    assert len(times) == count and times[-1] == pytest.approx(end, rel=1e-12)
    assert run.summary["written"]["frames"] == count


def test_what_was_written_is_said(tmp_path):
    run = run_petves(tmp_path / "run", f"{SMALL} -time_step 0.01 -time_end 0.03 -output_every 0.01 -checkpoint_every 1")
    written = run.summary["written"]
    sizes = {path.name: path.stat().st_size for path in run.folder.iterdir()}
    names = ("run.h5", "run.xmf", "series.csv", "checkpoint.h5", "checkpoint_1.h5")
    assert set(sizes) - set(names) <= {"resolved.opts", "summary.json"}
    assert written == {"frames": 4, "bytes": sum(sizes[name] for name in names), "bytes_run_h5": sizes["run.h5"]}
    line = f"files in {run.folder}: {written['bytes'] / 1e6:.3g} MB, {sizes['run.h5'] / 1e6:.3g} MB of them run.h5 with 4 frames"
    assert line in run.stdout


def test_single_precision(tmp_path):
    """The fields alone, rounded, on any number of ranks; the run is the same, and goes on with no other precision."""
    options = f"{SMALL} -domain_cells 48,48 -time_step 0.01 -time_end 0.03 -output_every 0.01"
    double = run_petves(tmp_path / "double", options)
    single = run_petves(tmp_path / "single", f"{options} -output_precision single", 2)
    one = run_petves(tmp_path / "one", f"{options} -output_precision single")
    assert without_wall(one.folder) == without_wall(double.folder)
    exact, rounded, others = frames(double.folder), frames(one.folder), frames(single.folder)
    for name in FIELDS:
        small = name.startswith("fluid")
        assert rounded[name].dtype == (np.float32 if small else np.float64), name
        np.testing.assert_array_equal(rounded[name], exact[name].astype(np.float32) if small else exact[name])
        np.testing.assert_allclose(others[name], exact[name], rtol=1e-6, atol=1e-7 * np.abs(exact[name]).max())
    assert (one.folder / "run.h5").stat().st_size < 0.62 * (double.folder / "run.h5").stat().st_size
    text = (one.folder / "run.xmf").read_text()
    assert text.count('"Float" Precision="4"') == 3 * 4 and text.count('"Float" Precision="8"') == 2 * 4
    restart = f"{options} -time_end 0.04 -restart {one.folder}/checkpoint.h5"
    refused(one.folder, f"{restart} -output_precision double", "-output_precision double: the checkpoint of")
