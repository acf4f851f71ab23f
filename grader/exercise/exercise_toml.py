"""Read exercise.toml, and report all mistakes to its author in one message.

The keys in `schema = 2`:

- `[exercise]` has id, title, package (without a package, students submit only answers.toml), apart (`grader start` puts
  the package into a separate workspace), show_fix (students see the tested change) and starting_point_fails (the ids of
  the checks that the starting point must fail).
- `[numbers]` has file (the name of a TOML file in the package), and lists of possible values. Each student gets one
  value from each list. In a `[[check]]`, the value `{ own = "radius_m" }` stands for the student's own value.
- `[[trial]]` has id, executable, node, duration_s, start, rename, pose_every, pose_from_s, answers_after_s, targets,
  withdraws, catch_from_s and alone_s. A `[[trial]]` whose node runs in another trial has id, executable, node and
  beside. `[trial.start_pose]` has x_m, y_m and theta_rad, and `[[trial.drive]]` has from_s, linear_x_m_s and
  angular_z_rad_s (each except from_s is one number, or the two limits of a random number). `[[trial.call]]` has at_s,
  service, type and request (a table with fields). `[[trial.set]]` has at_s, parameter, value and `also` (a table with
  other parameters).
  `[trial.parameters]` and `[trial.params_file]` map the names of parameters to their values.
- A `[[trial]]` without a simulator has id and one of these groups: function and `[[trial.points]]`; executable and
  `[[trial.bag]]` (both in calls_toml.py); executable, node, duration_s and `[trial.tests]` (tests_toml.py).
- `[[check]]` has id, kind, points, needs (ids), title, trial (the default is the first trial), hidden, and the
  parameters of its kind. A `[[check]]` can have a preset instead (presets.py).
- `[[hint]]` has text, checks (the ids of the checks that it helps with) and part (a letter). The hints begin with a
  nudge and end with almost the whole answer.
"""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING, Any

from grader.common.words import nearest, shorten
from grader.errors import UsageError
from grader.exercise.calls_toml import unknown_calls
from grader.exercise.kind_spec import Allowed
from grader.exercise.model import CheckSpec, Exercise, Hint
from grader.exercise.own_numbers import NumbersSpec, Own
from grader.exercise.presets import expand, problem_of
from grader.exercise.scenario_toml import ID, NAME, ROS_NAME, read_trials
from grader.exercise.tables import Table, read_toml, shown
from grader.exercise.tests_toml import unknown_numbers

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from grader.exercise.kind_spec import KindSpec, Param

SCHEMA = 2
OLDER = {
    1: "move `executable` and `node` out of [exercise], and all keys of [scenario], into a [[trial]] with an `id` of "
    "its own; do the same with the keys of [trial.scenario], rename [[scenario.drive]] to [[trial.drive]], and set "
    "schema = 2."
}
"""Instructions for updating a file in an older version of the format."""
PART = re.compile(r"[a-z]")
OF_NUMBERS = "own_"
"""The beginning of the names of all kinds of checks that need the table [numbers]."""
FIELD = Allowed(
    "a number, a string, true or false", lambda value: value if isinstance(value, str | int | float) else None, ""
)
"""The values that are allowed in a table that is a parameter of a check."""


def parse_exercise(data: bytes, name: str, folder: Path, kinds: Mapping[str, KindSpec]) -> Exercise:
    """Return the exercise that the bytes of an exercise.toml describe. `name` is the name of the file in messages.

    Raises UsageError, which lists all mistakes.
    """
    return parse_tables(read_toml(data, name), name, folder, hashlib.sha256(data).hexdigest(), kinds)


def parse_tables(top: dict[str, Any], name: str, folder: Path, digest: str, kinds: Mapping[str, KindSpec]) -> Exercise:
    """Return the exercise that the tables of an exercise.toml describe. Raises UsageError, which lists all mistakes."""
    problems: list[str] = []
    top = {**top, "check": expand(top["check"], top.get("trial"))} if "check" in top else top
    exercise = _exercise(Table(top, "", problems), folder, digest, kinds)
    if problems:
        message = "\n".join(f"{name}: {problem}" for problem in problems)
        raise UsageError(message)
    return exercise


def of_older_schema(values: Mapping[str, Any]) -> str:
    """Return instructions for updating a file in an older version of the format, or an empty string for other files."""
    schema = values.get("schema")
    known = OLDER.get(schema) if isinstance(schema, int) else None
    return f"schema {schema} is no longer supported: {known}" if known else ""


def _exercise(top: Table, folder: Path, digest: str, kinds: Mapping[str, KindSpec]) -> Exercise:
    older = of_older_schema(top.values)
    if older:
        top.problem(older)
    elif top.number("schema", SCHEMA, SCHEMA, f"{SCHEMA}, the version of this format") == SCHEMA:
        return _read(top, folder, digest, kinds)
    return Exercise("", "", "", (), (), (), folder)


def _read(top: Table, folder: Path, digest: str, kinds: Mapping[str, KindSpec]) -> Exercise:
    head = top.table("exercise")
    # An exercise that only needs answers.toml has no package, and its trials have no node.
    package = head.string("package", ROS_NAME, NAME, default=None if "package" in head.values else "")
    id_ = head.string("id", ID, "lowercase letters, digits and single hyphens, as in 03-circle-publisher")
    numbers = _numbers(top.table("numbers"), id_) if "numbers" in top.values else None
    trials = read_trials(top, package)
    checks = _checks(top, tuple(trial.id for trial in trials), kinds, numbers)
    for problem in (*unknown_calls(trials, checks), *unknown_numbers(trials, numbers)):
        top.problem(problem)
    unsolved = head.strings("starting_point_fails")
    for name in unsolved:
        _must_be_check(head, "starting_point_fails", name, [check.id for check in checks])
    exercise = Exercise(
        id=id_,
        title=head.string("title"),
        package=package,
        trials=trials,
        checks=checks,
        hints=tuple(_hint(table, checks) for table in top.tables("hint")),
        show_fix=head.flag("show_fix"),
        unsolved=unsolved,
        apart=head.flag("apart"),
        numbers=numbers,
        folder=folder,
        digest=digest,
    )
    for table in (head, top):
        table.finish()
    return exercise


def _numbers(table: Table, step: str) -> NumbersSpec:
    file = table.string("file", re.compile(r"\w+\.toml"), "the name of a TOML file")
    options = {name: table.options(name) for name in table.values if name != "file"}
    if not options:
        table.problem("there is no list of values.")
    return NumbersSpec(step, file, options)


def _hint(table: Table, checks: tuple[CheckSpec, ...]) -> Hint:
    hint = Hint(
        table.string("text").strip(),
        table.strings("checks"),
        table.string("part", PART, 'a letter, as in "d"', default=""),
    )
    for name in hint.checks:
        _must_be_check(table, "checks", name, [check.id for check in checks])
    table.finish()
    return hint


def _must_be_check(table: Table, key: str, name: str, ids: list[str]) -> None:
    if name not in ids:
        guess = nearest(name, ids)
        hint = f' Did you mean "{guess}"?' if guess else ""
        table.problem(f'"{key}" contains "{shorten(name)}", which is not a check.{hint} Allowed: {", ".join(ids)}.')


def _checks(
    top: Table, trials: tuple[str, ...], kinds: Mapping[str, KindSpec], numbers: NumbersSpec | None
) -> tuple[CheckSpec, ...]:
    tables = _without_presets(top.tables("check"), trials)
    if "check" not in top.values:
        top.problem("there is no [[check]], so nothing would be judged.")
    specs = tuple(_check(table, trials, kinds, numbers) for table in tables)
    ids = [spec.id for spec in specs]
    for table, spec in zip(tables, specs, strict=True):
        if spec.id and ids.count(spec.id) > 1:
            table.problem(f'the id "{spec.id}" is used {ids.count(spec.id)} times; each check needs its own id.')
        if spec.kind.startswith(OF_NUMBERS) and numbers is None:
            table.problem(f'the kind "{spec.kind}" needs the table [numbers], from which each student gets values.')
        for need in spec.needs:
            _must_be_check(table, "needs", need, ids)
    circle = _circle(specs)
    if circle:
        top.problem(f'"needs" has a cycle: {" -> ".join(circle)}. Remove one of these needs.')
    return specs


def _without_presets(tables: list[Table], trials: tuple[str, ...]) -> list[Table]:
    """Return the tables that have no key `preset`.

    A table that still has the key `preset` is invalid, and is recorded as a mistake.
    """
    for table in tables:
        wrong = problem_of(table.values, [{"id": trial} for trial in trials])
        if wrong:
            table.problem(wrong)
    return [table for table in tables if "preset" not in table.values]


def _check(
    table: Table, trials: tuple[str, ...], kinds: Mapping[str, KindSpec], numbers: NumbersSpec | None
) -> CheckSpec:
    id_ = table.string("id", ID, "lowercase letters, digits and single hyphens, as in circle-radius")
    if id_:
        table.place += f" ({id_})"
    trial = table.string("trial", default=trials[0] if trials else "?")
    if trials and trial not in trials:
        table.problem(f'"trial" is "{shorten(trial)}"; it must be the id of a [[trial]]: {", ".join(trials)}.')
    name = table.string("kind", allowed=f"one of {', '.join(kinds)}")
    points = table.number("points", 0.0, 1000.0, "a number from 0 to 1000")
    needs, hidden = table.strings("needs"), table.flag("hidden")
    kind = kinds.get(name)
    title = table.string("title", default=kind.title if kind and "title" not in table.values else "?")
    if kind is None:
        if name:
            guess = nearest(name, kinds)
            hint = f' Did you mean "{guess}"?' if guess else ""
            table.problem(f'unknown kind "{shorten(name)}".{hint} Allowed: {", ".join(kinds)}.')
        return CheckSpec(id_, name, title, points, needs, hidden, {}, trial)
    if kind.advice and points != 0.0:
        table.problem(f'"points" is {points:g}; the kind "{name}" is advice, which is worth 0.')
    parameters = kind.parameters()
    params = {} if parameters is None else _params(table, name, parameters, kind.defaults(), numbers)
    return CheckSpec(id_, name, title, points, needs, hidden, params, trial)


def _params(
    table: Table,
    kind: str,
    parameters: Mapping[str, Allowed],
    defaults: Mapping[str, Param],
    numbers: NumbersSpec | None,
) -> dict[str, Param]:
    """Return the values of all parameters of a check. A key that is not a parameter is recorded as a mistake."""
    params = dict(defaults)
    for key, allowed in parameters.items():
        if key not in table.values:
            if key not in params:
                table.problem(f'the key "{key}" is missing; the kind "{kind}" needs it: {allowed.words}.')
            continue
        value = _param(table.values[key], allowed, numbers)
        if value is None:
            table.problem(f'"{key}" is {shown(table.values[key])}; it must be {allowed.words}.')
        else:
            params[key] = value
    table.finish(also=parameters)
    return params


def _param(value: object, allowed: Allowed, numbers: NumbersSpec | None) -> Param | None:
    """Return the value of a parameter, or None if the value is not allowed.

    For a student's own value, every value that a student can get must be allowed.
    """
    if isinstance(value, dict) and "own" in value:
        options = numbers.options.get(value["own"], ()) if numbers is not None and len(value) == 1 else ()
        fits = bool(options) and all(allowed.accept(option) is not None for option in options)
        return Own(value["own"]) if fits else None
    if isinstance(value, dict):
        fields = {key: _param(each, FIELD, numbers) for key, each in value.items()}
        return None if None in fields.values() else allowed.accept(fields)
    return allowed.accept(value)


def _circle(specs: tuple[CheckSpec, ...]) -> list[str]:
    """Return the ids of one cycle in `needs`, with the first id repeated at the end. Without a cycle, return no ids."""
    needs = {spec.id: [need for need in spec.needs if any(need == other.id for other in specs)] for spec in specs}
    done: set[str] = set()

    def walk(path: list[str]) -> list[str]:
        last = path[-1]
        if last in path[:-1]:
            return path[path.index(last) :]
        if last in done:
            return []
        for need in needs[last]:
            found = walk([*path, need])
            if found:
                return found
        done.add(last)
        return []

    for start in needs:
        found = walk([start])
        if found:
            return found
    return []
