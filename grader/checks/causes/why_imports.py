"""Why an import failed: ModuleNotFoundError and ImportError of a student's node."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.causes import ros_names
from grader.checks.causes.cause import Cause
from grader.common.words import nearest, shorten

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import Scene

NO_MODULE = re.compile(r"No module named '(?P<name>[\w.]+)'")
NO_NAME = re.compile(r"cannot import name '(?P<name>\w+)' from '(?P<module>[\w.]+)'")


def why_no_import(scene: Scene) -> Cause | None:
    """A module that is not here, or a name that the module does not have."""
    text = scene.crash.message
    module, name = NO_MODULE.search(text), NO_NAME.search(text)
    if module is not None:
        return _no_module(scene, module["name"])
    return _no_name(name["name"], name["module"]) if name is not None else None


def _no_module(scene: Scene, name: str) -> Cause:
    top = name.partition(".")[0]
    if top in ros_names.ROS_1:
        return Cause("ros-1-module", f"{top} belongs to ROS 1; the Python library of ROS 2 is rclpy.")
    if top == "turtlesim_msgs":
        return Cause(
            "turtlesim-msgs",
            "Newer distributions have the messages in turtlesim_msgs; in Jazzy they are in turtlesim itself.",
        )
    files = scene.evidence.submission.files
    beside = next((path for path in sorted(files) if path.endswith(f"/{top}.py")), None)
    if beside is not None:
        text = f"{beside} is there, but a module is imported by its package and its name: FOLDER.{top}."
        return Cause("sibling-import", text)
    guess = nearest(name, ros_names.MODULES)
    if guess is not None:
        return Cause("module-misspelt", f"There is a module {guess}: compare the two letter by letter.")
    return Cause(
        "module-missing",
        f"No package here has a module {shorten(name)}; the exercise needs none but ROS 2's and Python's own.",
    )


def _no_name(name: str, module: str) -> Cause:
    plain = {each.lower(): each for each in ros_names.LIVES_IN}
    known = plain.get(name.lower())
    if known is not None and ros_names.LIVES_IN[known] == module:
        return Cause("import-name", f"There it is called {known}: capital and small letters differ.")
    if known is not None:
        return Cause("import-wrong-place", f"{known} lives in {ros_names.LIVES_IN[known]}.")
    guess = nearest(name, [each for each, place in ros_names.LIVES_IN.items() if place == module])
    return Cause(
        "import-name", f"{shorten(module)} has {guess}." if guess else f"{shorten(module)} has nothing of that name."
    )
