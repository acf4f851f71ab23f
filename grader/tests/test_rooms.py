"""The import order of the grader's packages: imports go in one direction and never in a circle.

Lazy and type-only imports count.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import grimp
import pytest

from grader.tests.case import ROOT

LINTER = Path(sys.prefix, "bin/lint-imports")


def test_every_import_follows_the_order_of_the_subpackages() -> None:
    done = subprocess.run([LINTER, "--no-cache"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("upwards", "from grader.grading.grade import grade\n"),
        ("lazy", "def f() -> None:\n    from grader.cli import app\n"),
        ("only a type", "from typing import TYPE_CHECKING\n\nif TYPE_CHECKING:\n    from grader.cli import app\n"),
    ],
)
def test_an_import_against_the_order_is_found(tmp_path: Path, name: str, text: str) -> None:
    package = tmp_path / "grader"
    for module in ("checks/__init__", "grading/__init__", "grading/grade", "__init__", "cli"):
        file = package / f"{module}.py"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("", "utf-8")
    (package / "checks/judge.py").write_text(text, "utf-8")
    sys.path.insert(0, str(tmp_path))
    ours = {key: sys.modules.pop(key) for key in list(sys.modules) if key == "grader"}
    try:
        graph = grimp.build_graph("grader", cache_dir=None)
    finally:
        sys.path.remove(str(tmp_path))
        sys.modules.update(ours)
    assert graph.find_illegal_dependencies_for_layers(layers=["cli", "grading", "checks"], containers={"grader"}), name


def test_only_three_modules_are_outside_the_subpackages() -> None:
    loose = {file.name for file in (ROOT / "grader").iterdir() if file.is_file()}
    assert loose == {"__init__.py", "cli.py", "errors.py"}
