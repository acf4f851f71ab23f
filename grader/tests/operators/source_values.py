"""Mistakes in topics, values, periods and log lines: the node runs, but its behaviour is wrong."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.tests.operators.operator import Operator, misspelt, remove_line, replace

if TYPE_CHECKING:
    import re
    from random import Random

    from grader.checks.diagnosis import Diagnosis
    from grader.tests.operators.operator import Change, Package, Replacement

NUMBER = r"(?P<number>\d+\.\d+)"
FIELD = rf"(?P<field>\.(?:linear\.x|angular\.z) = ){NUMBER}"
TIMER = r"create_timer\((?P<period>[\d.]+),"
WRONG_VALUE: tuple[Diagnosis, ...] = ("wrong-value", "wrong-radius", "wall")


def _source(name: str, pattern: str, by: Replacement, *says: Diagnosis, never: str = "") -> Operator:
    return Operator(name, replace(pattern, by), frozenset(says), never)


def _topic_misspelt(package: Package, draw: Random) -> Change | None:
    return replace(r"(?<=turtle1/)(cmd_vel|pose)(?=[\"'])", lambda m: misspelt(m[0], draw))(package, draw)


def _times(factor: float) -> Replacement:
    return lambda match: f"{match['field']}{float(match['number']) * factor}"


def _period(factor: float) -> Replacement:
    def by(match: re.Match[str]) -> str:
        return f"create_timer({float(match['period']) * factor:g},"

    return by


OPERATORS = (
    _source(
        "topic-without-turtle", r"[\"']/turtle1/(cmd_vel|pose)[\"']", r'"/\1"', "topic-without-turtle", "wrong-topic"
    ),
    _source("topic-other-turtle", r"/turtle1/", "/turtle2/", "topic-other-turtle", "wrong-topic"),
    _source("topic-capitals", r"/turtle1/cmd_vel", "/turtle1/Cmd_vel", "topic-capitals", "wrong-topic"),
    Operator("topic-misspelt", _topic_misspelt, frozenset({"wrong-topic"})),
    _source(
        "subscription-for-publisher",
        r"create_publisher\((\w+), ([^,\n]+), ",
        r"create_subscription(\1, \2, print, ",
        "subscription-instead",
        "attribute-missing",
    ),
    _source("value-doubled", FIELD, _times(2.0), *WRONG_VALUE),
    _source("value-halved", FIELD, _times(0.5), *WRONG_VALUE),
    _source("value-negative", FIELD, _times(-1.0), "wrong-sign", "wrong-direction"),
    _source(
        "value-in-degrees",
        r"(?P<field>\.angular\.z = )(?P<number>\d+\.\d+)",
        _times(57.29577951308232),
        "degrees",
        "wrong-radius",
    ),
    _source("value-whole", FIELD, lambda m: f"{m['field']}{float(m['number']):.0f}", "int-for-float"),
    _source("value-in-quotes", FIELD, r'\g<field>"\g<number>"', "string-for-number"),
    _source(
        "value-compared",
        r"(\.(?:linear\.x|angular\.z)) = ",
        r"\1 == ",
        "equals",
        "empty-twist",
        "wrong-value",
        "straight-line",
        "turns-on-the-spot",
        "not-moving",
    ),
    _source("value-with-comma", FIELD, lambda m: m["field"] + m["number"].replace(".", ","), "field-type"),
    _source("field-y", r"\.linear\.x = ", ".linear.y = ", "wrong-field", "not-moving", "turns-on-the-spot"),
    _source("field-of-angular", r"\.angular\.z = ", ".angular.x = ", "wrong-field", "straight-line", "wall"),
    _source(
        "fields-swapped",
        r"\.linear\.x = ([\d.]+)\n( +\w+)\.angular\.z = ([\d.]+)",
        r".linear.x = \3\n\2.angular.z = \1",
        "values-swapped",
        "wrong-radius",
    ),
    Operator(
        "field-left-out",
        remove_line(r"^ +\w+\.angular\.z = [\d.]+$"),
        frozenset({"wrong-value", "straight-line", "wall"}),
    ),
    _source("period-doubled", TIMER, _period(2.0), "timer-period"),
    _source("period-halved", TIMER, _period(0.5), "timer-period"),
    _source(
        "rate-for-period",
        TIMER,
        lambda m: f"create_timer({1.0 / float(m['period']):.1f},",
        "rate-for-period",
        "timer-period",
    ),
    _source("period-in-milliseconds", TIMER, _period(1000.0), "timer-milliseconds"),
    _source("period-negative", TIMER, _period(-1.0), "timer-period-negative"),
    _source(
        "two-timers",
        r"^( +)(self\.\w+) = (self\.create_timer\(.*\))$",
        r"\1\2 = \3; \2_b = \3",
        "several-timers",
        "uneven-rate",
    ),
    _source(
        "comma-after-value",
        r"^( +(?:self\.\w+|\w+\.(?:linear|angular)\.\w|msg|node) = [^#\n]*[\w)])$",
        r"\1,",
        "trailing-comma",
    ),
    _source("f-left-out", r"\.info\(f\"", '.info("', "log-numbers"),
    _source("log-small", r"\.info\(f\"Hello ", '.info(f"hello ', "log-capitals"),
    _source("log-colon", r"\.info\(f\"Hello ", '.info(f"Hello: ', "log-format"),
    _source("log-three-digits", r":\.2f\}", ":.3f}", "log-numbers", "log-more", "log-format"),
    _source("counter-not-raised", r"self\.counter \+= 1", "self.counter + 1", "counter-stuck"),
    _source("counter-raised-by-sign", r"self\.counter \+= 1", "self.counter =+ 1", "counter-step", "counter-stuck"),
    _source("counter-from-1", r"self\.counter = 0", "self.counter = 1", "counter-start"),
    _source("counter-local", r"self\.counter \+= 1", "counter += 1", "missing-self"),
    _source("pose-never-kept", r"self\.pose = pose", "pose = pose", "stale-pose", "never-logs", "missing-self"),
    _source(
        "pose-kept-first",
        r"( +)(if self\.pose is not None:\n.*\n) +(self\.pose = pose)$",
        r"\1\3\n\1\2",
        "distance-zero",
    ),
    _source("distance-not-summed", r"self\.distance \+= ", "self.distance = ", "wrong-distance"),
    _source(
        "x-and-y-swapped",
        r"x=\{self\.pose\.x:\.2f\} y=\{self\.pose\.y:\.2f\}",
        "x={self.pose.y:.2f} y={self.pose.x:.2f}",
        "x-y-swapped",
    ),
)
