"""README's commands are run, and its map is compared with the repository."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from grader.tests.console import Block, blocks, differs, run

ROOT = Path(__file__).parent.parent.parent
README = (ROOT / "README.md").read_text("utf-8")
CONSOLE = [block for block in blocks(README) if block.language == "console"]
SET_UP = re.compile(r"make \w+|source \.venv/bin/activate")
"""Set-up is what has brought these tests here; running it from them would run them again."""
FAILS = re.compile(r"grader check exercises/\S+|grader check$")
"""A starting point does not pass; every other command ends with 0."""


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """What README is about, as it stands now, where its commands may leave things behind."""
    for name in ("course", "exercises", "solutions"):
        shutil.copytree(ROOT / name, tmp_path / name)
    (tmp_path / "build").mkdir()
    (tmp_path / "home").mkdir()
    return tmp_path


def without_set_up(block: Block) -> Block:
    kept: list[str] = []
    for step in block.steps():
        if not SET_UP.fullmatch(step.command):
            kept += [f"$ {step.command}", *step.printed]
    return Block(block.language, block.about, "\n".join(kept))


@pytest.mark.parametrize("number", range(len(CONSOLE)))
def test_commands_do_what_the_readme_shows(number: int, checkout: Path) -> None:
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        # A reader's workspace and progress are not those of whoever runs the tests; what is built once is.
        "HOME": str(checkout / "home"),
        "XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache"),
    }
    block = without_set_up(CONSOLE[number])
    if number:  # a reader has done what stands above
        for earlier in CONSOLE[:number]:
            copies = [f"$ {step.command}" for step in earlier.steps() if step.command.startswith(("cp ", "mkdir "))]
            run(Block("console", "", "\n".join(copies)), checkout, environment, 60.0)
    for step, printed, exit_code in run(block, checkout, environment, 300.0):
        assert exit_code == bool(FAILS.match(step.command)), f"{step.command}\n{printed}"
        assert "Traceback" not in printed
        assert differs(step.printed, printed) is None, f"{step.command}\n{printed}"


def test_every_make_target_of_the_readme_is_there() -> None:
    makefile = (ROOT / "Makefile").read_text("utf-8")
    targets = set(re.findall(r"(?:`|^\$ |^ {4})make ([a-z-]+)", README, re.MULTILINE))
    assert targets
    assert {target for target in targets if not re.search(rf"^{target}:", makefile, re.MULTILINE)} == set()


def map_of_the_repository() -> dict[str, int]:
    """Path -> how deep it is indented, from the block below "Map of the repository"."""
    text = README.split("## Map of the repository", 1)[1]
    lines = blocks(text)[0].text.splitlines()
    paths: dict[str, int] = {}
    folder = ""
    for line in lines:
        name = line.split()[0]
        indent = len(line) - len(line.lstrip())
        if indent == 0:
            folder = name
        paths[(folder if indent else "") + name] = indent
    return paths


def test_every_path_on_the_map_exists() -> None:
    missing = [path for path in map_of_the_repository() if not (ROOT / path).exists()]
    assert missing == []


@pytest.fixture
def tracked() -> list[str]:
    done = subprocess.run(
        ["git", "-c", "core.quotePath=false", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        pytest.skip("not a git checkout")
    return done.stdout.rstrip("\0").split("\0")


def test_everything_at_the_top_is_on_the_map(tracked: list[str]) -> None:
    tops = {path.split("/")[0] + ("/" if "/" in path else "") for path in tracked}
    expected = {top for top in tops if not top.startswith(".")} - {"README.md"}
    assert expected <= set(map_of_the_repository())


def test_every_folder_of_the_grader_is_on_the_map(tracked: list[str]) -> None:
    folders = {"/".join(path.split("/")[:2]) + "/" for path in tracked if re.match(r"grader/\w+/", path)}
    assert folders <= set(map_of_the_repository())


@pytest.mark.parametrize("link", sorted(set(re.findall(r"\]\(([^)#]+)", README))))
def test_links_lead_somewhere(link: str) -> None:
    assert link.startswith("https://") or (ROOT / link).exists()
