"""Explain why a topic name is wrong, for example because it is misspelt or belongs to another turtle."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.edit import at
from grader.common.words import nearest
from grader.submission.constants import evaluate, written
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.edit import Edit
    from grader.evidence.evidence import Evidence


def why_topic(wanted: str, topic: str, evidence: Evidence) -> Cause:
    """Return the cause of a wrong topic name if the wrong name, the right name and the source show the cause."""
    last = wanted.rpartition("/")[2]
    if topic == f"/{last}":
        return Cause(
            "topic-without-turtle", "Each turtle has its own topic, so the topic name contains the name of the turtle."
        )
    if topic.lower() == wanted.lower():
        return Cause("topic-capitals", "Upper and lower case matter.")
    if topic.endswith(wanted) and not _is_absolute(evidence, topic):
        return Cause(
            "topic-namespace",
            "The node adds its namespace to the name. A name that starts with a slash stays as it is.",
        )
    if topic.endswith(f"/{last}") and topic.count("/") == 2 and nearest(topic, [wanted]):
        return Cause("topic-other-turtle", "There is no turtle with that name.")
    return Cause(
        "wrong-topic",
        "The topic name is the second argument of create_publisher. Compare the topic name letter by letter.",
    )


def _is_absolute(evidence: Evidence, topic: str) -> bool:
    """Return whether the source contains this full name, so that ROS 2 did not add a namespace to the name."""
    calls = evidence.code.calls("create_publisher")
    return any(evaluate(call.argument(1, "topic"), call.module.names) == topic for call in calls)


def right_name(evidence: Evidence, maker: str, topic: str, wanted: str) -> tuple[Edit, ...]:
    """Return the edit that replaces a topic name with the right one, if the source contains the name as a string."""
    for call in evidence.code.calls(maker):
        node = written(call.argument(1, "topic"), call.module.names)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and topic.endswith(node.value.strip("/")):
            return at(Where(call.module.file, node.lineno), node.value, wanted)
    return ()
