"""Generate docs/commands.md from the help texts of the commands: `python -m grader.tests.docs.commands_page`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import typer

from grader.cli import app
from grader.ros2.groups import GROUPS
from grader.tests.docs.pages import ROOT

if TYPE_CHECKING:
    from pathlib import Path

PAGE = ROOT / "docs" / "commands.md"
HEAD = """# All commands

This page is generated from the help texts of the commands. `COMMAND --help` lists all options, and the Tab key
completes commands and options. `grader --help` also lists the commands for authors and for setting up your machine, and
`ros2 --help` also lists the commands that no lesson needs.

## In each new terminal

| command | what it does |
| --- | --- |
| `source ~/ros2-course/.venv/setup.bash` | adds `grader`, `ros2` and `colcon` (in zsh: `setup.zsh`) |
| `source ~/ros2_ws/install/setup.bash` | adds the packages that you have built in your workspace, for `ros2 run` |
| `colcon build --symlink-install` | builds the packages of the current workspace. Step 05 explains this command |
"""
PANELS = ("Learn", "Teach")
NOT_USED = ("component", "daemon", "launch", "lifecycle", "multicast", "security", "wtf")
"""Groups of `ros2` that no lesson needs. The page leaves them out."""


def page() -> str:
    """Return the text of the page."""
    return "\n".join([HEAD, *grader_tables(), *ros2_table()]) + "\n"


def grader_tables() -> list[str]:
    """Return one table for each panel of `grader --help`."""
    group = typer.main.get_command(app)
    lines = []
    for panel in PANELS:
        lines += [f"## grader: {panel.lower()}", "", "| command | what it does | for example |", "| --- | --- | --- |"]
        for name, command in sorted(getattr(group, "commands", {}).items()):
            if command.rich_help_panel == panel and not command.hidden:
                example = re.sub(r"^Examples?: ", "", command.epilog or "").split("; ")[0]
                about = (command.help or "").strip().splitlines()[0]
                lines.append(f"| `grader {name}` | {about} | {f'`{example}`' if example else ''} |")
        lines.append("")
    return lines


def ros2_table() -> list[str]:
    """Return the verbs of `ros2`."""
    lines = ["## ros2", "", "| command | what it does |", "| --- | --- |"]
    for group, about in sorted(GROUPS.items()):
        if group in NOT_USED:
            continue
        itself = {} if about.verbs and not about.runs_itself else {"": about.about}
        for verb, words in sorted({**itself, **about.verbs}.items()):
            lines.append(f"| `{f'ros2 {group} {verb}'.strip()}` | {words} |")
    lines += ["", "`rqt_graph` draws the nodes and topics of the running system (step 05)."]
    return lines


def write(to: Path = PAGE) -> None:
    """Write the page."""
    to.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    write()
