"""Decide whether the cause of a failed check is a fact or only a possibility.

A cause is a fact if the files, the build, an exception or the recording show it directly, or if a test has proved it:
after the suggested fix, the check passes or the node gets further. All other causes are conclusions from the source
code or from the node's behaviour, and may be wrong. A diagnosis that is not in the list `FACTS` is a possibility.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from grader.checks.diagnoses_of_files import OF_FILES
from grader.checks.kinds import KINDS
from grader.report.report import FURTHER, PASSES

if TYPE_CHECKING:
    from grader.checks.outcome import Outcome

OF_EXCEPTIONS = frozenset(
    {
        "crash",
        "needs-stdin",
        "no-object",
        "node-name-invalid",
        "topic-name-invalid",
        "parameter-undeclared",
        "parameter-itself",
        "timer-period-negative",
        "init-twice",
    }
)
"""Diagnoses that follow from the exception alone, in addition to those in `OF_FILES`."""
OF_RECORDINGS = frozenset(
    {
        # The graph: names and types of nodes, topics, services and actions.
        "node-name",
        "node-namespace",
        "wrong-type",
        "second-type",
        "topic-without-turtle",
        "topic-capitals",
        "qos-mismatch",
        "action-name",
        "action-type",
        # The values and times of messages, calls and goals.
        "wrong-value",
        "wrong-sign",
        "wrong-field",
        "wrong-direction",
        "intervention",
        "goal-replaced",
        "goal-aborted-by-command",
        "not-driven",
        "drives-before-pose",
        # Log lines and their numbers.
        "before-first-pose",
        "log-format",
        "log-capitals",
        "log-more",
        "counter-step",
        "x-y-swapped",
        # The result of a call, and the output of a program.
        "result-order",
        "nanoseconds",
        "rate-off-by-one",
        "program-traceback",
        "exit-code",
    }
)
"""Diagnoses that state only what the recording shows. Some of them add a rule of ROS 2 or of mathematics."""
FACTS = OF_EXCEPTIONS.union(OF_RECORDINGS, *OF_FILES.values())


def is_certain(outcome: Outcome) -> bool:
    """Return whether the cause of this failed check is a fact."""
    finding = outcome.finding
    kind = KINDS.get(outcome.kind)
    judges_files = kind is not None and kind.stage != "trial"
    return judges_files or finding.diagnosis in FACTS or finding.tried.startswith((PASSES, FURTHER))


def cause_label(outcome: Outcome) -> Literal["why", "likely"]:
    """Return the label of the cause in a list of labels and texts."""
    return "why" if is_certain(outcome) else "likely"


def cause_sentence(outcome: Outcome) -> str:
    """Return the cause as a sentence that says "Likely cause" if the cause is not certain.

    If there is no cause, the sentence is empty.
    """
    cause = outcome.finding.cause
    return cause if is_certain(outcome) or not cause else f"Likely cause: {cause}"
