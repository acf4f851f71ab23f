"""A student works on step 03 in JupyterLab, in a browser."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from grader.exercise.markers import HASH, solved
from grader.exercise.model import course_folder
from grader.notebook.kernel import DISPLAY_NAME, install
from grader.tests.browser import browser_or_reason, launched, new_page
from grader.tests.notebook.jupyterlab import run_all, serving, type_cell

STEP = "03-circle-publisher"
ROOT = course_folder().parent
NODE = "my_robot_controller/my_robot_controller/draw_circle.py"


@pytest.mark.exhaustive
def test_a_student_solves_the_released_notebook(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    executable = browser_or_reason()
    monkeypatch.setenv("XDG_CACHE_HOME", os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache"))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("JUPYTER_DATA_DIR", str(tmp_path / ".local/share/jupyter"))
    install()
    shutil.copytree(ROOT / "exercises" / STEP, tmp_path / "work" / STEP)
    pictures = Path(os.environ.get("SCREENSHOTS") or tmp_path)
    with serving(tmp_path / "work", tmp_path) as address, launched(executable) as browser:
        page = new_page(browser, viewport={"width": 1280, "height": 1000})
        page.goto(address.replace("PATH", f"{STEP}/{STEP}.ipynb"))
        page.get_by_role("heading", name="Step 03: draw a circle").first.wait_for()
        # The kernel that the notebook names is installed, so JupyterLab does not open a dialog to choose a kernel.
        page.get_by_text(DISPLAY_NAME).first.wait_for()
        page.screenshot(path=pictures / "lab-1-opened.png")

        solution = solved((ROOT / "solutions" / STEP / NODE).read_text("utf-8"), HASH, NODE)
        type_cell(page, "%%node draw_circle.py", f"%%node draw_circle.py\n{solution}")
        run_all(page)

        # The turtle moves while the node runs, so new pictures replace old ones.
        canvas = page.locator(".jp-OutputArea img").last
        canvas.wait_for()
        before = canvas.get_attribute("src")
        page.wait_for_function(
            "before => [...document.querySelectorAll('.jp-OutputArea img')].at(-1).src !== before", arg=before
        )
        # Scroll to the cell below, because the image is replaced five times per second.
        page.get_by_role("heading", name="Check it").scroll_into_view_if_needed()
        page.screenshot(path=pictures / "lab-2-simulator.png")

        verdict = page.locator(".ros2-verdict")
        verdict.wait_for()
        assert "Passed: 100 of 100 points." in verdict.inner_text()
        assert verdict.locator("svg.picture").count() >= 3
        verdict.scroll_into_view_if_needed()
        page.screenshot(path=pictures / "lab-3-verdict.png")

        last = page.locator(".jp-CodeCell", has_text='points("timer")').last
        last.locator(".jp-OutputArea-executeResult").wait_for()
        points = page.locator(".jp-CodeCell", has_text='points("circle")').last
        points.scroll_into_view_if_needed()
        # JupyterLab draws a cell only when it is visible.
        points.get_by_text("25.0", exact=True).wait_for()
        page.screenshot(path=pictures / "lab-4-points.png")
    assert (tmp_path / "work" / STEP / NODE).read_text("utf-8") == solution
