"""One invalid time of a submission does not hide the other submissions in nbgrader's formgrader."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

from grader.gradebook.new_class import make_class
from grader.tests.gradebook.term import STEP

if TYPE_CHECKING:
    from pathlib import Path

PAGE = f"""
from nbgrader.apps import NbGrader
from nbgrader.apps.api import NbGraderAPI
app = NbGrader()
app.load_config_file()
api = NbGraderAPI(config=app.config)
for each in api.get_submissions("{STEP}"):
    print(each["student"], each["timestamp"])
"""
"""What the formgrader does for the page with the submissions of an assignment."""


def test_an_invalid_time_does_not_hide_the_class(tmp_path: Path) -> None:
    make_class(tmp_path / "class", None)
    times = {"anna": b"2027-03-01 10:00:00 UTC", "ben": b"Not a time", "eve": b"9999-12-31 23:59:59 UTC"}
    for student, time in times.items():
        folder = tmp_path / "class/class/submitted" / student / STEP
        folder.mkdir(parents=True)
        (folder / "timestamp.txt").write_bytes(time)
    course = tmp_path / "class/course"
    done = subprocess.run([sys.executable, "-c", PAGE], cwd=course, capture_output=True, text=True, check=False)
    assert sorted(done.stdout.splitlines()) == ["anna 2027-03-01T10:00:00", "ben None", "eve None"], done.stderr
