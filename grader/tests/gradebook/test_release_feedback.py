"""`nbgrader release_feedback` continues after a submission whose time or secret is missing or is not a text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.tests.gradebook.term import STEP, Term

if TYPE_CHECKING:
    from pathlib import Path

FILES: dict[str, dict[str, bytes]] = {
    "anna": {"timestamp.txt": b"2027-03-01 10:00:00 UTC", "submission_secret.txt": b"a"},
    "no-time": {"submission_secret.txt": b"b"},
    "no-secret": {"timestamp.txt": b"2027-03-01 10:00:00 UTC"},
    "bytes": {"timestamp.txt": b"2027-03-01 10:00:00 UTC", "submission_secret.txt": b"\xff\xfe"},
    "zoe": {"timestamp.txt": b"2027-03-01 10:00:00 UTC", "submission_secret.txt": b"z"},
}


def test_the_feedback_of_the_others_is_released(tmp_path: Path) -> None:
    term = Term(tmp_path)
    for student, files in FILES.items():
        folder = term.root / "class" / "feedback" / student / STEP
        folder.mkdir(parents=True)
        for name, data in {**files, f"{STEP}.html": student.encode()}.items():
            (folder / name).write_bytes(data)
    said = term.run("release_feedback", STEP)
    released = (term.exchange / term.root.name / "feedback").glob("*.html")
    assert sorted(page.read_text() for page in released) == ["anna", "zoe"]
    for student in ("no-time", "no-secret", "bytes"):
        assert f"{student}/{STEP} was not released: " in said
