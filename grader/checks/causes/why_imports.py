"""Explain why an import in a student's node failed with a ModuleNotFoundError or an ImportError."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes import ros_names
from grader.checks.causes.why_own_import import why_circular, why_no_own_module
from grader.checks.edit import at
from grader.common.words import nearest, shorten
from grader.submission.code import import_path

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

NOT_HERE = {
    "tkinter": "tkinter is Python's module for graphical windows.",
    "_tkinter": "tkinter is Python's module for graphical windows.",
}
"""Maps a module to a sentence about it. A correct program may import the module, but the grader does not have it."""
OWN_INTERFACES = ("_interfaces", "_msgs")
"""The usual endings of the name of a package that contains messages."""
PART_OF_ROS_1 = re.compile(r"(?P<service>[A-Z][A-Za-z0-9]*)(?P<part>Request|Response)")
"""Matches the name of a class of ROS 1 for the request or the response of a service, such as SetBoolResponse."""
NO_MODULE = re.compile(r"No module named '(?P<name>[\w.]+)'")
NO_NAME = re.compile(r"cannot import name '(?P<name>\w+)' from '(?P<module>[\w.]+)'")


def why_no_import(scene: CrashScene) -> Cause | None:
    """Return the cause if a module or a name in a module is missing, or if modules import each other, else None."""
    text = scene.crash.message
    module, name = NO_MODULE.search(text), NO_NAME.search(text)
    if module is not None:
        return _no_module(scene, module["name"])
    if "attempted relative import" in text:
        text = (
            "A dot at the beginning of a module name stands for the package that contains this file. Write the full "
            "name of the module instead."
        )
        return Cause("crash", text)
    return _no_name(scene, name["name"], name["module"]) if name is not None else why_circular(scene)


def _no_module(scene: CrashScene, name: str) -> Cause:
    top = name.partition(".")[0]
    if top in ros_names.ROS_1:
        return Cause("ros-1-module", f"{top} belongs to ROS 1. The Python library of ROS 2 is rclpy.")
    if top == "turtlesim_msgs":
        return Cause(
            "turtlesim-msgs",
            "Newer ROS 2 distributions have these messages in turtlesim_msgs. In Jazzy, these messages are in "
            "turtlesim.",
        ).fixed_by(at(scene.crash.where, "turtlesim_msgs", "turtlesim"))
    about = NOT_HERE.get(name) or (f"{name} is a package of ROS 2." if name in ros_names.NOT_IN_COURSE else None)
    if about is not None:
        return Cause("module-missing", f"{about} This grader does not have {name}, so it cannot run this node.")
    files = scene.evidence.submission.files
    if f"{top}.py" in files:
        text = f"{top}.py is next to setup.py, so it is not installed. Move it to the folder with the other modules."
        return Cause("sibling-import", text)
    beside = next((path for path in sorted(files) if path.endswith(f"/{top}.py")), None)
    if beside is not None:
        text = f"{beside} exists, but you must import it with its package name: FOLDER.{top}."
        return Cause("sibling-import", text)
    own = why_no_own_module(scene, name)
    if own is not None:
        return own
    inside = {import_path(each).removesuffix(".py").replace("/", ".") for each in files if each.endswith(".py")}
    own_modules = {each for each in inside if each.count(".") == name.count(".") and not each.endswith("__init__")}
    known = {*ros_names.MODULES, *(each.partition(".")[0] for each in ros_names.MODULES), *own_modules}
    module, _, last = name.rpartition(".")
    if ros_names.MODULE_OF.get(last) == module:
        text = f"{last} is a class in the module {module}, not a module. Write from {module} import {last}."
        return Cause("import-wrong-place", text)
    guess = nearest(name, known, alike=0.8)
    if guess is not None:
        text = f"A similar module exists: {guess}. Compare the two names letter by letter."
        right = guess if "." in name else guess.partition(".")[0]
        return Cause("module-misspelt", text).fixed_by(at(scene.crash.where, name, right))
    manifest = scene.evidence.manifest
    declared = manifest is not None and top in (*manifest.run_depends, *manifest.other_depends)
    if declared or top.endswith(OWN_INTERFACES):
        return Cause(
            "module-missing",
            f"The grader does not have the package {shorten(top)}. If the package is your own, the node must work "
            "without it, since you hand in only one package.",
        )
    return Cause(
        "module-missing",
        f"No installed package has a module {shorten(name)}. Check the name letter by letter. If the name is right, "
        "the grader does not have this module.",
    )


def _no_name(scene: CrashScene, name: str, module: str) -> Cause:
    plain = {each.lower(): each for each in ros_names.MODULE_OF}
    known = plain.get(name.lower())
    if known is not None and ros_names.MODULE_OF[known] == module:
        text = f"In this module the name is {known}. Upper and lower case matter."
        return Cause("import-name", text).fixed_by(at(scene.crash.where, name, known))
    if known is not None:
        right = ros_names.MODULE_OF[known]
        fix = at(scene.crash.where, f"from {module} ", f"from {right} ")
        return Cause("import-wrong-place", f"{known} is in the module {right}.").fixed_by(fix)
    part = PART_OF_ROS_1.fullmatch(name)
    if part is not None and module.endswith(".srv"):
        text = f"{name} is the name in ROS 1. In ROS 2, import {part['service']}: its {part['part']} is an attribute."
        return Cause("import-name", text)
    guess = nearest(name, [each for each, place in ros_names.MODULE_OF.items() if place == module])
    fix = at(scene.crash.where, name, guess) if guess else ()
    instead = f", but it has {guess}" if guess else ""
    return Cause("import-name", f"The module {shorten(module)} has no such name{instead}.").fixed_by(fix)
