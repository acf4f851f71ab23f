"""Say how a process ended."""

from __future__ import annotations

import signal


def how_ended(code: int) -> str:
    """Return how a process ended, from its return code in `subprocess`, which is negative after a signal.

    Example:
        >>> how_ended(-11)
        'was killed (SIGSEGV)'
        >>> how_ended(2)
        'ended with exit code 2'
    """
    if code >= 0:
        return f"ended with exit code {code}"
    try:
        name = signal.Signals(-code).name
    except ValueError:  # most real-time signals have no name
        name = f"signal {-code}"
    return f"was killed ({name})"


def program_ended(name: str, code: int) -> str:
    """Return the line that the learner reads below the output of a program that has ended by itself."""
    how = "ended without an error." if code == 0 else f"{how_ended(code)}. The lines above may show where and why."
    return f"\n{name} {how}"
