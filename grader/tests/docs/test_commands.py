"""The commands in README and docs/ work, and print the output that the pages show."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import sys
from pathlib import Path

import pytest
import typer

from grader.authoring.console_blocks import Block, blocks
from grader.authoring.lesson_commands import command_problems
from grader.cli import app
from grader.exercise.model import course_folder
from grader.ros2.bag.record import NOT_HERE
from grader.tests.console import differs, run
from grader.tests.docs.pages import BESIDE_THE_CODE, PAGES, ROOT, prose_of, text_of
from grader.tests.waiting import LONG_S

CONSOLE = {page: [block for block in blocks(text_of(page)) if block.language == "console"] for page in PAGES}
SET_UP = re.compile(r"make \w+|source \.venv/bin/activate")
"""Commands that are left out, because the set-up has already run."""
FAILS = re.compile(r"grader check (exercises/\S+|build/mine .*)|grader regrade build/mine\S*|grader check$")
"""A starting point does not pass. Every command that does not match this pattern ends with exit code 0."""
ELSEWHERE = {
    *("--security-opt", "--privileged", "--ros-args", "--params-file"),
    # Options of the benchmarks.
    *("--again", "--keep", "--table"),
    # Options of the real `ros2 bag`, which ours does not have according to docs/ros2-differences.md.
    *(f"--{name.replace('_', '-')}" for name in NOT_HERE),
    *("--clock-topics", "--clock-topics-all", "--publish-service-requests", "--service-requests-source"),
    *("--playback-until-nsec", "--disable-loan-message", "--max-cache-size"),
    *("--compression-queue-size", "--compression-threads", "--compression-threads-priority"),
    # Options of our `ros2 bag`.
    *("--max-bag-duration", "--max-bag-size", "--playback-until-sec", "--storage-preset-profile"),
}
"""Options of programs other than `grader`."""


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """Return a folder with copies of course/, exercises/ and solutions/. The commands of the pages may change it."""
    for name in ("course", "exercises", "solutions"):
        shutil.copytree(ROOT / name, tmp_path / name)
    (tmp_path / "home").mkdir()
    (tmp_path / ".venv").symlink_to(sys.prefix)
    return tmp_path


def without_set_up(block: Block) -> Block:
    kept: list[str] = []
    for step in block.steps():
        if not SET_UP.fullmatch(step.command):
            kept += [f"$ {step.command}", *step.printed]
    return Block(block.language, block.about, "\n".join(kept))


def environment_of(checkout: Path) -> dict[str, str]:
    return {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        # A reader's workspace and progress are separate from those of the user. The cache is shared.
        "HOME": str(checkout / "home"),
        "XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache"),
    }


@pytest.mark.parametrize(("page", "number"), [(page, n) for page in PAGES for n in range(len(CONSOLE[page]))])
def test_commands_do_what_the_page_shows(page: str, number: int, checkout: Path) -> None:
    environment = environment_of(checkout)
    for earlier in CONSOLE[page][:number]:  # a reader has run the previous blocks first
        copies = [f"$ {step.command}" for step in earlier.steps() if step.command.startswith(("cp ", "mkdir "))]
        run(Block("console", "", "\n".join(copies)), checkout, environment, LONG_S)
    for step, printed, exit_code in run(without_set_up(CONSOLE[page][number]), checkout, environment, LONG_S):
        assert exit_code == bool(FAILS.match(step.command)), f"{step.command}\n{printed}"
        assert "Traceback" not in printed
        assert differs(step.printed, printed) is None, f"{step.command}\n{printed}"


def test_the_package_that_the_page_creates_is_built_and_runs(checkout: Path) -> None:
    creating = [block for block in blocks(text_of("docs/learner.md")) if block.text.startswith("ros2 pkg create")]
    assert len(creating) == 1
    workspace = checkout / "home/own workspace"
    workspace.mkdir()
    typed = [f"source {checkout / '.venv/setup.bash'}", *creating[0].text.splitlines()]
    block = Block("console", "", "\n".join(f"$ {line}" for line in typed))
    for step, printed, exit_code in run(block, workspace, environment_of(checkout), LONG_S):
        assert exit_code == 0, f"{step.command}\n{printed}"
        assert not step.command.startswith("ros2 run") or "Hi from my_robot_controller." in printed, printed


def test_every_door_has_commands_that_are_run() -> None:
    for page in ("README.md", "docs/learner.md", "docs/instructor.md"):
        assert sum(len(without_set_up(block).steps()) for block in CONSOLE[page]) >= 3, page


@pytest.mark.parametrize("page", PAGES)
def test_every_make_target_is_there(page: str) -> None:
    makefile = (ROOT / "Makefile").read_text("utf-8")
    targets = set(re.findall(r"(?:`|^\$ |^)make ([a-z-]+)(?=`|\s)", text_of(page), re.MULTILINE))
    assert {target for target in targets if not re.search(rf"^{target}:", makefile, re.MULTILINE)} == set()


def test_make_targets_are_found_in_the_readme() -> None:
    assert {"demo", "test", "notebooks"} <= set(re.findall(r"`make ([a-z-]+)`", text_of("README.md")))


@pytest.mark.parametrize("page", [*PAGES, *BESIDE_THE_CODE])
def test_every_module_that_a_page_runs_is_there(page: str) -> None:
    modules = set(re.findall(r"python3? -m (grader[\w.]*)", text_of(page)))
    assert {module for module in modules if importlib.util.find_spec(module) is None} == set()


@pytest.mark.parametrize("page", PAGES)
def test_every_grader_command_and_option_is_there(page: str) -> None:
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    named = re.findall(r"(?:`|^\$ |^|<\()grader ([a-z][a-z-]*)", text_of(page), re.MULTILINE)
    assert set(named) - set(commands) == set()
    options = set(re.findall(r"`(--[a-z-]+)", prose_of(page)))
    assert options - options_of(commands) - ELSEWHERE == set()


@pytest.mark.parametrize("page", [*PAGES, *BESIDE_THE_CODE])
def test_every_command_in_a_block_is_valid(page: str) -> None:
    assert list(command_problems(text_of(page), course_folder(), app)) == []


def options_of(commands: dict[str, object]) -> set[str]:
    found: set[str] = set()
    for command in commands.values():
        found |= {name for each in command.params for name in (*each.opts, *each.secondary_opts)}  # type: ignore[attr-defined]
        found |= options_of(getattr(command, "commands", {}))
    return found


@pytest.mark.parametrize("page", PAGES)
def test_no_command_with_a_prompt_stands_outside_of_a_block(page: str) -> None:
    """A command outside a block would not be run by any test."""
    assert re.findall(r"^ *\$ .*", prose_of(page), re.MULTILINE) == []
