"""Explain why a topic name is wrong, for example because it is misspelt or belongs to another turtle."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_node_name import remapping_rule
from grader.checks.edit import at
from grader.common.words import nearest
from grader.submission.constants import evaluate, written
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.edit import Edit
    from grader.evidence.evidence import Evidence


def why_topic(wanted: str, topic: str, evidence: Evidence, maker: str = "create_publisher") -> Cause:
    """Return the cause of a wrong topic name, with the line that calls `maker` with this name, if known.

    `maker` is create_publisher or create_subscription.
    """
    cause = _why(wanted, topic, evidence, maker)
    return cause.at(_line(evidence, maker, topic)).fixed_by(right_name(evidence, maker, topic, wanted))


def _why(wanted: str, topic: str, evidence: Evidence, maker: str) -> Cause:
    last = wanted.rpartition("/")[2]
    parts = wanted.split("/")
    rule = remapping_rule(evidence, {wanted, *("/".join(parts[first:]) for first in range(1, len(parts)))}, topic)
    if rule is not None and _has_name(evidence, maker, wanted):
        return Cause("wrong-topic", "This remapping rule gives the topic another name.", rule)
    if topic == f"/{last}":
        return Cause(
            "topic-without-turtle", "Each turtle has its own topic, so the topic name contains the name of the turtle."
        )
    if topic.lower() == wanted.lower():
        return Cause("topic-capitals", "Upper and lower case matter.")
    added = "" if _is_absolute(evidence, maker, topic) else _added(evidence, topic, topic.removesuffix(wanted))
    if added:
        return Cause("topic-namespace", f"{added} A name that starts with a slash stays as it is.")
    of_turtles = wanted.count("/") == topic.count("/") == 2 and topic.endswith(f"/{last}")
    if of_turtles and nearest(topic, [wanted]) and not _has_turtle(evidence, topic):
        return Cause("topic-other-turtle", "There is no turtle with that name.")
    text = f"The topic name is the second argument of {maker}."
    if _has_turtle(evidence, topic):
        use = "This topic belongs to another turtle." if of_turtles else "turtlesim uses this topic for something else."
        return Cause("wrong-topic", f"{text} {use}")
    if nearest(topic, [wanted]):
        text = f"{text} Check the topic name letter by letter."
    return Cause("wrong-topic", text)


def _has_name(evidence: Evidence, maker: str, topic: str) -> bool:
    """Return whether a call in the source has this topic name."""
    names = (evaluate(call.argument(1, "topic"), call.module.names) for call in evidence.code.calls(maker))
    return any(isinstance(name, str) and topic.endswith(f"/{name.strip('/')}") for name in names)


def _has_turtle(evidence: Evidence, topic: str) -> bool:
    """Return whether the simulator uses the topic. If it does, the turtle in the topic's name exists."""
    ends = (end for graph in evidence.recording.graphs for end in graph.endpoints)
    return any(end.topic == topic and end.node == "/turtlesim" for end in ends)


def _added(evidence: Evidence, topic: str, begin: str) -> str:
    """Return the sentence that says why ROS 2 puts `begin` before a topic name, or "" if no node explains it."""
    nodes = {end.node for graph in evidence.recording.graphs for end in graph.endpoints if end.topic == topic}
    if begin != topic and begin in nodes:
        return "ROS 2 replaces ~ at the beginning of a topic name with the name of the node."
    inside = any(name.startswith(f"{begin}/") for name in nodes)
    return "The node adds its namespace to the name." if begin != topic and inside else ""


def _is_absolute(evidence: Evidence, maker: str, topic: str) -> bool:
    """Return whether the source contains the whole topic name. If it does, ROS 2 did not add a namespace to it."""
    names = (evaluate(call.argument(1, "topic"), call.module.names) for call in evidence.code.calls(maker))
    return any(name in (topic, topic.removeprefix("/")) for name in names)


def _line(evidence: Evidence, maker: str, topic: str) -> Where | None:
    """Return the line of the call that has this topic name, or None."""
    for call in evidence.code.calls(maker):
        value = evaluate(call.argument(1, "topic"), call.module.names)
        if isinstance(value, str) and topic.endswith(f"/{value.strip('/')}"):
            return call.where
    return None


def right_name(evidence: Evidence, maker: str, topic: str, wanted: str) -> tuple[Edit, ...]:
    """Return the edit that replaces a topic name with the right one, if the source contains the name as a string."""
    for call in evidence.code.calls(maker):
        node = written(call.argument(1, "topic"), call.module.names)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and topic.endswith(node.value.strip("/")):
            return at(Where(call.module.file, node.lineno), node.value, wanted)
    return ()
