"""Check that the node does not call certain functions, for exercises that forbid them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.kind import Kind, string, strings
from grader.checks.outcome import Finding, failed, passed
from grader.common.words import a_list, shorten
from grader.submission.uses import uses_of

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


@dataclass(frozen=True, kw_only=True)
class NoCalls:
    """The names of functions (without module or object) that the node's file must not use, and the reason."""

    names: tuple[str, ...] = strings(
        about="The names of the functions without module or object, such as `sleep` for `time.sleep`."
    )
    cause: str = string("a reason", about="The reason that the student reads if the check fails.")


def no_calls(evidence: Evidence, params: NoCalls) -> Finding:
    """The node's file does not use any of the functions, not even under another name."""
    uses = uses_of(evidence.code.modules, evidence.node_file, params.names)
    if uses:
        first = uses[0]
        alias = f", which is {first.name}" if first.written != first.name else ""
        observed = f"The node uses {shorten(first.written)}{alias}."
        expected = f"The node does not use {a_list(params.names, 'or')}."
        return failed(observed, expected, Cause("forbidden-call", params.cause, first.where))
    return passed(f"The node does not use {a_list(params.names, 'or')}.")


NO_CALLS = Kind(
    "no_calls",
    "source",
    "The node does not call certain functions",
    NoCalls,
    no_calls,
    about="The node's file uses none of the given functions, not even under another name.",
)
