"""`ros2` imports only the modules that a command needs, so that look-ups and the Tab key are fast."""

from __future__ import annotations

import subprocess
from typing import TYPE_CHECKING

import pytest

from grader.common.interpreter import interpreter
from grader.ros2.groups import GROUPS

if TYPE_CHECKING:
    from pathlib import Path

SLOW = {"dataclasses", "inspect", "json", "shutil", "subprocess"}
"""Modules of Python whose import takes more than 2 ms. No command that looks up names needs these modules."""
SLOWEST = {"numpy", "rclpy", "rosbags", "yaml"}
"""The arguments of a verb do not need these modules."""
PARSERS = """
import sys
from grader.ros2.parser import make_parser
for words in sys.argv[1:]:
    make_parser(words.split())
print(*sys.modules)
"""
RUN = """
import io, sys
from contextlib import redirect_stdout, suppress
from grader.ros2 import main, parser
with redirect_stdout(io.StringIO()), suppress(SystemExit):
    args = parser.make_parser(sys.argv[1:]).parse_args(sys.argv[1:])
    args.run(args)
print(*sys.modules)
"""


def printed(code: str, *words: str, prefix: Path | None = None) -> set[str]:
    # With its guard variable, the wheels' own start-up file does nothing.
    env = {"_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1", "AMENT_PREFIX_PATH": str(prefix or "")}
    start = interpreter("-c", code, *words, env=env)
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_the_arguments_of_a_verb_are_known_without_slow_imports() -> None:
    verbs = [f"{group} {verb}" for group, about in GROUPS.items() for verb in about.verbs or [""]]
    assert not printed(PARSERS, *verbs) & SLOWEST


@pytest.mark.parametrize("command", ["--help", "topic --help", "pkg list", "interface show std_msgs/msg/String"])
def test_a_look_up_does_without_slow_imports(command: str, tmp_path: Path) -> None:
    index = tmp_path / "share/ament_index/resource_index"
    for kind in ("packages", "rosidl_interfaces"):
        (index / kind).mkdir(parents=True)
        (index / kind / "std_msgs").write_text("msg/String.msg\n")
    (tmp_path / "share/std_msgs/msg").mkdir(parents=True)
    (tmp_path / "share/std_msgs/msg/String.msg").write_text("string data\n")
    assert not printed(RUN, *command.split(), prefix=tmp_path) & SLOW


def test_a_command_makes_the_parsers_of_its_own_words_only() -> None:
    """Each parser searches for translations in the file system: 200 of them cost a third of the command."""
    code = """
import argparse
made = []
new = argparse.ArgumentParser.__init__
def counted(self, *args, **options):
    made.append(self)
    new(self, *args, **options)
argparse.ArgumentParser.__init__ = counted
from grader.ros2.parser import make_parser
make_parser(["topic", "list"])
print(*(each.prog.replace(" ", "-") for each in made))
"""
    assert printed(code) == {"ros2", "ros2-topic", "ros2-topic-list"}
