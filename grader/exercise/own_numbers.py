"""Students' own numbers: the values of an exercise that differ between students, derived from the student's id.

The table `[numbers]` in exercise.toml lists the possible values. `grader start` writes the student's own values to a
TOML file in the package. The values depend only on the exercise and the student's id, so a check can detect values that
were changed. If a parameter of a check is `{ own = "radius_m" }`, the parameter gets the student's own value.
"""

from __future__ import annotations

import hashlib
import sys
import unicodedata
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.words import UNSAFE_CATEGORIES

if TYPE_CHECKING:
    from collections.abc import Mapping

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Value = str | float | int


_INVISIBLE = frozenset(
    {0x034F, 0x115F, 0x1160, 0x17B4, 0x17B5, 0x2800}
    | {*range(0x180B, 0x1810), *range(0xFE00, 0xFE10), *range(0xE0100, 0xE01F0)}
)
"""Invisible letters and marks: Default_Ignorable_Code_Point in Unicode's DerivedCoreProperties.txt,
without the characters in UNSAFE_CATEGORIES, and the empty Braille pattern."""


SAME = "capital letters, character width, extra spaces, invisible characters and the encoding of accents do not count"
"""The differences that `normal_id` ignores, as a clause for messages."""


@dataclass(frozen=True)
class Own:
    """A placeholder for the student's own value with this name."""

    name: str


@dataclass(frozen=True)
class NumbersSpec:
    """The table `[numbers]` of the exercise `step`: the file in the package, and the possible values of each number."""

    step: str
    file: str
    options: Mapping[str, tuple[Value, ...]]


@dataclass(frozen=True)
class OwnNumbers:
    """The values of one student, each with its name. If a value has a unit, its name contains the unit."""

    student: str
    values: Mapping[str, Value]


def normal_id(student: str) -> str:
    """Return the normal form of an id, which ignores case, character width, extra spaces and invisible characters.

    A letter with an accent is the same whether it is one character or two (NFC and NFD). The normal form is used for
    comparing ids and for choosing the numbers. Without the normal form, students could spell their ids in different
    ways until they get the same numbers as a friend.
    """
    folded = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", student).casefold())
    return " ".join("".join(char for char in folded if char.isspace() or _counts(char)).split())


def _counts(char: str) -> bool:
    # The name of a folder can contain bytes that are not UTF-8. Python reads each of them as a surrogate.
    kind = unicodedata.category(char)
    return ord(char) not in _INVISIBLE and (kind == "Cs" or kind not in UNSAFE_CATEGORIES)


def without_surrogates(student: str) -> str:
    """Return the id without surrogates, which TOML cannot contain."""
    return "".join(char for char in student if unicodedata.category(char) != "Cs")


def draw_numbers(spec: NumbersSpec, student: str) -> OwnNumbers:
    """Return a student's individual numbers.

    The numbers are the same on every machine and for every spelling of the student's id (see `normal_id`). Surrogates
    do not count, because the file cannot contain them.
    """
    drawn = hashlib.sha256(f"{spec.step} {normal_id(without_surrogates(student))}".encode()).digest()
    values = {
        name: options[byte % len(options)] for byte, (name, options) in zip(drawn, spec.options.items(), strict=False)
    }
    return OwnNumbers(student, values)


def to_toml(numbers: OwnNumbers) -> str:
    """Return the text of the file. The id can be any string.

    Surrogates are left out of the id. The numbers do not depend on them (see `draw_numbers`).
    """
    escaped = "".join(
        char if char.isprintable() and char not in '"\\' else f"\\U{ord(char):08X}"
        for char in without_surrogates(numbers.student)
    )
    lines = [
        "# Your own numbers. They come from your id: do not change this file. The lesson says where to write them.",
        f'student = "{escaped}"',
        *(
            f'{name} = "{value}"' if isinstance(value, str) else f"{name} = {value}"
            for name, value in numbers.values.items()
        ),
    ]
    return "\n".join(lines) + "\n"


def from_toml(spec: NumbersSpec, data: bytes) -> OwnNumbers:
    """Return the numbers in the file. Raises ValueError with the reason if the file is wrong."""
    try:
        table = tomllib.loads(data.decode("utf-8-sig"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        message = f"it cannot be read ({error})"
        raise ValueError(message) from error
    student = table.get("student")
    if not isinstance(student, str):
        message = "student is missing, or not a string"
        raise ValueError(message)  # noqa: TRY004
    for name, options in spec.options.items():
        value = table.get(name)
        if isinstance(value, str) != isinstance(options[0], str) or not isinstance(value, str | int | float):
            message = f"{name} is missing, or not a {'string' if isinstance(options[0], str) else 'number'}"
            raise ValueError(message)
    return OwnNumbers(student, {name: table[name] for name in spec.options})
