from __future__ import annotations

import subprocess
from typing import TYPE_CHECKING

import pytest
import typer

from grader.common.interpreter import interpreter
from grader.common.needed_command import needed_command

if TYPE_CHECKING:
    from pathlib import Path

COMMAND = """
import sys
from grader.cli import main
sys.argv = ["grader", "{}"]
try:
    main()
finally:
    print("imported:", *sys.modules)
"""


def two_and_a_group() -> typer.Typer:
    app, group = typer.Typer(), typer.Typer(name="more")
    for name in ("first-one", "second"):
        app.command(name)(lambda: None)
    group.command("third")(lambda: None)
    app.add_typer(group)
    return app


@pytest.mark.parametrize("words", [["second"], ["--verbose", "second", "--help"]])
def test_only_the_command_on_the_command_line_is_created(words: list[str]) -> None:
    app = two_and_a_group()
    assert list(needed_command(app, words).commands) == ["second"]
    assert len(app.registered_commands) == 2


@pytest.mark.parametrize("words", [[], ["--help"], ["secnd"], ["more", "third"]])
def test_without_the_name_of_a_command_all_are_created(words: list[str]) -> None:
    assert set(needed_command(two_and_a_group(), words).commands) == {"first-one", "second", "more"}


@pytest.mark.parametrize(
    ("word", "shown", "modules"),
    [
        ("status", "Draw a circle", {"grader.checks.kinds", "grader.setup.bootstrap", "rich.markdown"}),
        ("--help", "check", {"grader.checks.kinds", "rich.markdown", "markdown_it", "rich.traceback", "pygments"}),
    ],
)
def test_a_command_imports_only_what_it_needs(tmp_path: Path, word: str, shown: str, modules: set[str]) -> None:
    start = interpreter("-c", COMMAND.format(word), env={"HOME": str(tmp_path), "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"})
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=True)
    printed, _, imported = done.stdout.partition("imported:")
    assert shown in printed
    assert not modules & set(imported.split())
