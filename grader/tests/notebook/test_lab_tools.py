"""nbgrader's tools for instructors are visible in the course folder of a class, but not in a learner's JupyterLab."""

from __future__ import annotations

import json
import re
import shutil
import urllib.request
from contextlib import suppress
from typing import TYPE_CHECKING

import pytest

from grader.exercise.model import course_folder
from grader.gradebook.lab import CONFIG, EXTENSION
from grader.tests import waiting
from grader.tests.notebook.jupyterlab import serving

if TYPE_CHECKING:
    from pathlib import Path


def opened(address: str) -> str:
    """Return the page at an address. JupyterLab prints the address shortly before it accepts connections."""
    pages: list[str] = []
    directly = urllib.request.build_opener(urllib.request.ProxyHandler({}))  # without the proxy of the user

    def answers() -> bool:
        with suppress(OSError), directly.open(address) as page:
            pages.append(page.read().decode())
        return bool(pages)

    waiting.until(answers)
    return pages[0]


@pytest.mark.parametrize("instructor", [False, True], ids=["learner", "instructor"])
def test_only_instructors_see_their_tools(tmp_path: Path, *, instructor: bool) -> None:
    folder = tmp_path / "course"
    folder.mkdir()
    if instructor:
        shutil.copy2(course_folder() / CONFIG, folder)
    with serving(folder, tmp_path) as address:
        html = opened(address.replace("/tree/PATH", ""))
    found = re.search(r'<script id="jupyter-config-data"[^>]*>(.*?)</script>', html, re.DOTALL)
    assert found
    settings = json.loads(found[1])
    assert EXTENSION in {extension["name"] for extension in settings["federated_extensions"]}
    assert (EXTENSION in settings["disabledExtensions"]) == (not instructor)
