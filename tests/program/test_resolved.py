"""resolved.opts repeats the run, whatever its folder and its files are called."""

from pathlib import Path

import numpy as np
import pytest
from harness import PETVES, mpirun, run_petves
from restarts import without_wall


@pytest.mark.parametrize(
    "name",
    ["two words", "out/ü 'é' ", " before", "back\\slash%s$HOME", "it's", "pipe|;*?[1]~", "a,b=c", "a #b", "#", "'"],
)
def test_resolved_options_repeat_the_run(name, tmp_path, monkeypatch):
    """In a folder of any name that is not refused, and with a curve file of that name."""
    monkeypatch.chdir(tmp_path)
    angle = 2 * np.pi * np.arange(40) / 40
    Path("curve").mkdir()
    curve = Path("curve") / name.replace("/", "")
    np.savetxt(curve, 0.4 * np.c_[np.cos(angle), np.sin(angle)])
    words = f"-domain_cells 24,24 -output_every 10 -vesicle_shape file -time_end 0.02".split()
    words = [*words, "-vesicle_file", str(curve), "-output_dir", name]
    assert mpirun([PETVES, *words], 1).returncode == 0
    first = Path(name).rename("first")
    done = mpirun([PETVES, "-options_file", "first/resolved.opts"], 1)
    assert done.returncode == 0 and (Path(name) / "run.h5").is_file(), done.stderr
    assert without_wall(Path(name)) == without_wall(first)


def test_poiseuille_flow_goes_from_wall_to_wall(tmp_path):
    """Its half width and its middle are those of walls in y, unless they are given; without walls they stay."""
    channel = "-domain_box 0,2,1,2 -domain_cells 48,24 -domain_bc_x periodic -flow_type poiseuille -vesicle_shape none -time_end 0"
    for words, half_width, middle in (
        ("-domain_bc_y wall", 0.5, 1.5),
        ("-flow_half_width 4 -flow_center_y 0", 4, 0),
        ("-domain_bc_y periodic", 3, 0),
    ):
        lines = run_petves(tmp_path / "out", f"{channel} {words} -output_overwrite").resolved
        assert (float(lines["-flow_half_width"]), float(lines["-flow_center_y"])) == (half_width, middle)
