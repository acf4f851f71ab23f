"""A small class to grade: correct, wrong and hostile submissions, as folders and archives, some without a package."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path
from typing import Any

from grader.tests.attack import make_attack, read_attacks
from grader.tests.case import ROOT, copy_solution

STEP = "03-circle-publisher"
GRADER = str(Path(sys.executable).with_name("grader"))
ACTS = "::error::owned ##[error]"
"""A folder name that a CI system could mistake for a command."""
POINTS = {
    "anna": 100.0,
    "ben": 100.0,
    "clara": 80.0,
    "dora": 15.0,
    "emil": 100.0,
    "fritz": 0.0,
    "gina": 0.0,
    "hans": 0.0,
    ACTS: 0.0,
}
COMPARED = ("id", "status", "points", "diagnosis", "cause")


def make_class(folder: Path) -> Path:
    """Write the submissions into a new folder."""
    folder.mkdir(parents=True)
    work = folder.parent / f"{folder.name}-made"
    copy_solution(STEP, folder / "anna" / "my_robot_controller")
    copy_solution(STEP, work / "ben")
    zipped(work / "ben", folder / "ben.zip", "my_robot_controller")
    copy_solution(STEP, work / "clara")
    node = work / "clara" / "my_robot_controller" / "draw_circle.py"
    node.write_text(node.read_text("utf-8").replace("create_timer(0.5", "create_timer(1.0"), "utf-8")
    with tarfile.open(folder / "clara.tar.gz", "w:gz") as archive:
        archive.add(work / "clara", "my_robot_controller")
    subprocess.run(["cp", "-r", ROOT / "exercises" / STEP, folder / "dora"], check=True)
    attacks = {attack.name[:3]: attack for attack in read_attacks()}
    make_attack(attacks["301"], folder / "emil")
    make_attack(attacks["613"], folder / "fritz")
    (folder / "gina").mkdir()
    (folder / "gina" / "notes.txt").write_text("I could not do it.")
    (folder / "hans.zip").write_bytes(b"PK\x03\x04 and no more")
    (folder / ACTS).mkdir()
    return folder


def zipped(source: Path, file: Path, name: str) -> None:
    with zipfile.ZipFile(file, "w") as archive:
        for path in sorted(source.rglob("*")):
            archive.write(path, Path(name) / path.relative_to(source))


def command(*arguments: object) -> list[str]:
    return [GRADER, "grade", *map(str, arguments)]


def environment(**more: str) -> dict[str, str]:
    """Return the environment without the variables of CI systems, which change the output."""
    return {**{name: value for name, value in os.environ.items() if name not in ("CI", "GITHUB_ACTIONS")}, **more}


def grade(*arguments: object, **env: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command(*arguments),
        capture_output=True,
        text=True,
        check=False,
        stdin=subprocess.DEVNULL,
        timeout=600,
        env=environment(**env),
    )


def reports(out: Path) -> dict[str, dict[str, Any]]:
    """Map each student to the report in the folder."""
    found = [json.loads(file.read_text("utf-8")) for file in sorted((out / "reports").glob("*.json"))]
    by_student = {data["student"]: data for data in found}
    assert len(by_student) == len(found)
    return by_student


def judged(out: Path) -> dict[str, list[tuple[Any, ...]]]:
    """Return the values that must be equal in two runs: status, points, diagnosis and cause of every check."""
    return {
        student: [tuple(outcome[key] for key in COMPARED) for outcome in report["outcomes"]]
        for student, report in reports(out).items()
    }


def rows(out: Path) -> list[dict[str, str]]:
    with (out / "summary.csv").open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))
