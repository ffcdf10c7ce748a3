"""valgrind's memcheck finds no error with a petves function on the stack."""

import shutil
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from conftest import PETVES, SANITIZE, mpirun

OPENMPI = Path("/usr/share/openmpi/openmpi-valgrind.supp")
OPTIONS = (
    "-domain_cells 24,24 -vesicle_semi_axes 0.3,0.5 -flow_type shear -time_step 0.01 -time_end 0.03 -output_every 0.01"
)
OBJECTS = ("libpetves.so", "bin/petves")

if not SANITIZE:  # the sanitizers and valgrind do not go together

    @pytest.mark.parametrize("form", ["disturbance", "total"])
    def test_memory_is_used_as_it_should(form, tmp_path):
        assert shutil.which("valgrind")
        wrapper = ("valgrind", "--xml=yes", f"--xml-file={tmp_path}/%p.xml", "--leak-check=no", "--num-callers=40")
        suppressions = [f"--suppressions={OPENMPI}"] if OPENMPI.exists() else []
        options = [*OPTIONS.split(), "-flow_form", form, "-output_dir", str(tmp_path / "out")]
        done = mpirun([*suppressions, PETVES, *options], 2, wrapper=wrapper)
        assert done.returncode == 0, done.stdout + done.stderr
        reports = sorted(tmp_path.glob("*.xml"))
        assert len(reports) == 2
        ours = [
            describe(error)
            for report in reports
            for error in ET.parse(report).getroot().iter("error")
            if is_ours(error)
        ]
        assert not ours, "\n\n".join(ours)

    def is_ours(error) -> bool:
        """Some frame lies in petves; for a leak, some frame beyond those that start and end PETSc and MPI."""
        names = [f.findtext("fn", "") for f in error.iter("frame") if f.findtext("obj", "").endswith(OBJECTS)]
        if error.findtext("kind", "").startswith("Leak_"):
            names = [name for name in names if name not in ("main", "PetvesInitialize", "PetvesFinalize")]
        return bool(names)

    def describe(error) -> str:
        frames = [f"{f.findtext('fn')} ({f.findtext('file')}:{f.findtext('line')})" for f in error.iter("frame")]
        return "\n  ".join([error.findtext("what", error.findtext("xwhat/text", "?")), *frames])
