"""Check that the node does its work without certain functions, where doing without them is the task."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.kind import Kind, text, texts
from grader.checks.outcome import Finding, failed, passed
from grader.common.words import a_list

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


@dataclass(frozen=True, kw_only=True)
class NoCalls:
    """The last names of functions that the node's file must not call, and why."""

    names: tuple[str, ...] = texts(about="The last names of the functions, as `sleep` for `time.sleep`.")
    cause: str = text("a reason", about="What the student reads as the reason.")


def no_calls(evidence: Evidence, params: NoCalls) -> Finding:
    """The node's file calls none of the functions."""
    file = evidence.node_file
    calls = [call for name in params.names for call in evidence.code.calls(name) if call.module.file == file]
    if calls:
        name = (calls[0].node.func.attr if hasattr(calls[0].node.func, "attr") else None) or params.names[0]
        expected = f"No call of {a_list(params.names, 'or')}."
        return failed("forbidden-call", f"The node calls {name}.", expected, params.cause, where=calls[0].where)
    return passed(f"The node does not call {a_list(params.names, 'or')}.")


NO_CALLS = Kind(
    "no_calls",
    "source",
    "The node does without certain functions",
    NoCalls,
    no_calls,
    about="The node's file calls none of the given functions.",
)
