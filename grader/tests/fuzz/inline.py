"""Read submissions in this process instead of a child process. Print the source line of an unexpected exception."""

from __future__ import annotations

import sys
import traceback
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from grader.errors import GraderError, TooLargeError, UnreadableError

if TYPE_CHECKING:
    from collections.abc import Callable

P = ParamSpec("P")
T = TypeVar("T")
ODD: set[str] = set()
"""The source lines that raised unexpected exceptions."""


class _Depth:
    inside = False


def read(function: Callable[P, T], *arguments: P.args, **keywords: P.kwargs) -> T:
    """Do the same as `reader.read`, but in this process."""
    if _Depth.inside:
        return function(*arguments, **keywords)
    _Depth.inside = True
    try:
        return function(*arguments, **keywords)
    except GraderError:
        raise
    except (MemoryError, RecursionError) as error:
        raise TooLargeError(str(error)) from error
    except Exception as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{type(error).__name__} at {last.filename}:{last.lineno}"
        if place not in ODD:
            ODD.add(place)
            print(f"Reported as unreadable: {place}", file=sys.stderr)
        raise UnreadableError(str(error)) from error
    finally:
        _Depth.inside = False
