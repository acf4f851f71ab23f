"""Presets: the checks that every package or every node needs, written as one `[[check]]` in exercise.toml.

    [[check]]
    preset = "node"
    trial = "eight"
    title = "b) Eight"
    start = { points = 2 }

creates the checks `eight-entry-point`, `eight-start` and `eight-node-name`, with titles that begin with `title`. The
ids of the checks of the first trial have no prefix. A table with the name of a check, such as `start`, changes the keys
of that check.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.common.words import nearest, shorten

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_TWIST: Mapping[str, Any] = {"topic": "/turtle1/cmd_vel", "type": "geometry_msgs/msg/Twist"}

PRESETS: Mapping[str, Mapping[str, Mapping[str, Any]]] = {
    "package": {
        "files": {"kind": "plain_files", "title": "The package contains only normal files"},
        "package-xml": {"kind": "package_xml", "title": "package.xml is valid"},
        "dependencies": {
            "kind": "dependencies",
            "imports": "declared",
            "title": "package.xml declares what the nodes use",
            "needs": ["package-xml"],
        },
        "package-name": {"kind": "package_name", "title": "The package name is the same everywhere"},
        "build": {"kind": "builds", "title": "colcon builds and installs the package"},
        "installed": {"kind": "installs", "title": "ROS 2 finds the installed package", "needs": ["build"]},
    },
    "node": {
        "entry-point": {
            "kind": "entry_point",
            "title": "The entry point {executable} names a function",
            "needs": ["build"],
        },
        "start": {"kind": "node_starts", "title": "The node starts", "needs": ["{trial}entry-point"]},
        "node-name": {"kind": "node_name", "title": "The node is named {node}", "needs": ["{trial}start"]},
    },
    "commands": {
        "topic": {"kind": "publishes", "title": "The node publishes commands", "needs": ["{trial}start"], **_TWIST},
    },
    "stop": {
        "stop": {"kind": "stops", "title": "The node stops on Ctrl-C", "needs": ["{trial}start"], "within_s": 3.0},
    },
}
"""Maps the name of a preset to the names of its checks, and each check to its keys.

A check is worth 0 points unless exercise.toml sets its points.
"""

_KEYS = ("preset", "trial", "title")


def expand(checks: object, trials: object) -> Any:  # noqa: ANN401 - TOML, not yet read
    """Replace each preset in the `[[check]]` tables with its checks. A wrong preset stays unchanged (see `problem_of`).

    `trials` are the `[[trial]]` tables.
    """
    if not _are_tables(checks):
        return checks
    tables: Any = checks
    known: Any = trials if _are_tables(trials) else []
    return [made for table in tables for made in (_made(table, known) if problem_of(table, known) == "" else [table])]


def problem_of(table: Mapping[str, Any], trials: Sequence[Mapping[str, Any]]) -> str | None:
    """Return a description of the mistake in a `[[check]]` table with a preset.

    Return an empty string if there is no mistake, and None if the check has no preset.
    """
    if "preset" not in table:
        return None
    name = table["preset"]
    if not isinstance(name, str) or name not in PRESETS:
        return f'"preset" is "{shorten(str(name))}"; it must be {_one_of(PRESETS)}.{_guess(str(name), PRESETS)}'
    ids = [str(trial.get("id")) for trial in trials]
    if not ids:
        return f'the preset "{name}" needs a [[trial]].'
    if table.get("trial", ids[0] if ids else "") not in ids:
        return (
            f'"trial" is "{shorten(str(table.get("trial", "")))}"; it must be the id of a [[trial]]: {", ".join(ids)}.'
        )
    allowed = (*_KEYS, *PRESETS[name])
    for key, value in table.items():
        if key not in allowed:
            return f'unknown key "{shorten(key)}".{_guess(key, allowed)} Allowed: {", ".join(allowed)}.'
        if key in PRESETS[name] and not isinstance(value, dict):
            return f'"{key}" must be a table, as in {key} = {{ points = 5 }}.'
    return "" if isinstance(table.get("title", ""), str) else '"title" must be a string.'


def _made(table: Mapping[str, Any], trials: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    spec = next((each for each in trials if each.get("id") == table.get("trial")), trials[0])
    prefix = "" if spec is trials[0] else f"{spec['id']}-"
    words = {"trial": prefix, "executable": spec.get("executable", ""), "node": spec.get("node", "")}
    made = []
    for name, template in PRESETS[table["preset"]].items():
        title, begin = template["title"].format(**words), table.get("title")
        check = {
            **template,
            "id": prefix + name,
            "title": f"{begin}: {title[0].lower()}{title[1:]}" if begin else title,
            "points": 0,
            "needs": [need.format(**words) for need in template.get("needs", [])],
        }
        # Without the key, a check is in the first trial.
        more = {"trial": spec["id"]} if prefix else {}
        made.append({**check, **more, **table.get(name, {})})
    return made


def _are_tables(value: object) -> bool:
    return isinstance(value, list) and all(isinstance(each, dict) for each in value)


def _one_of(names: Mapping[str, object]) -> str:
    return f"one of {', '.join(names)}"


def _guess(name: str, allowed: Any) -> str:  # noqa: ANN401 - any container of names
    guess = nearest(name, allowed)
    return f' Did you mean "{guess}"?' if guess else ""
