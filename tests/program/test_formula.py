"""A background flow by formulas of the options file: equal to the built-in flow, and to a function of Python's."""

import numpy as np
import pytest
from harness import PETVES, ROOT, mpirun, run_petves, run_python
from restarts import without_wall

SMALL = "-domain_cells 32,32 -vesicle_semi_axes 0.35,0.5 -vesicle_angle 20 -time_step 0.02 -time_end 0.2"
CALLBACK = """
import sys
import numpy as np, petves

channel = lambda x, y, t: ((1 - y**2) * (1 + 0.8 * np.sin(np.pi * t)), 0)
with petves.Simulation(sys.argv[1], flow=channel, time_end=0.8, output_dir=sys.argv[3]) as sim:
    sim.run()
    own = sim.markers.copy(), [field.copy() for field in sim.cell_velocity()]
with petves.Simulation(sys.argv[2], time_end=0.8, output_dir=sys.argv[4]) as sim:
    sim.run()
    assert sim.options["flow_type"] == "formula" and "formula" in repr(sim)
    assert np.abs(sim.markers - own[0]).max() < 1e-12
    assert all(np.abs(a - b).max() < 1e-12 for a, b in zip(sim.cell_velocity(), own[1]))
print("facts hold")
"""


@pytest.mark.parametrize(
    "flow, formula",
    [
        ("shear -flow_rate 1.5 -flow_center_y 0.1", ["-flow_u", "1.5 * (y - 0.1)"]),
        ("extension -flow_rate -0.7", ["-flow_u", " -0.7*x", "-flow_v", "0.7*y"]),
    ],
)
def test_the_built_in_flow(flow, formula, tmp_path):
    built_in = run_petves(tmp_path / "type", f"{SMALL} -fluid_inertia none -flow_type {flow}")
    words = f"{SMALL} -fluid_inertia none".split()
    done = mpirun([PETVES, *words, *formula, "-output_dir", str(tmp_path / "formula")], 1)
    assert done.returncode == 0, done.stderr
    by_formula = type(built_in)(tmp_path / "formula", 0, "", [])
    for name in ("vesicle/markers", "vesicle/tension", "fluid/u", "fluid/v"):
        expected = built_in.saved(name, "run.h5")
        assert np.abs(by_formula.saved(name, "run.h5") - expected).max() < 1e-12 * max(1, np.abs(expected).max()), name


def test_a_pulsating_flow_as_from_python(tmp_path):
    """runs/formula.opts, read by the program's own rules, against the same flow of a callback."""
    scene = (ROOT / "runs" / "formula.opts").read_text()
    (tmp_path / "callback.opts").write_text("".join(line for line in scene.splitlines(True) if "-flow_u" not in line))
    (tmp_path / "facts.py").write_text(CALLBACK)
    words = [tmp_path / "callback.opts", ROOT / "runs" / "formula.opts", tmp_path / "callback", tmp_path / "formula"]
    done = run_python(tmp_path / "facts.py", *map(str, words), ranks=2)
    assert done.returncode == 0 and "facts hold" in done.stdout, done.stderr


def test_it_is_written_and_goes_on_after_a_restart(tmp_path):
    """resolved.opts repeats formulas with blanks, quotes' marks and a dash; a restart gives the bits of the whole run."""
    (tmp_path / "f.opts").write_text(
        "\n".join(f"-{line}" for line in SMALL[1:].split(" -"))
        + "\n-flow_u \"-y * exp(-t)\"  # a comment\n-flow_v 'max(0, sin(3*t)) * x^2'\n"
    )
    file = ["-options_file", str(tmp_path / "f.opts")]
    done = mpirun([PETVES, *file, "-view", "-output_dir", str(tmp_path / "whole")], 1)
    assert done.returncode == 0, done.stderr
    assert "background flow: formula, u = -y * exp(-t), v = max(0, sin(3*t)) * x^2\n" in done.stdout
    resolved = (tmp_path / "whole" / "resolved.opts").read_text()
    assert '\n-flow_u "-y * exp(-t)"\n-flow_v "max(0, sin(3*t)) * x^2"\n' in resolved
    half = ["-options_file", str(tmp_path / "whole" / "resolved.opts"), "-output_dir", str(tmp_path / "half")]
    assert mpirun([PETVES, *half, "-time_end", "0.1", "-checkpoint_every", "1"], 1).returncode == 0
    assert mpirun([PETVES, *half, "-restart", str(tmp_path / "half" / "checkpoint.h5")], 1).returncode == 0
    assert without_wall(tmp_path / "half" / "series.csv") == without_wall(tmp_path / "whole" / "series.csv")
    changed = [*half, "-restart", str(tmp_path / "half" / "checkpoint.h5"), "-flow_v", "0"]
    done = mpirun([PETVES, *changed, "-time_end", "1"], 1)
    assert done.returncode == 1 and "-flow_v" in done.stderr, done.stderr
