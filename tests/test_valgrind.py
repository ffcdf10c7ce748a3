"""valgrind's memcheck finds no error with a petves function on the stack."""

import shutil
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from conftest import PAPER, PETVES, SANITIZE, mpirun, run_petves

OPENMPI = Path("/usr/share/openmpi/openmpi-valgrind.supp")
OPTIONS = (
    "-domain_cells 24,24 -vesicle_semi_axes 0.3,0.5 -flow_type shear -time_step 0.01 -time_end 0.03 -output_every 0.01"
)
OBJECTS = ("libpetves.so", "bin/petves")

if not SANITIZE:  # the sanitizers and valgrind do not go together

    def memcheck(options: str, folder: Path, status: int, ranks: int = 2):
        """Run petves under memcheck: its exit status, and no error of ours on any rank."""
        assert shutil.which("valgrind")
        reports = folder / "reports"
        reports.mkdir(exist_ok=True)
        wrapper = ("valgrind", "--xml=yes", f"--xml-file={reports}/%p.xml", "--leak-check=no", "--num-callers=40")
        suppressions = [f"--suppressions={OPENMPI}"] if OPENMPI.exists() else []
        words = [*OPTIONS.split(), *options.split(), "-output_dir", str(folder / "out")]
        done = mpirun([*suppressions, PETVES, *words], ranks, wrapper=wrapper)
        assert done.returncode == status, done.stdout + done.stderr
        found = sorted(reports.glob("*.xml"))
        assert len(found) >= ranks
        errors = [error for report in found for error in ET.parse(report).getroot().iter("error") if is_ours(error)]
        if status == 1:  # a refused run ends as it is
            errors = [error for error in errors if not error.findtext("kind", "").startswith("Leak_")]
        ours = [describe(error) for error in errors]
        assert not ours, "\n\n".join(ours)

    @pytest.mark.parametrize("form, ranks", [("disturbance", 2), ("total", 1)])
    def test_memory_is_used_as_it_should(form, ranks, tmp_path):
        memcheck(f"-flow_form {form}", tmp_path, 0, ranks)

    @pytest.mark.parametrize(
        "options, status, ranks",
        [
            ("", 0, 2),
            ("-time_end 1 -limit_length_error 1e-14", 2, 1),  # the first step is refused
            ("-fluid_viscosity 2", 1, 1),  # another scene
            ("cut off", 1, 1),  # not an option: what happens to the checkpoint
        ],
    )
    def test_memory_of_a_restart(options, status, ranks, tmp_path):
        """A restart under the coupled scheme, one that stops at a limit, and ones that are refused."""
        coupled, path = f"{PAPER} -scheme_type coupled -checkpoint_every 1", tmp_path / "out" / "checkpoint.h5"
        run_petves(tmp_path / "out", f"{OPTIONS} {coupled} -time_end 0.02")
        if options == "cut off":
            path.write_bytes(path.read_bytes()[:5000])
            options = ""
        memcheck(f"{coupled} -restart {path} {options}", tmp_path, status, ranks)

    def is_ours(error) -> bool:
        """Some frame lies in petves; for a leak, some frame beyond those that start and end PETSc and MPI."""
        names = [f.findtext("fn", "") for f in error.iter("frame") if f.findtext("obj", "").endswith(OBJECTS)]
        if error.findtext("kind", "").startswith("Leak_"):
            names = [name for name in names if name not in ("main", "PetvesInitialize", "PetvesFinalize")]
        return bool(names)

    def describe(error) -> str:
        frames = [f"{f.findtext('fn')} ({f.findtext('file')}:{f.findtext('line')})" for f in error.iter("frame")]
        return "\n  ".join([error.findtext("what", error.findtext("xwhat/text", "?")), *frames])
