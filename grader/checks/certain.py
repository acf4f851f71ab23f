"""The diagnoses that are facts, and the diagnoses that hold even if the machine was busy.

The two properties are independent. "rclpy.spin is called with None" is a fact, and a busy machine cannot cause it.
"rclpy.spin is not called" also holds on every machine, but it is a conclusion from the source code and may not be the
true cause. "The node drives before the first pose" is a fact that the recording shows, but a busy machine can cause it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.diagnoses_of_files import OF_FILES

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis

FROM_FILES: frozenset[Diagnosis] = frozenset().union(*OF_FILES.values())
FROM_EXCEPTIONS: frozenset[Diagnosis] = frozenset(
    {
        "crash",
        "bag-reader",
        "no-values",
        "changed-in-a-loop",
        "asyncio-in-callback",
        "parameter-twice",
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
FROM_GRAPH: frozenset[Diagnosis] = frozenset(
    {
        "node-name",
        "node-namespace",
        "wrong-type",
        "second-type",
        "topic-without-turtle",
        "topic-capitals",
        "qos-mismatch",
        "action-name",
        "action-type",
    }
)
"""Mistakes in the names, types and QoS settings of nodes, topics and actions."""
FROM_CONTENT: frozenset[Diagnosis] = frozenset(
    {
        "wrong-value",
        "wrong-sign",
        "wrong-field",
        "intervention",
        "not-driven",
        "log-format",
        "log-capitals",
        "log-more",
        "x-y-swapped",
    }
)
"""Mistakes in the contents of messages, calls, goals and log lines, regardless of when these arrived."""
FROM_ORDER: frozenset[Diagnosis] = frozenset(
    {
        "wrong-direction",
        "goal-replaced",
        "goal-aborted-by-command",
        "drives-before-pose",
        "before-first-pose",
        "counter-step",
        "result-order",
        "nanoseconds",
        "rate-off-by-one",
        "program-traceback",
        "exit-code",
    }
)
"""Facts that the recording, a result or a program's output shows. A busy machine can cause some of them."""
CONCLUSIONS: frozenset[Diagnosis] = frozenset(
    {
        "no-init",
        "no-spin",
        "no-publish",
        "no-log",
        "print-instead",
        "forbidden-call",
        "topic-namespace",
        "topic-other-turtle",
        "service-type",
        "values-swapped",
        "degrees",
        "empty-twist",
        "not-a-number",
        "wrong-goal",
        "wrong-request",
        # A rate is measured only from intervals in which the machine did not stall.
        "timer-period",
        "rate-for-period",
        "sleep-period",
        "timer-milliseconds",
        "wrong-rate",
    }
)
"""Conclusions from the source code or from values, which are the same on a busy machine."""

SHOWN = FROM_FILES | FROM_EXCEPTIONS | FROM_GRAPH | FROM_CONTENT
FACTS = SHOWN | FROM_ORDER
"""In checks of a trial, a report states these causes as facts, and all other causes as possibilities until a tested fix
confirms them. In checks of the files or the build, every cause counts as a fact (grader/report/certainty.py)."""
ON_EVERY_MACHINE = SHOWN | CONCLUSIONS
"""Diagnoses that also hold on a busy machine. In wall time, too little processor time may be the reason for
any other diagnosis."""
