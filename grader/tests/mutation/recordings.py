"""Recordings of cases: each case is graded once, and its recording is judged many times."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common import xdg
from grader.tests.case import CASES, ROOT, make_submission, read_cases
from grader.tests.gradings import EXERCISE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from grader.tests.case import Case

FOLDERS = ("cases", "mistakes", "unusual")
GRADER = Path(sys.executable).with_name("grader")


@dataclass(frozen=True)
class Recorded:
    """A case and the folder of its recording."""

    case: Case
    folder: Path

    @property
    def name(self) -> str:
        """A unique name such as mistakes/316-syntax-error, since two folders may use the same number."""
        return f"{self.case.folder.parent.name}/{self.case.name}"


def cache() -> Path:
    """Return the folder that stores the recordings between runs."""
    return xdg.cache() / "mutation"


def all_cases() -> Iterator[Case]:
    """Return the cases of all folders for which the grader writes a report."""
    for name in FOLDERS:
        folder = CASES.parent / name
        yield from (case for case in (read_cases(folder) if folder.is_dir() else ()) if case.result != "usage")


def recordings(
    cases: Iterable[Case], tell: Callable[[str], None], below: Path | None = None, *, make: bool = True
) -> list[Recorded]:
    """Return the recordings of these cases. `make` creates missing recordings, in parallel on all processors.

    A case is recorded again if its submission or its exercise has changed. If the code of the trial has changed, the
    caller must first empty the cache.
    """
    kept = below or cache()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(lambda case: _recorded(case, kept, tell, make=make), cases)
        return [each for each in found if each is not None]


def _recorded(case: Case, below: Path, tell: Callable[[str], None], *, make: bool) -> Recorded | None:
    exercise = case.exercise or case.base or EXERCISE
    with tempfile.TemporaryDirectory(prefix="grader-mutation-") as scratch:
        submission = make_submission(case, Path(scratch) / "in")
        key = _key(Path(scratch) / "in", case.give, ROOT / "course" / exercise / "exercise.toml")
        folder = below / f"{case.folder.parent.name}-{case.name}-{key}"
        if not folder.is_dir():
            if not make:
                return None
            tell(f"Recording {case.folder.parent.name}/{case.name}")
            made = Path(scratch) / "recording"
            command = [str(GRADER), "check", str(submission), "--exercise", exercise, "--recording", str(made)]
            done = subprocess.run(command, capture_output=True, check=False, stdin=subprocess.DEVNULL)
            if not made.is_dir():
                tell(f"No recording of {case.name}: {done.stderr.decode('utf-8', 'replace').strip()[-200:]}")
                return None
            for old in below.glob(f"{case.folder.parent.name}-{case.name}-*"):
                shutil.rmtree(old)
            below.mkdir(parents=True, exist_ok=True)
            shutil.copytree(made, folder)
    return Recorded(case, folder)


def _key(submission: Path, *more: str | Path) -> str:
    """Return a digest of the submission and the exercise."""
    digest = hashlib.sha256()
    for path in sorted(submission.rglob("*"), key=os.fsencode):
        digest.update(os.fsencode(path.relative_to(submission)) + b"\0")
        if path.is_symlink():
            digest.update(os.fsencode(path.readlink()))
        elif path.is_file():
            digest.update(path.read_bytes())
    for each in more:
        digest.update(each.read_bytes() if isinstance(each, Path) else each.encode())
    return digest.hexdigest()[:16]
