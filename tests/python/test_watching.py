"""petves watch: a page that is drawn anew while a run goes on; run(live=True): a picture in a notebook that is replaced."""

import re
import signal
import subprocess
import time

import pytest
from harness import ENVIRONMENT, PETVES, SANITIZE, wait_for

import petves
from petves.views.watch import goes_on

SCENE = "-domain_cells 32,32 -flow_type shear -vesicle_semi_axes .4,.6 -time_step 0.001 -output_every 0.01"
SCENE += " -time_end 1000"


def test_a_page_follows_a_run_to_its_end(tmp_path, monkeypatch):
    """Pages are drawn while the run goes on, which reload themselves; the last one, after the run was stopped, does not."""
    folder, pages = tmp_path / "run <1>", []
    words = [PETVES, *SCENE.split(), "-output_dir", str(folder)]
    run = subprocess.Popen(words, env=ENVIRONMENT, stdout=subprocess.DEVNULL)
    try:
        wait_for((folder / "run.lock").exists)
        real = time.sleep

        def pause(seconds):
            if seconds != 7:  # a file that is just being written is read again
                return real(seconds)
            pages.append((folder / "watch.html").read_text())
            if len(pages) == 2:
                run.send_signal(signal.SIGTERM)
                run.wait(60)
            return real(0.5)

        monkeypatch.setattr("petves.views.watch.time.sleep", pause)
        assert petves.watch(folder, every=7) == folder / "watch.html"
    finally:
        run.kill()
        run.wait()
    assert len(pages) == 2 and not goes_on(folder)
    for page in pages:
        assert 'http-equiv="refresh" content="7"' in page and "The run goes on" in page and "run &lt;1&gt;" in page
    last = (folder / "watch.html").read_text()
    assert "refresh" not in last and "The run has ended" in last and "__" not in last
    pictures = re.findall(r'src="(\w+\.png)\?\d+"', last)
    assert {"field.png", "energy.png", "motion.png"} <= set(pictures)
    assert all((folder / name).is_file() for name in pictures)


def test_a_folder_without_a_saved_time_is_told(tmp_path):
    page = petves.watch(tmp_path).read_text()
    assert "no such file" in page and "<img" not in page
    with pytest.raises(petves.Error, match="no such folder"):
        petves.watch(tmp_path / "nowhere")


if not SANITIZE:  # a sanitized library cannot be loaded into Python

    def test_live_replaces_its_picture(tmp_path, monkeypatch):
        """Shown once, replaced while the run goes on, at last with its end; a callback is called as well."""
        display = pytest.importorskip("IPython.display")
        shown, seen = [], []

        class Handle:
            def update(self, image):
                shown.append(image.data)

        monkeypatch.setattr(display, "display", lambda image, display_id: shown.append(image.data) or Handle())
        scene = dict(domain_cells=(24, 24), flow_type="shear", time_end=0.03, time_step=0.01)
        with petves.Simulation(**scene, output_dir=tmp_path / "run") as sim:
            assert sim.run(live=True, callback=lambda s: seen.append(s.time)) == "finished"
        assert len(seen) == 3 and len(shown) >= 2 and all(data[:4] == b"\x89PNG" for data in shown)
        assert shown[0] != shown[-1]
