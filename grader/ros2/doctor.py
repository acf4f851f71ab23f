"""`ros2 doctor` and `ros2 wtf`: check for problems that prevent communication, or print reports about the machine."""

from __future__ import annotations

import os
import platform
import socket
import sys
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterator

    from rclpy.node import Node

_SKIPPED = ("/parameter_events", "/rosout")
_NOT_HERE = "not compared; the versions of the course's packages are in requirements.lock"


@dataclass
class Examination:
    """The results of all checks in one category."""

    category: str
    errors: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    group = parser.add_mutually_exclusive_group()
    group.add_argument("--report", "-r", action="store_true", help="print all reports instead of running the checks")
    group.add_argument("--report-failed", "-rf", action="store_true", help="also print the reports about failed checks")
    parser.add_argument("--exclude-packages", "-ep", action="store_true", help="exclude the report about packages")
    parser.add_argument(
        "--include-warnings",
        "-iw",
        action="store_true",
        help="count a warning as a failure",
    )


def run(args: argparse.Namespace) -> int:
    """Print the results of the checks, the reports, or both."""
    from grader.graph.discovery import cli_node, settle

    reports = {name: made for name, made in _REPORTS.items() if made[0] != "package" or not args.exclude_packages}
    with cli_node() as node:
        settle(node)
        if args.report:
            _print_reports(node, reports)
            return 0
        failed = set()
        found = [check(node) for check in _CHECKS]
        for examination in found:
            for text in examination.warnings:
                print(f"UserWarning: {text}", file=sys.stderr)
            for text in examination.errors:
                print(f"UserWarning: ERROR: {text}", file=sys.stderr)
            if examination.errors or (args.include_warnings and examination.warnings):
                failed.add(examination.category)
        if not failed:
            print(f"\nAll {len(found)} checks passed\n")
            return 0
        print(f"\n{len(failed)}/{len(found)} check(s) failed\n")
        print("Failed modules:", *sorted(failed))
        if args.report_failed:
            _print_reports(node, {name: report for name, report in reports.items() if report[0] in failed})
    return 0


def _topics(node: Node) -> list[str]:
    return sorted(name for name, _ in node.get_topic_names_and_types())


def _check_topics(node: Node) -> Examination:
    found = Examination("topic")
    for topic in _topics(node):
        publishers, subscriptions = node.count_publishers(topic), node.count_subscribers(topic)
        if topic in _SKIPPED:
            continue
        if publishers and not subscriptions:
            found.warnings.append(f"Publisher without subscriber detected on {topic}.")
        if subscriptions and not publishers:
            found.warnings.append(f"Subscriber without publisher detected on {topic}.")
    return found


def _pairs(node: Node) -> Iterator[tuple[str, Any, Any, Any, str]]:
    """Yield each publisher with each subscription of its topic: (topic, publisher, subscription, result, reason).

    The result is the QoS compatibility of the two. The reason is empty if they are certainly compatible.
    """
    from rclpy.qos import qos_check_compatible

    for topic in _topics(node):
        for publisher in node.get_publishers_info_by_topic(topic):
            for subscription in node.get_subscriptions_info_by_topic(topic):
                fits, reason = qos_check_compatible(publisher.qos_profile, subscription.qos_profile)
                yield topic, publisher, subscription, fits, reason


def _check_qos(node: Node) -> Examination:
    from rclpy.qos import QoSCompatibility

    found = Examination("middleware")
    for topic, _, _, fits, reason in _pairs(node):
        reported = reason.partition(": ")[2] or reason
        if fits == QoSCompatibility.WARNING:
            found.warnings.append(f"QoS compatibility warning found on topic '{topic}': {reported}")
        elif fits == QoSCompatibility.ERROR:
            found.errors.append(f"QoS compatibility error found on topic '{topic}': {reported}")
    return found


def _check_network(_: Node) -> Examination:
    found = Examination("network")
    if not any(name == "lo" for _, name in socket.if_nameindex()):
        found.errors.append("No loopback IP address is found.")
    if len(socket.if_nameindex()) < 2:
        found.warnings.append("Only loopback IP address is found.")
    return found


def _check_platform(_: Node) -> Examination:
    found = Examination("platform")
    if not os.environ.get("ROS_DISTRO"):
        found.errors.append("ROS_DISTRO is not set.")
    return found


def _network(_: Node) -> Iterator[tuple[str, object]]:
    for number, name in socket.if_nameindex():
        yield "device", name
        yield "index", number


def _platform(_: Node) -> Iterator[tuple[str, object]]:
    yield "system", platform.system()
    yield "platform info", platform.platform()
    yield "release", platform.release()
    yield "processor", platform.processor() or platform.machine()


def _ros(_: Node) -> Iterator[tuple[str, object]]:
    yield "distribution name", os.environ.get("ROS_DISTRO", "unknown")
    yield "distribution type", "ros2"
    yield "time", time.strftime("%Y-%m-%d %H:%M:%S")
    yield "domain", os.environ.get("ROS_DOMAIN_ID") or "0"


def _middleware(_: Node) -> Iterator[tuple[str, object]]:
    from rclpy.utilities import get_rmw_implementation_identifier

    yield "middleware name", get_rmw_implementation_identifier()


def _packages(_: Node) -> Iterator[tuple[str, object]]:
    yield "versions", _NOT_HERE


def _qos(node: Node) -> Iterator[tuple[str, object]]:
    from rclpy.qos import QoSCompatibility

    empty = True
    for topic, publisher, subscription, fits, reason in _pairs(node):
        empty = False
        yield "topic [type]", f"{topic} [{publisher.topic_type}]"
        yield "publisher node", publisher.node_name
        yield "subscriber node", subscription.node_name
        yield "compatibility status", "OK" if fits == QoSCompatibility.OK else reason
    if empty:
        yield "compatibility status", "No publisher/subscriber pairs found"


def _topic_list(node: Node) -> Iterator[tuple[str, object]]:
    shown = [topic for topic in _topics(node) if topic not in _SKIPPED]
    for topic in shown or ["none"]:
        yield "topic", topic
        yield "publisher count", node.count_publishers(topic) if shown else 0
        yield "subscriber count", node.count_subscribers(topic) if shown else 0


_CHECKS: tuple[Callable[[Node], Examination], ...] = (_check_platform, _check_network, _check_qos, _check_topics)
_REPORTS: dict[str, tuple[str, Callable[[Node], Iterator[tuple[str, object]]]]] = {
    "NETWORK CONFIGURATION": ("network", _network),
    "PACKAGE VERSIONS": ("package", _packages),
    "PLATFORM INFORMATION": ("platform", _platform),
    "QOS COMPATIBILITY LIST": ("middleware", _qos),
    "RMW MIDDLEWARE": ("middleware", _middleware),
    "ROS 2 INFORMATION": ("platform", _ros),
    "TOPIC LIST": ("topic", _topic_list),
}
"""The title of each report, its category, and the function that generates its lines."""


def _print_reports(node: Node, reports: dict[str, tuple[str, Callable[[Node], Iterator[tuple[str, object]]]]]) -> None:
    for title, (_, make) in reports.items():
        print("\n  ", title)
        lines = list(make(node))
        longest = max(len(name) for name, _ in lines)
        padding = longest + 4 if longest >= 8 else 8
        for name, value in lines:
            print(f"{name:{padding}}: {value}")
