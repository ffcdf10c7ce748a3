"""A fast solve that does not converge (back end hypre, which iterates) is a failed step on every rank alike: the run ends,
one line names the options' prefix and the reason, and the last good state is on disk."""

import re

import pytest
from harness import PETVES, ROOT, Run, mpirun, preloaded, run_petves, without_mpirun
from refusals import SMALL, leaves_files


def reason(prefix: str, its: int) -> str:
    """Pattern of the message, up to its advice."""
    return (
        rf"^the solve with prefix {prefix} failed in step \d+ at time [\d.e-]+: DIVERGED_ITS after {its} iterations, "
        rf"residual [\d.e-]+; try a smaller -time_step, more iterations \(-{prefix}ksp_max_it\)"
    )


@pytest.mark.parametrize("ranks", [1, 3])
@pytest.mark.parametrize("solver", ["helmholtz", "poisson"])
@pytest.mark.parametrize("scheme", ["split", "penalty"])
def test_fast_solve_that_fails_ends_the_run(scheme, solver, ranks, tmp_path):
    """In the first step: the state on disk is the initial one."""
    options = f"{SMALL} -scheme_type {scheme} -{solver}_type hypre -{solver}_ksp_max_it 1"
    run = run_petves(tmp_path / "out", options, ranks, good=False, timeout=60)
    summary, series = leaves_files(run, reason(f"{solver}_", 1))
    assert "in step 1 at time 0.01:" in summary["reason"]
    assert list(series["step"]) == [0]


#: Five iterations are enough for H of a small step, and no longer for that of a large one.
LARGER_STEPS = "-domain_cells 32,32 -time_step 0.1 -scheme_type split -helmholtz_type hypre -helmholtz_ksp_max_it 5"


@pytest.mark.parametrize("ranks", [1, 3])
def test_fast_solve_that_fails_later_keeps_the_steps_before(ranks, tmp_path):
    """A run goes on from its checkpoint with larger steps; step and time in the line are those of the step that failed."""
    first = run_petves(tmp_path / "out", f"{LARGER_STEPS} -time_step 0.003 -time_end 0.009", ranks, timeout=120)
    restart = f"-restart {first.folder}/checkpoint.h5 -time_step 1 -time_end 5"
    run = run_petves(tmp_path / "out", f"{LARGER_STEPS} {restart}", ranks, good=False, timeout=120)
    summary, series = leaves_files(run, reason("helmholtz_", 5))
    step, time = re.search(r"in step (\d+) at time ([\d.e-]+):", summary["reason"]).groups()
    assert series["step"][-1] >= 3 and int(step) == series["step"][-1] + 1
    assert series["time"][-1] < float(time) < 5


def test_fast_solve_without_vesicle(tmp_path):
    """No outer iteration sees the failed solve: what the step leaves is looked at."""
    options = "-domain_cells 32,32 -time_step 0.1 -time_end 1 -scheme_type split -vesicle_shape none"
    options += " -flow_type shear -flow_form total -helmholtz_type hypre -helmholtz_ksp_max_it 1"
    run = run_petves(tmp_path / "out", options, 2, good=False, timeout=60)
    assert run.status == 2 and len(run.errors) == 1
    assert re.search(reason("helmholtz_", 1), run.errors[0].removeprefix("petves: error: "))
    assert (run.folder / "checkpoint.h5").exists()


#: A LAPACK whose factorisations fail from the FAIL-th call on, and an MPI whose FAIL_MPI-th sum does.
FAILING = r"""
#include <mpi.h>
#include <stdlib.h>
int MPI_Allreduce(const void *a, void *b, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm) {
  static int calls;
  if (getenv("FAIL_MPI") && ++calls == atoi(getenv("FAIL_MPI"))) return MPI_ERR_OTHER;
  return REAL(MPI_Allreduce)(a, b, n, type, op, comm);
}
static int fails(void) { static int calls; return getenv("FAIL") && ++calls >= atoi(getenv("FAIL")); }
void dgetrf_(int *m, int *n, double *A, int *lda, int *pivot, int *info) {
  REAL(dgetrf_)(m, n, A, lda, pivot, info);
  if (fails()) *info = 7;
}
"""


def failing_from(call: int, folder, what: str = "FAIL") -> tuple[str, ...]:
    """Return the words before a program whose factorisations fail from this call on (FAIL), or this sum of MPI (FAIL_MPI)."""
    return ("env", f"LD_PRELOAD={preloaded(folder, FAILING, 'mpicc')}", f"{what}={call}")


def test_dense_blocks_serve_many_steps(tmp_path):
    """120 steps of runs/free.opts, whose first one is dear, make fewer than 20 factors; they once made one or two each."""
    options = f"-options_file {ROOT}/runs/free.opts -time_end 18.4 -output_every 1e9 -checkpoint_every 0"
    done = mpirun([PETVES, "-output_dir", str(tmp_path / "out"), *options.split()], 1, 60, failing_from(20, tmp_path))
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("ranks", [1, 3])
def test_matrix_without_factor_ends_the_run(ranks, tmp_path):
    """The dense blocks of the preconditioner, on the one rank that owns the vesicle: every rank ends, one line, status 2,
    the last good state on disk."""
    options = "-domain_cells 32,32 -flow_type shear -flow_rate 10 -time_step 0.02 -time_end 2 -checkpoint_every 0"
    words = [PETVES, "-output_dir", str(tmp_path / "out"), *options.split()]
    done = mpirun(words, ranks, 60, failing_from(7, tmp_path))
    run = Run(tmp_path / "out", done.returncode, done.stdout, without_mpirun(done.stderr))
    line = reason("coupled_", 0).replace("ITS", "PC_FAILED")
    _, series = leaves_files(run, line.replace(r"[\d.e-]+;", r"\S+;"))
    assert series["step"][-1] > 1


@pytest.mark.parametrize("call, where", [(20, ""), (300, " (")], ids=["setup", "step"])
@pytest.mark.parametrize("failing", [0, 1])
def test_an_error_of_one_rank_ends_all(failing, call, where, tmp_path):
    """MPI fails in one call on one rank; the other waits for it, and would for ever. Its line says so, whichever rank."""
    scene = "-domain_cells 16,16 -vesicle_semi_axes 0.3,0.5 -time_step 0.01 -time_end 0.1".split()
    run = [PETVES, "-output_dir", str(tmp_path / "out"), *scene]
    ranks = [["-n", "1", *run], ["-n", "1", *failing_from(call, tmp_path, "FAIL_MPI"), *run]]
    done = mpirun(["mpirun", *ranks[1 - failing], ":", *ranks[failing]], 1, timeout=30)
    lines = [line for line in without_mpirun(done.stderr) if line.startswith("petves: ")]
    assert done.returncode == 1 and len(lines) == 1
    assert lines[0].startswith(f"petves: error: MPI error 16 MPI_ERR_OTHER: known error not in list{where}")
