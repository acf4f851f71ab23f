"""Own numbers: the circle that a student drives in step 07, derived from the student's id.

`grader start` writes them to my_numbers.toml in the package. They depend only on the id, so a check can detect numbers
that were changed.
"""

from __future__ import annotations

import hashlib
import sys
import unicodedata
from dataclasses import dataclass

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FILE = "my_numbers.toml"
RADII_M = (0.8, 1.0, 1.2, 1.4, 1.6, 1.8)
RATES_HZ = (2.0, 2.5, 4.0, 5.0)
DIRECTIONS = ("counter-clockwise", "clockwise")


@dataclass(frozen=True)
class OwnNumbers:
    """A circle with the radius `radius_m` (m), driven in this direction with `rate_hz` commands per second."""

    student: str
    radius_m: float
    direction: str
    rate_hz: float


def normal_id(student: str) -> str:
    """Return the normal form of an id, which ignores case, character width and extra spaces.

    Ids are compared, and numbers are drawn, in this form. Otherwise, students could try different spellings of their
    ids until they get the same numbers as a friend.
    """
    folded = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", student).casefold())
    return " ".join(folded.split())


def draw_numbers(student: str) -> OwnNumbers:
    """Return the numbers of a student. They are the same on every machine and for every spelling (see `normal_id`)."""
    drawn = hashlib.sha256(f"07-challenges {normal_id(student)}".encode("utf-8", "surrogatepass")).digest()
    return OwnNumbers(
        student,
        RADII_M[drawn[0] % len(RADII_M)],
        DIRECTIONS[drawn[1] % len(DIRECTIONS)],
        RATES_HZ[drawn[2] % len(RATES_HZ)],
    )


def to_toml(numbers: OwnNumbers) -> str:
    """Return the text of my_numbers.toml. The id can be any string."""
    escaped = "".join(
        char if char.isprintable() and char not in '"\\' else f"\\U{ord(char):08X}" for char in numbers.student
    )
    return (
        "# The numbers of your own circle. They come from your id: leave this file as it is, "
        "and write them into your node.\n"
        f'student = "{escaped}"\n'
        f"radius_m = {numbers.radius_m}\n"
        f'direction = "{numbers.direction}"\n'
        f"rate_hz = {numbers.rate_hz}\n"
    )


def from_toml(data: bytes) -> OwnNumbers:
    """Return the numbers in a my_numbers.toml. Raises ValueError with the reason if the file is wrong."""
    try:
        table = tomllib.loads(data.decode("utf-8-sig"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        message = f"it cannot be read ({error})"
        raise ValueError(message) from error
    student, direction = table.get("student"), table.get("direction")
    radius, rate = table.get("radius_m"), table.get("rate_hz")
    if not (isinstance(student, str) and isinstance(direction, str)):
        message = "student or direction is missing, or not a string"
        raise ValueError(message)  # noqa: TRY004
    if not (isinstance(radius, int | float) and isinstance(rate, int | float)):
        message = "radius_m or rate_hz is missing, or not a number"
        raise ValueError(message)  # noqa: TRY004
    return OwnNumbers(student, float(radius), direction, float(rate))
