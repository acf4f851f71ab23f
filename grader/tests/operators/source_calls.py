"""Mistakes in calls: arguments, parentheses, missing calls."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.tests.operators.operator import Change, Operator, Package, edited, line_at, remove_line, replace

if TYPE_CHECKING:
    from random import Random

    from grader.checks.diagnosis import Diagnosis
    from grader.tests.operators.operator import Replacement

PUBLISHER = r"create_publisher\((?P<type>\w+), (?P<topic>[^,\n]+), (?P<queue>\d+)\)"
SUBSCRIPTION = r"create_subscription\((?P<type>\w+), (?P<topic>[^,\n]+), (?P<callback>[\w.]+), (?P<queue>\d+)\)"
TIMER = r"create_timer\((?P<period>[^,\n]+), (?P<callback>[\w.]+)\)"


def _source(name: str, pattern: str, by: Replacement, *says: Diagnosis, never: str = "") -> Operator:
    return Operator(name, replace(pattern, by), frozenset(says), never)


def _removes(name: str, pattern: str, *says: Diagnosis, never: str = "") -> Operator:
    return Operator(name, remove_line(pattern), frozenset(says), never)


def _super_init_last(package: Package, draw: Random) -> Change | None:
    """Swap super().__init__ with the line after it."""
    return replace(r"^( +super\(\)\.__init__\(.*\))\n( +(?!self\.\w+ = (?:None|[\d.]+|\"\w*\")$)self\..*)$", r"\2\n\1")(
        package, draw
    )


def _spin_before_node(package: Package, draw: Random) -> Change | None:
    text = package.files[package.source]
    change = replace(r"^    node = (\w+)\(\)\n", "")(package, draw)
    if change is None or "    try:\n        rclpy.spin(node)" not in text:
        return None
    new = change.files[package.source].replace("rclpy.spin(node)", "rclpy.spin(node)\n        node = None", 1)
    return edited(package, package.source, new, line_at(new, new.index("rclpy.spin(node)")))


OPERATORS = (
    _source("publisher-swapped", PUBLISHER, r"create_publisher(\g<topic>, \g<type>, \g<queue>)", "arguments-swapped"),
    _source("publisher-without-queue", PUBLISHER, r"create_publisher(\g<type>, \g<topic>)", "argument-missing"),
    _source("publisher-without-type", PUBLISHER, r"create_publisher(\g<topic>, \g<queue>)", "argument-missing"),
    _source("publisher-queue-a-string", PUBLISHER, r'create_publisher(\g<type>, \g<topic>, "\g<queue>")', "queue-size"),
    _source(
        "publisher-made-object", PUBLISHER, r"create_publisher(\g<type>(), \g<topic>, \g<queue>)", "object-for-class"
    ),
    _source(
        "subscription-swapped",
        SUBSCRIPTION,
        r"create_subscription(\g<type>, \g<callback>, \g<topic>, \g<queue>)",
        "arguments-swapped",
    ),
    _source(
        "subscription-without-queue",
        SUBSCRIPTION,
        r"create_subscription(\g<type>, \g<topic>, \g<callback>)",
        "argument-missing",
    ),
    _source(
        "subscription-without-callback",
        SUBSCRIPTION,
        r"create_subscription(\g<type>, \g<topic>, \g<queue>)",
        "argument-missing",
    ),
    _source(
        "subscription-called",
        SUBSCRIPTION,
        r"create_subscription(\g<type>, \g<topic>, \g<callback>(), \g<queue>)",
        "callback-called",
    ),
    _source("timer-swapped", TIMER, r"create_timer(\g<callback>, \g<period>)", "arguments-swapped"),
    _source("timer-without-callback", TIMER, r"create_timer(\g<period>)", "argument-missing"),
    _source("timer-without-period", TIMER, r"create_timer(\g<callback>)", "argument-missing"),
    _source("timer-called", TIMER, r"create_timer(\g<period>, \g<callback>())", "callback-called"),
    _source(
        "timer-period-a-string",
        TIMER,
        r'create_timer("\g<period>", \g<callback>)',
        "string-for-number",
        "field-type",
        "crash",
    ),
    _source("message-a-class", r"= (Twist|String)\(\)", r"= \1", "class-for-object"),
    _source("node-a-class", r"^( +node) = (\w+)\(\)$", r"\1 = \2", "class-for-object"),
    _source("spin-without-node", r"rclpy\.spin\(node\)", "rclpy.spin()", "argument-missing"),
    _source("spin-of-class", r"^( +)rclpy\.spin\(node\)", r"\1rclpy.spin(Node)", "class-for-object", "name-misspelt"),
    _source("spin-named-only", r"rclpy\.spin\(node\)", "rclpy.spin", "not-called"),
    _source("init-named-only", r"rclpy\.init\(.*\)", "rclpy.init", "not-called"),
    _source("spin-once", r"rclpy\.spin\(", "rclpy.spin_once(", "spin-once"),
    _source("logger-named-only", r"get_logger\(\)\.info", "get_logger.info", "not-called"),
    _source("logger-like-print", r"\.info\((f?\"[^\"]*\")\)", r'.info("now", \1)', "log-arguments"),
    _source("print-for-log", r"self\.get_logger\(\)\.info\(", "print(", "print-instead"),
    _source("publish-a-class", r"\.publish\((\w+)\)$", ".publish(Twist)", "class-for-object"),
    _source("publish-a-string", r"\.publish\((\w+)\)$", '.publish("forward")', "publish-other"),
    _source("publish-without-message", r"\.publish\((\w+)\)$", ".publish()", "argument-missing"),
    _source("publish-linear", r"\.publish\((\w+)\)$", r".publish(\1.linear)", "publish-other"),
    _source("publish-on-node", r"self\.\w+\.publish\(", "self.publish(", "node-publishes"),
    _source("twist-with-arguments", r"= Twist\(\)", "= Twist(2.0, 1.0)", "message-arguments"),
    _source("super-without-name", r"super\(\)\.__init__\(.+\)", "super().__init__()", "node-name-missing"),
    _source(
        "super-without-parentheses", r"super\(\)\.__init__\(", "super.__init__(", "not-called", "super-init-missing"
    ),
    _source("init-misspelt", r"def __init__\(self", "def _init_(self", "init-misspelt", "node-name-missing"),
    _source("node-name-with-space", r"(super\(\)\.__init__\([\"'])\w+", r"\1my node", "node-name-invalid"),
    _source("node-name-other", r"(super\(\)\.__init__\([\"'])\w+", r"\1my_node", "node-name"),
    _source("topic-with-space", r"[\"']/turtle1/\w+[\"']", '"/turtle1/cmd vel"', "topic-name-invalid"),
    _source("init-twice", r"^( +)(rclpy\.init\(.*\))$", r"\1\2; \2", "init-twice"),
    _source("asks-for-a-number", r"^( +)node = ", r'\1input("Speed? ")' + "; node = ", "needs-stdin"),
    _source("divides-by-zero", r"^( +)(self\.\w+)\.publish\(", r"\1rate = 1.0 / 0" + "\n" + r"\1\2.publish(", "crash"),
    Operator("super-init-last", _super_init_last, frozenset({"super-init-late"})),
    Operator("spin-before-node", _spin_before_node, frozenset({"name-too-early"})),
    _removes("super-init-left-out", r"super\(\)\.__init__\(", "super-init-missing"),
    _removes("init-left-out", r"^ +rclpy\.init\(", "no-init"),
    _removes("spin-left-out", r"rclpy\.spin\(", "no-spin"),
    _removes("publish-left-out", r"\.publish\(", "no-publish"),
    _removes("timer-left-out", r"create_timer\(", "method-never-called", "never-publishes"),
    _removes("subscription-left-out", r"create_subscription\(", "no-subscription", "method-never-called"),
    _removes("publisher-left-out", r"self\.\w+ = self\.create_publisher\(", "attribute-missing"),
    _removes("log-left-out", r"\.info\(f", "no-log"),
    _removes("node-left-out", r"^ +node = \w+\(\)$", "node-not-made", "name-undefined", "local-name"),
)
