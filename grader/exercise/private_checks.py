"""An instructor's private checks: a folder like course/, with exercise.toml files outside the repository.

Such a file modifies the exercise.toml of the course:

    schema = 2
    [[check]]       If the id is in the course, these keys override those of the course's check (all of its keys if the
                    kind differs). A new id adds a check. A check that is new, or that judges something other than
                    the course's check, is hidden unless it has `hidden = false`.
    [[trial]]       A trial is changed or added in the same way, by its id.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.common.words import a_list, nearest, shorten
from grader.errors import UsageError
from grader.exercise.exercise_toml import SCHEMA, of_older_schema, parse_tables
from grader.exercise.model import FILE_NAME, catalogue
from grader.exercise.presets import expand
from grader.exercise.tables import read_toml

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from grader.exercise.kind_spec import KindSpec
    from grader.exercise.model import Exercise

ALLOWED = ("schema", "check", "trial")
_SHOWN = frozenset({"points", "title", "needs"})
"""The keys that a private check can change without being hidden, since they are not part of what the check judges."""


@dataclass(frozen=True)
class Sources:
    """The files of an exercise: the exercise.toml of the course and, if there is one, the private file (bytes)."""

    id: str
    public: bytes
    private: bytes | None = None
    private_name: str = ""
    """The name of the private file in messages."""

    def exercise(self, folder: Path, kinds: Mapping[str, KindSpec]) -> Exercise:
        """Return the exercise. `folder` is the folder of the lesson. Raises UsageError, which lists all mistakes."""
        name = f"{self.id}/{FILE_NAME}"
        public = read_toml(self.public, name)
        digest = hashlib.sha256(self.public).hexdigest()
        if self.private is None:
            return parse_tables(public, name, folder, digest, kinds)
        private = read_toml(self.private, self.private_name)
        merged = merge(public, private, self.private_name)
        both = f"{digest} {hashlib.sha256(self.private).hexdigest()}"
        named = f"{self.private_name}, merged into the course's exercise"
        return parse_tables(merged, named, folder, hashlib.sha256(both.encode()).hexdigest(), kinds)


def sources_of(ids: set[str], checks: Path | None) -> dict[str, Sources]:
    """Return the files of the exercises with these ids. `checks` is the folder of private checks.

    Raises:
        UsageError: the folder has no checks, no checks for these exercises, or checks for an unknown exercise.
    """
    files = catalogue()
    private = _private_files(checks, files) if checks else {}
    if checks and not private.keys() & ids:
        message = f"{checks} has checks for {a_list(sorted(private))}, but none for {a_list(sorted(ids))}."
        raise UsageError(message)
    return {
        name: Sources(
            name,
            files[name].read_bytes(),
            private[name].read_bytes() if name in private else None,
            str(private.get(name, "")),
        )
        for name in sorted(ids)
    }


def _private_files(checks: Path, known: Mapping[str, Path]) -> dict[str, Path]:
    found = {file.parent.name: file for file in sorted(checks.glob(f"*/{FILE_NAME}"))}
    if not found:
        message = (
            f"There are no checks in {checks}. The folder needs the same layout as course/, for example "
            f"03-circle-publisher/{FILE_NAME}."
        )
        raise UsageError(message)
    for name in found:
        if name not in known:
            guess = nearest(name, known)
            hint = f" Did you mean {guess}?" if guess else ""
            message = f"{found[name]}: there is no exercise {name}.{hint} The exercises are {', '.join(known)}."
            raise UsageError(message)
    return found


def merge(public: Mapping[str, Any], private: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Return the tables of the two files as one table.

    Raises UsageError if the private file has another schema, or keys or values that are not allowed at its top level.
    """
    older = of_older_schema(private)
    if older:
        message = f"{name}: {older}"
        raise UsageError(message)
    unknown = [key for key in private if key not in ALLOWED]
    if unknown or private.get("schema") != SCHEMA:
        schema = f"schema is {private['schema']!r}, not {SCHEMA}" if "schema" in private else "schema is missing"
        mistake = f'unknown key "{unknown[0]}"' if unknown else schema
        message = f"{name}: {mistake}. A file of private checks may contain {a_list(ALLOWED)}."
        raise UsageError(message)
    own_trials = _tables(private, "trial", name)
    _require_different_ids(own_trials, "trial", name)
    trials = _laid_over(list(public.get("trial", [])), own_trials)
    checks = expand(public.get("check", []), trials)
    known = {each.get("id"): each for each in checks}
    own = expand(_tables(private, "check", name), trials)
    _require_different_ids(own, "check", name)
    above = [{"hidden": True, **each} if _is_secret(each, known.get(each.get("id"))) else each for each in own]
    return {**public, "trial": trials, "check": _laid_over(checks, above)}


def _is_secret(private: Mapping[str, Any], public: Mapping[str, Any] | None) -> bool:
    """Return whether a private check is new, or judges something other than the course's check with the same id.

    A preset that contains a mistake has not been expanded, and stays as it is for the message about the mistake.
    """
    if "preset" in private:
        return False
    if public is None:
        return True
    return any(value != public.get(key) for key, value in private.items() if key not in _SHOWN)


def _tables(private: Mapping[str, Any], key: str, name: str) -> list[dict[str, Any]]:
    value = private.get(key, [])
    if not isinstance(value, list) or not all(isinstance(each, dict) for each in value):
        message = f'{name}: "{key}" must be an array of tables, [[{key}]].'
        raise UsageError(message)
    return value


def _require_different_ids(tables: list[dict[str, Any]], key: str, name: str) -> None:
    """Raise UsageError if two tables have the same id: the second would silently override the first."""
    ids = [each["id"] for each in tables if isinstance(each.get("id"), str)]
    twice = next((each for number, each in enumerate(ids) if each in ids[:number]), None)
    if twice is not None:
        message = f'{name}: two tables [[{key}]] have the id "{shorten(twice)}". Merge them, or change one of the ids.'
        raise UsageError(message)


def _laid_over(below: list[dict[str, Any]], above: list[dict[str, Any]]) -> list[dict[str, Any]]:
    place = {each.get("id"): index for index, each in enumerate(below)}
    for each in above:
        at = place.get(each.get("id"))
        if at is None:
            below.append(each)
        elif "kind" in each and each["kind"] != below[at].get("kind"):
            below[at] = each
        else:
            below[at] = {**below[at], **each}
    return below
