"""Read the parts of a submission that nbgrader needs, in the reading process (submission/reader.py).

nbgrader follows links, copies files of any size, and parses any notebook in its own process. Therefore, the grader's
steps first call the functions in this module, which check the time, the secret and the size and depth of a notebook.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from grader.errors import TooLargeError, UnreadableError
from grader.gradebook.budget import walk
from grader.submission import tree

if TYPE_CHECKING:
    from datetime import datetime
    from pathlib import Path

TIMESTAMP = "timestamp.txt"
"""The file in which nbgrader stores the time of a submission."""
SECRET = "submission_secret.txt"
"""The file with the secret of a submission. The secret determines the name of the page with the feedback."""
MOST_TIMESTAMP = 100
"""The maximum size of the file with the time of a submission (bytes)."""
MOST_SECRET = 1000
"""The maximum size of the file with the secret of a submission (bytes). `nbgrader submit` writes 128 bytes."""
YEARS = range(2000, 2100)
"""The years in which a time is valid. A time in the year 9999 could make nbgrader's formgrader fail for the whole
class, because of time zones."""
MOST_BYTES = tree.MAX_FILE_BYTES
"""The maximum size of a notebook (bytes)."""
MOST_VALUES = 500_000
"""The maximum number of keys and values in the JSON of a notebook."""
MOST_DEPTH = 50
"""The maximum nesting depth of the objects and lists in a notebook."""
MOST_CELLS = 1000


def time_of(folder: Path) -> datetime | None:
    """Return the time when the submission was handed in, in UTC, or None if the time stamp is missing or empty.

    Raises:
        UnreadableError: the file is not a regular file with a valid time.
    """
    from nbgrader.utils import parse_utc

    path = folder / TIMESTAMP
    if not os.path.lexists(path):
        return None
    data = _content(path, MOST_TIMESTAMP)
    if not data.strip():
        return None
    try:
        when: datetime = parse_utc(data.decode().strip())
        if when.year not in YEARS:
            raise ValueError(when.year)  # noqa: TRY301
    except Exception as error:  # dateutil raises other exceptions than ValueError, too
        message = f"{TIMESTAMP} does not contain a valid time"
        raise UnreadableError(message) from error
    return when


def require_listable(folder: Path) -> None:
    """Check the files that `nbgrader list --inbound` reads: the notebooks and the secret.

    Raises:
        UnreadableError: one of these files is not a regular file, or is too large.
        UnicodeDecodeError: the secret is not UTF-8. The reading process turns this exception into an UnreadableError.
    """
    for path in sorted(folder.glob("*.ipynb")):
        _content(path, MOST_BYTES)
    secret = folder / SECRET
    if os.path.lexists(secret):
        _content(secret, MOST_SECRET).decode()


def notebook(path: Path) -> str:
    """Return the notebook as JSON in the newest format that nbgrader uses.

    Raises:
        TooLargeError: the notebook exceeds one of the limits in this module.
        UnreadableError: the path does not lead to a regular file.
        Exception: the file is not a notebook. The reading process turns the exception into an UnreadableError.
    """
    import nbformat

    text = _content(path, MOST_BYTES).decode("utf-8", "strict")
    _require_small(nbformat.reader.parse_json(text))  # type: ignore[no-untyped-call]
    found = nbformat.reads(text, as_version=4)  # type: ignore[no-untyped-call]
    if len(found.cells) > MOST_CELLS:
        message = f"{path.name} has {len(found.cells)} cells, but the maximum is {MOST_CELLS}"
        raise TooLargeError(message)
    written: str = nbformat.writes(found)  # type: ignore[no-untyped-call]
    written.encode()  # raises an error for half of a surrogate pair, which cannot be written to a file
    _require_small(found)
    return written


def _require_small(read: object) -> None:
    for number, (_, depth) in enumerate(walk(read)):
        if number >= MOST_VALUES:
            message = f"the notebook has more than {MOST_VALUES} values"
            raise TooLargeError(message)
        if depth > MOST_DEPTH:
            message = f"the notebook has objects nested more than {MOST_DEPTH} levels deep"
            raise TooLargeError(message)


def _content(path: Path, most: int) -> bytes:
    """Return the content of a regular file."""
    try:
        with tree.open_file(path) as file:
            data = file.read(most + 1)
    except OSError as error:
        message = f"{path.name} {tree.reason(error, path.name)}"
        raise UnreadableError(message) from error
    except ValueError as error:
        raise UnreadableError(str(error)) from error
    if len(data) > most:
        message = f"{path.name} is larger than the maximum of {most} bytes"
        raise TooLargeError(message)
    return data
