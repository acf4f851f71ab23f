"""Shell completion for the names of steps. This module reads the names of the course's folders but parses no files."""

from __future__ import annotations


def steps(incomplete: str) -> list[str]:
    """Return the steps that begin with the typed text. "3" and "03" are the same step."""
    from grader.exercise.model import catalogue

    known = list(catalogue())
    return [name for name in known if name.startswith(incomplete) or name.lstrip("0").startswith(incomplete)]


def steps_or_next(incomplete: str) -> list[str]:
    """Return the steps that begin with the typed text, and "next", for `grader start`."""
    return [*steps(incomplete), *(["next"] if "next".startswith(incomplete) else [])]
