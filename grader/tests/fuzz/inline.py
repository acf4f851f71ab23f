"""The door to reading without its process: what that does with errors, and a count of those that are not ours."""

from __future__ import annotations

import traceback
from collections import Counter
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from grader.errors import GraderError, TooLargeError, UnreadableError

if TYPE_CHECKING:
    from collections.abc import Callable

P = ParamSpec("P")
T = TypeVar("T")
ODD: Counter[str] = Counter()
"""Where an error that is not ours came from -> how often."""


class _Depth:
    inside = False


def read(function: Callable[P, T], *arguments: P.args, **keywords: P.kwargs) -> T:
    """As `reader.read`."""
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
        ODD[f"{type(error).__name__} at {last.filename}:{last.lineno}"] += 1
        raise UnreadableError(str(error)) from error
    finally:
        _Depth.inside = False
