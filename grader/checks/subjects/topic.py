"""Checks of a topic: the node publishes or subscribes with the right type, and no other type is published."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.hidden_error import hidden_error
from grader.checks.causes.why_blocked import WAKES
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_ended import loops, why_ended
from grader.checks.causes.why_inactive import never_activated
from grader.checks.causes.why_not_set import compared_condition
from grader.checks.causes.why_silent import returns_before, why_nothing, why_qos
from grader.checks.causes.wrong_topic import why_topic
from grader.checks.kind import Kind, string
from grader.checks.outcome import Finding, failed, passed
from grader.common.words import a_list, nearest, shorten
from grader.evidence import activity
from grader.submission.constants import evaluate

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.evidence.evidence import Evidence
    from grader.submission.where import Where
    from grader.trial.recording import Endpoint


@dataclass(frozen=True, kw_only=True)
class Topic:
    """The full name of the topic, and its message type, such as "geometry_msgs/msg/Twist"."""

    topic: str = string("the full name of a topic", start="/", about="The topic of the messages.")
    type: str = string(
        "a message type, such as geometry_msgs/msg/Twist", about="The type of the messages on the topic."
    )


COMMANDS = Topic(topic="/turtle1/cmd_vel", type="geometry_msgs/msg/Twist")
"""The topic for the velocity commands of turtle1. The commands that the simulator received are in
Recording.commands."""


def publishes(evidence: Evidence, params: Topic) -> Finding:
    """Messages of the right type arrived on the topic before SIGINT."""
    recording = evidence.recording
    if _arrived(evidence, params):
        return passed(_expected(params))
    publishers = activity.endpoints(recording, "publisher")
    on_topic = [publisher for publisher in publishers if publisher.topic == params.topic]
    if any(publisher.type == params.type for publisher in on_topic):
        return _silent(evidence, params)
    if on_topic:
        return _wrong_type(evidence, params, on_topic)
    # If the node crashed, publishers of other types may be right, and the crash explains what is missing.
    if any(publisher.type == params.type for publisher in publishers) or (publishers and crash_of(evidence) is None):
        return _wrong_topic(evidence, params, publishers)
    return _no_publisher(evidence, params)


def _arrived(evidence: Evidence, params: Topic) -> bool:
    recording = evidence.recording
    until = activity.end_s(recording)
    if params.topic == COMMANDS.topic and params.type == COMMANDS.type:
        return bool(evidence.commands)
    return any(
        each.topic == params.topic and each.type == params.type and each.t_s < until for each in recording.messages
    )


def _expected(params: Topic) -> str:
    return f"{params.type} messages arrive on {params.topic}."


def _wrong_type(evidence: Evidence, params: Topic, publishers: list[Endpoint]) -> Finding:
    types = _types({publisher.type for publisher in publishers})
    whose = "which the turtle does not understand" if params == COMMANDS else f"and not {params.type}"
    observed = f"The node publishes on {params.topic} with {types}, {whose}."
    cause = "The message type is the first argument of create_publisher."
    return failed(observed, _expected(params), Cause("wrong-type", cause, _publisher_line(evidence, params.topic)))


def _types(names: Iterable[str]) -> str:
    """Return 'the type a' or 'the types a and b'."""
    shown = sorted({shorten(name) for name in names})
    return f"the {'type' if len(shown) == 1 else 'types'} {a_list(shown)}"


def _wrong_topic(evidence: Evidence, params: Topic, publishers: tuple[Endpoint, ...]) -> Finding:
    same_type = [publisher for publisher in publishers if publisher.type == params.type]
    topics = sorted({publisher.topic for publisher in same_type or publishers})
    guess = nearest(params.topic, topics)
    shown = [guess] if guess is not None else topics
    them = "it" if len(shown) == 1 else "them"
    nobody = f"turtle1 does not subscribe to {them}" if params == COMMANDS else f"not on {params.topic}"
    observed = f"The node publishes on {a_list([shorten(topic) for topic in shown])}, but {nobody}."
    why = why_topic(params.topic, shown[0], evidence)
    return failed(observed, _expected(params), why.at(_publisher_line(evidence, shown[0])))


def _no_publisher(evidence: Evidence, params: Topic) -> Finding:
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), _expected(params))
    subscribed = [each for each in activity.endpoints(evidence.recording, "subscription") if each.topic == params.topic]
    if subscribed:
        cause = "A subscription only receives messages. Use create_publisher to send messages."
        where = evidence.place("create_subscription")
        return failed(
            f"The node subscribes to {params.topic}.", _expected(params), Cause("subscription-instead", cause, where)
        )
    observed = end_observed(evidence) or "The node has no publisher."
    why = never_activated(evidence)
    if why is None and evidence.code.calls("create_publisher"):
        why = why_nothing(evidence, ("publish",))
    if why is not None:
        return failed(observed, _expected(params), why)
    cause = "" if evidence.code.calls("create_publisher") else "create_publisher is never called."
    return failed(observed, _expected(params), Cause("no-publisher", cause, evidence.place("create_publisher")))


def _silent(evidence: Evidence, params: Topic) -> Finding:
    """Return the finding about a publisher that sent nothing, although its topic and type are right."""
    observed = f"There is a publisher on {params.topic}, but no message arrived after the start."
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), _expected(params))
    if evidence.recording.end.by == "itself":
        why = why_ended(evidence)
        return failed(f"{observed} {end_observed(evidence)}", _expected(params), why)
    why = _why_silent(evidence)
    observed = f"{observed} {end_observed(evidence)}".rstrip()
    return failed(observed, _expected(params), why)


def _why_silent(evidence: Evidence) -> Cause:
    code = evidence.code
    if not code.calls("publish"):
        return Cause("no-publish", "publish is never called.", code.start)
    why = why_qos(evidence) or why_nothing(evidence, ("publish",)) or compared_condition(evidence)
    if why is not None:
        return why.at(code.start)
    text = "The line that publishes may never run, or it may run only at the start, before anything subscribes."
    if not any(code.calls(name) for name in WAKES) and not loops(evidence):
        text = "create_timer is never called, and there is no loop, so nothing publishes repeatedly."
    known = returns_before(evidence, "publish") or hidden_error(evidence, "publish")
    return known or Cause("never-publishes", text, evidence.place("publish"))


def _publisher_line(evidence: Evidence, topic: str) -> Where | None:
    """Return the line that creates the publisher of this topic.

    If there is no such line, return the line that creates the first publisher, the node's file, or None.
    """
    calls = evidence.code.calls("create_publisher")
    for call in calls:
        value = evaluate(call.argument(1, "topic"), call.module.names)
        if isinstance(value, str) and topic.endswith(f"/{value.strip('/')}"):
            return call.where
    return calls[0].where if calls else evidence.code.start


def only_type(evidence: Evidence, params: Topic) -> Finding:
    """The submission publishes no other message type on the topic."""
    expected = f"Only {params.type} messages are published on {params.topic}."
    found = activity.endpoints(evidence.recording, "publisher")
    types = {publisher.type for publisher in found if publisher.topic == params.topic}
    types |= {message.type for message in evidence.recording.messages if message.topic == params.topic}
    others = sorted(types - {params.type})
    where = _publisher_line(evidence, params.topic)
    listed = _types(others)
    if others and params.type in types:
        observed = f"{params.topic} also has {listed}."
        cause = "All publishers of a topic must use the same type. Use another topic name for the other type."
        return failed(observed, expected, Cause("second-type", cause, where))
    if others:
        cause = "The message type is the first argument of create_publisher."
        return failed(f"{params.topic} has {listed}.", expected, Cause("wrong-type", cause, where))
    return passed(expected)


def subscribes(evidence: Evidence, params: Topic) -> Finding:
    """The submission subscribes to the topic with the right message type."""
    found = activity.endpoints(evidence.recording, "subscription")
    expected = f"The node subscribes to {params.topic} with the type {params.type}."
    where = evidence.place("create_subscription")
    if any((each.topic, each.type) == (params.topic, params.type) for each in found):
        return passed(expected)
    on_topic = [each.type for each in found if each.topic == params.topic]
    if on_topic:
        observed = (
            f"The node subscribes to {params.topic} with the type {shorten(on_topic[0])}, so no message reaches it."
        )
        cause = "The message type is the first argument of create_subscription."
        return failed(observed, expected, Cause("wrong-type", cause, where))
    if found:
        topics = sorted({each.topic for each in found if each.type == params.type} or {each.topic for each in found})
        guess = nearest(params.topic, topics)
        shown = topics if guess is None else [guess]
        observed = f"The node subscribes to {a_list([shorten(topic) for topic in shown])}, but not to {params.topic}."
        why = why_topic(params.topic, shown[0], evidence, "create_subscription")
        return failed(observed, expected, why.at(where))
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    cause = "" if evidence.code.calls("create_subscription") else "create_subscription is never called."
    if once := evidence.code.calls("wait_for_message"):
        cause = "wait_for_message listens only while it waits, and it blocks the node. Use create_subscription."
        where = once[0].where
    return failed("The node has no subscription.", expected, Cause("no-subscription", cause, where))


PUBLISHES = Kind(
    "publishes",
    "trial",
    "Messages arrive on the topic",
    Topic,
    publishes,
    about="Messages of the given type arrive on the given topic.",
)
ONLY_TYPE = Kind(
    "topic_type",
    "trial",
    "The topic has one message type",
    Topic,
    only_type,
    about="The student's node publishes only the given type on the topic.",
)
SUBSCRIBES = Kind(
    "subscribes",
    "trial",
    "The node subscribes to the topic",
    Topic,
    subscribes,
    about="The student's node has a subscription of the given type on the topic.",
)
