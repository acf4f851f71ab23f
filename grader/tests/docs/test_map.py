"""The maps in README and docs/development.md agree with the repository."""

from __future__ import annotations

import re
import subprocess

import pytest

from grader.authoring.console_blocks import blocks
from grader.tests.docs.pages import ROOT, text_of

MAPS = ("README.md", "docs/development.md")


def map_of(page: str) -> dict[str, int]:
    """Map each path in the block below "Map of the repository" to the depth of its indentation."""
    text = text_of(page).split("## Map of the repository", 1)[1]
    paths: dict[str, int] = {}
    folder = ""
    for line in blocks(text)[0].text.splitlines():
        name = line.split()[0]
        indent = len(line) - len(line.lstrip())
        if indent == 0:
            folder = name
        paths[(folder if indent else "") + name] = indent
    return paths


@pytest.fixture(scope="module")
def tracked() -> list[str]:
    done = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        pytest.skip("not a git checkout")
    return done.stdout.rstrip("\0").split("\0")


@pytest.mark.parametrize("page", MAPS)
def test_every_path_on_the_map_exists(page: str) -> None:
    assert [path for path in map_of(page) if not (ROOT / path).exists()] == []


@pytest.mark.parametrize("page", MAPS)
def test_what_a_path_on_the_map_is_stands_beside_it(page: str) -> None:
    text = text_of(page).split("## Map of the repository", 1)[1]
    assert [line for line in blocks(text)[0].text.splitlines() if len(line.split()) < 3] == []


def test_everything_at_the_top_is_on_the_readmes_map(tracked: list[str]) -> None:
    tops = {path.split("/")[0] + ("/" if "/" in path else "") for path in tracked}
    assert len(tops) > 10
    assert {top for top in tops if not top.startswith(".")} - {"README.md"} == set(map_of("README.md"))


def test_every_room_is_on_the_map_of_development(tracked: list[str]) -> None:
    rooms = {"/".join(path.split("/")[:2]) for path in tracked if path.startswith("grader/")}
    names = {name + "/" if (ROOT / name).is_dir() else name for name in rooms} - {"grader/__init__.py"}
    assert len(names) > 20
    assert names == {path for path, indent in map_of("docs/development.md").items() if indent}


def test_every_room_is_in_one_row(tracked: list[str]) -> None:
    rooms = {path.split("/")[1] for path in tracked if re.match(r"grader/\w+/", path)} - {"tests"}
    rows = blocks(text_of("docs/development.md").split("in three rows", 1)[1])[0].text
    named = re.findall(r"\w+", re.sub(r"\(.*?\)", lambda match: match[0] if "grading" in match[0] else "", rows))
    assert sorted(rooms) == sorted(name for name in named if name not in {"puts", "them", "together"})
