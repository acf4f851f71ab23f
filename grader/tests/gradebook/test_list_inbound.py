"""`nbgrader list --inbound` lists the other submissions if a student has put odd files into the exchange."""

from __future__ import annotations

import os
import re
import secrets
from typing import TYPE_CHECKING

from grader.tests.gradebook.term import FIRST, STEP, Term

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

SECRET = "submission_secret.txt"
CHANGES: dict[str, Callable[[Path], object]] = {
    "anna": lambda folder: (folder / SECRET).write_text(secrets.token_hex(64)),  # as `nbgrader submit` does
    "bytes": lambda folder: (folder / SECRET).write_bytes(b"\xff\xfe"),
    "endless": lambda folder: (folder / SECRET).symlink_to("/dev/zero"),
    "folder": lambda folder: (folder / "more.ipynb").mkdir(),
    "large": lambda folder: (folder / SECRET).write_text("a" * 1001),
    "pipe": lambda folder: os.mkfifo(folder / "more.ipynb"),
    "gone": lambda folder: (folder / "more.ipynb").symlink_to("nowhere"),
    "line\nbreak": lambda _: None,
    "zoe": lambda _: None,
}


def test_one_submission_does_not_hide_the_others(tmp_path: Path) -> None:
    term = Term(tmp_path)
    for student, change in CHANGES.items():
        folder = term.exchange / term.root.name / "inbound" / f"{student}+{STEP}+{FIRST}"
        folder.mkdir(parents=True)
        (folder / f"{STEP}.ipynb").write_text("{}")
        change(folder)
    said = term.run("list", "--inbound")
    assert re.findall(rf"(\w+) {STEP} {FIRST} \(", said) == ["anna", "zoe"]
    for student in set(CHANGES) - {"anna", "zoe"}:
        assert re.search(rf"Not listed, because .*{student.split()[-1]}\+{STEP}", said), student
