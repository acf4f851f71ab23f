"""Why an import failed: ModuleNotFoundError and ImportError in a student's node."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes import ros_names
from grader.common.words import nearest, shorten

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

NO_MODULE = re.compile(r"No module named '(?P<name>[\w.]+)'")
NO_NAME = re.compile(r"cannot import name '(?P<name>\w+)' from '(?P<module>[\w.]+)'")


def why_no_import(scene: CrashScene) -> Cause | None:
    """Return the cause of a missing module, or of a name that the module does not have."""
    text = scene.crash.message
    module, name = NO_MODULE.search(text), NO_NAME.search(text)
    if module is not None:
        return _no_module(scene, module["name"])
    return _no_name(name["name"], name["module"]) if name is not None else None


def _no_module(scene: CrashScene, name: str) -> Cause:
    top = name.partition(".")[0]
    if top in ros_names.ROS_1:
        return Cause("ros-1-module", f"{top} belongs to ROS 1. The Python library of ROS 2 is rclpy.")
    if top == "turtlesim_msgs":
        return Cause(
            "turtlesim-msgs",
            "Newer ROS 2 distributions have these messages in turtlesim_msgs. In Jazzy they are in turtlesim.",
        )
    files = scene.evidence.submission.files
    beside = next((path for path in sorted(files) if path.endswith(f"/{top}.py")), None)
    if beside is not None:
        text = f"{beside} exists, but you must import it with its package name: FOLDER.{top}."
        return Cause("sibling-import", text)
    guess = nearest(name, ros_names.MODULES)
    if guess is not None:
        return Cause("module-misspelt", f"There is a module {guess}. Compare the two names letter by letter.")
    return Cause(
        "module-missing",
        f"No installed package has a module {shorten(name)}. This exercise needs only the modules of ROS 2 and Python.",
    )


def _no_name(name: str, module: str) -> Cause:
    plain = {each.lower(): each for each in ros_names.MODULE_OF}
    known = plain.get(name.lower())
    if known is not None and ros_names.MODULE_OF[known] == module:
        return Cause("import-name", f"In this module it is called {known}. Upper and lower case matter.")
    if known is not None:
        return Cause("import-wrong-place", f"{known} is in the module {ros_names.MODULE_OF[known]}.")
    guess = nearest(name, [each for each, place in ros_names.MODULE_OF.items() if place == module])
    return Cause("import-name", f"The module {shorten(module)} has {guess or 'nothing with that name'}.")
