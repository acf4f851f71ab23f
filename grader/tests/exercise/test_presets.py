"""A `[[check]]` with a preset stands for the checks that every package or node needs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import load_exercise
from grader.checks.kinds import KINDS
from grader.errors import UsageError
from grader.exercise.presets import PRESETS
from grader.exercise.private_checks import Sources

if TYPE_CHECKING:
    from grader.exercise.model import Exercise

HEAD = """\
schema = 2

[exercise]
id = "99-test"
title = "A test"
package = "my_package"

[[trial]]
id = "drive"
executable = "my_driver"
node = "driver"
duration_s = 5

[[trial]]
id = "eight"
executable = "my_eight"
node = "eight"
duration_s = 5

[[check]]
preset = "package"
dependencies = { packages = ["rclpy"], title = "package.xml declares rclpy", points = 3 }
"""
SHORT = """
[[check]]
preset = "node"

[[check]]
preset = "node"
trial = "eight"
title = "b) Eight"
start = { points = 2 }

[[check]]
preset = "commands"
trial = "eight"

[[check]]
preset = "stop"
trial = "eight"
stop = { within_s = 4, hidden = true }
"""
LONG = """
[[check]]
id = "entry-point"
kind = "entry_point"
title = "The entry point my_driver names a function"
points = 0
needs = ["build"]

[[check]]
id = "start"
kind = "node_starts"
title = "The node starts"
points = 0
needs = ["entry-point"]

[[check]]
id = "node-name"
kind = "node_name"
title = "The node is named driver"
points = 0
needs = ["start"]

[[check]]
id = "eight-entry-point"
kind = "entry_point"
title = "b) Eight: the entry point my_eight names a function"
points = 0
needs = ["build"]
trial = "eight"

[[check]]
id = "eight-start"
kind = "node_starts"
title = "b) Eight: the node starts"
points = 2
needs = ["eight-entry-point"]
trial = "eight"

[[check]]
id = "eight-node-name"
kind = "node_name"
title = "b) Eight: the node is named eight"
points = 0
needs = ["eight-start"]
trial = "eight"

[[check]]
id = "eight-topic"
kind = "publishes"
title = "The node publishes commands"
points = 0
needs = ["eight-start"]
trial = "eight"
topic = "/turtle1/cmd_vel"
type = "geometry_msgs/msg/Twist"

[[check]]
id = "eight-stop"
kind = "stops"
title = "The node stops on Ctrl-C"
points = 0
needs = ["eight-start"]
trial = "eight"
within_s = 4
hidden = true
"""


def load(folder: Path, text: str) -> Exercise:
    (folder / "exercise.toml").write_text(text)
    return load_exercise(folder)


def test_a_preset_is_the_same_as_the_checks_that_it_stands_for(tmp_path: Path) -> None:
    assert load(tmp_path, HEAD + SHORT).checks == load(tmp_path, HEAD + LONG).checks


def test_the_package_is_judged_once_with_what_is_laid_over(tmp_path: Path) -> None:
    checks = {check.id: check for check in load(tmp_path, HEAD).checks}
    assert list(checks) == ["files", "package-xml", "dependencies", "package-name", "build", "installed"]
    declared = checks["dependencies"]
    assert (declared.points, declared.title, declared.needs) == (3.0, "package.xml declares rclpy", ("package-xml",))
    assert {check.points for check in checks.values() if check is not declared} == {0.0}
    assert {check.trial for check in checks.values()} == {"drive"}


def test_every_preset_is_made_of_kinds_that_there_are() -> None:
    kinds = {check["kind"] for preset in PRESETS.values() for check in preset.values()}
    assert kinds <= KINDS.keys()


@pytest.mark.parametrize(
    ("old", "new", "reported"),
    [
        (
            'preset = "stop"',
            'preset = "stops"',
            '"preset" is "stops"; it must be one of package, node, commands, stop.',
        ),
        ('preset = "stop"', "preset = 3", '"preset" is "3"; it must be one of'),
        (
            "start = {",
            "strat = {",
            'unknown key "strat". Did you mean "start"? Allowed: preset, trial, title',
        ),
        ("start = { points = 2 }", "start = 2", '"start" must be a table, as in start = { points = 5 }.'),
        ("{ points = 2 }", '{ points = "2" }', '(eight-start): "points" is "2"; it must be a number from 0 to 1000.'),
        ('trial = "eight"', 'trial = "ate"', '"trial" is "ate"; it must be the id of a [[trial]]: drive, eight.'),
        ('title = "b) Eight"', "title = 8", '"title" must be a string.'),
    ],
)
def test_each_mistake_of_an_author_is_named(tmp_path: Path, old: str, new: str, reported: str) -> None:
    assert old in SHORT
    with pytest.raises(UsageError) as error:
        load(tmp_path, HEAD + SHORT.replace(old, new, 1))
    assert reported in str(error.value)


def test_a_preset_without_a_trial_is_named(tmp_path: Path) -> None:
    with pytest.raises(UsageError) as error:
        load(tmp_path, HEAD.partition("[[trial]]")[0] + SHORT)
    assert 'the preset "node" needs a [[trial]].' in str(error.value)


def test_private_checks_lie_over_those_of_a_preset_and_may_use_presets() -> None:
    private = """
schema = 2

[[check]]
id = "eight-start"
points = 7

[[check]]
preset = "stop"
"""
    sources = Sources("99-test", (HEAD + SHORT).encode(), private.encode(), "mine/exercise.toml")
    checks = {check.id: check for check in sources.exercise(Path(), KINDS).checks}
    assert (checks["eight-start"].points, checks["eight-start"].hidden) == (7.0, False)
    assert (checks["stop"].trial, checks["stop"].hidden, checks["stop"].needs) == ("drive", True, ("start",))
    assert not checks["eight-node-name"].hidden
