"""Fixtures and hooks of the tests: the search path, locks of the workers, and one plain line of counts at the end."""

import fcntl
import functools
import os
import sys
import tempfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
#: What the tests share, the package, and the studies of docs/.
sys.path[:0] = [str(ROOT / folder) for folder in ("tests/support", "python", "")]

from harness import run_petves  # noqa: E402


@pytest.fixture(scope="session")
def cached_run(tmp_path_factory):
    """run_petves for runs that several tests look at: each is made once."""
    made = functools.cache(lambda options, ranks: run_petves(tmp_path_factory.mktemp("run"), options, ranks))
    return lambda options, ranks=1: made(options, ranks)


@pytest.fixture
def here(tmp_path, monkeypatch):
    """The test's own folder, in which it runs."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


#: Files that last longest, in the order in which their tests are handed to workers, so that none is begun last.
LONG = "valgrind views runs docs newcomer programs output_faults restart accuracy tools one_folder damaged".split()
LONG += "metamorphic studies fuzz pictures chart coupled unlike_ranks forged packaging output stability".split()
LONG += "python python_package interrupted free_bodies elastic obstacles contrast baselines".split()


def pytest_configure(config):
    """`make test` has two workers (pytest-xdist). The process that starts them makes the folder of their locks."""
    config.addinivalue_line("markers", "alone: measures time, so that no other test may run meanwhile")
    config.addinivalue_line("markers", "xdist_group(name): tests of one name run on one worker, and share its runs")
    if not hasattr(config, "workerinput") and config.getoption("numprocesses", None):
        config.petves_locks = tempfile.TemporaryDirectory(prefix="petves-tests-")
        os.environ["PETVES_TEST_LOCKS"] = config.petves_locks.name


def pytest_collection_modifyitems(items):
    """Those marked alone are first, while no other test has to end before them."""
    order = {f"test_{name}": place for place, name in enumerate(LONG)}
    place = lambda item: -1 if item.get_closest_marker("alone") else order.get(item.path.stem, len(LONG))
    items.sort(key=place)


def pytest_terminal_summary(terminalreporter):
    """The rules of the house that are still broken, after a run of the test that reads the list."""
    if any("test_no_rule_is_broken" in node for node in _passed | _failed):
        terminalreporter.section("house_exceptions.txt")
        terminalreporter.write((ROOT / "tests" / "repo" / "house_exceptions.txt").read_text())


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item):
    """Tests of two workers share the machine, but for those marked alone. The gate lets tests in one after
    another, so that one that waits to be alone is not passed by later ones."""
    folder = os.environ.get("PETVES_TEST_LOCKS")
    if not folder:
        yield
        return
    with open(Path(folder) / "gate", "w") as gate, open(Path(folder) / "lock", "w") as lock:
        fcntl.flock(gate, fcntl.LOCK_EX)
        fcntl.flock(lock, fcntl.LOCK_EX if item.get_closest_marker("alone") else fcntl.LOCK_SH)
        fcntl.flock(gate, fcntl.LOCK_UN)
        yield


_passed: set[str] = set()
_failed: set[str] = set()


def pytest_runtest_logreport(report):
    if report.failed:
        _failed.add(report.nodeid)
    elif report.when == "call" and report.passed:
        _passed.add(report.nodeid)


def pytest_collectreport(report):
    if report.failed:
        _failed.add(report.nodeid)


def pytest_unconfigure(config):
    """The last line of all; errors of set-up or collection count as failures. Workers leave it to the process
    that started them."""
    if hasattr(config, "workerinput"):
        return
    if hasattr(config, "petves_locks"):
        config.petves_locks.cleanup()
        os.environ.pop("PETVES_TEST_LOCKS")
    if not config.option.collectonly:
        print(f"{len(_passed - _failed)} passed, {len(_failed)} failed", flush=True)
