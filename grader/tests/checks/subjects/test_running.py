"""The checks of a node's start, name, topic, message type and end."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.causes.crash import START, end_observed
from grader.checks.outcome import Status
from grader.tests.checks.made import (
    BUILD,
    NODE_FILE,
    TOPIC,
    evidence,
    finding,
    good,
    graph,
    node,
    recording,
    submission,
)
from grader.tests.checks.shapes import SHAPES, TRACEBACK, crashed
from grader.tests.checks.told import told
from grader.trial.recording import Endpoint, Message, Output, ProcessEnd

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.trial.recording import ClockName, Recording

OTHER = "geometry_msgs/msg/TwistStamped"


def of(shape: str, *changes: tuple[str, str]) -> Evidence:
    return evidence(SHAPES[shape](), node(*changes))


def test_an_executable_that_is_not_installed_does_not_crash() -> None:
    """An exercise may have no check of the entry point."""
    found = finding(
        "start", evidence(SHAPES["crash at the start"](), build=replace(BUILD, executables=(), entry_points={}))
    )
    assert found.observed == "The package has no executable draw_circle."


@pytest.mark.parametrize("check", ["start", "node-name", "topic", "type", "stop", "timer"])
def test_a_good_run_passes(check: str) -> None:
    found = finding(check, of("good"))
    assert (found.status, found.near_edge) == (Status.PASSED, False)


@pytest.mark.parametrize(
    ("check", "shape", "diagnosis", "line"),
    [
        ("start", "crash at the start", "crash", ":14"),
        ("start", "ends at once", "ends-at-once", ":21"),
        ("start", "no node", "no-node", ":20"),
        ("node-name", "other name", "node-name", ":8"),
        ("node-name", "no node", "no-node", None),
        ("topic", "other topic", "wrong-topic", ":9"),
        ("topic", "other type", "wrong-type", ":9"),
        ("topic", "no messages", "never-publishes", ":16"),
        ("topic", "no publisher", "no-publisher", ":9"),
        ("type", "other type", "wrong-type", ":9"),
        ("stop", "ignores Ctrl-C", "ignores-ctrl-c", ":21"),
        ("stop", "slow stop", "slow-stop", ":21"),
        ("stop", "ends early", "ended-early", ":21"),
        ("stop", "crash", "crash", ":14"),
    ],
)
def test_each_fault_has_its_diagnosis_and_place(check: str, shape: str, diagnosis: str, line: str | None) -> None:
    found = finding(check, of(shape))
    assert (found.status, found.diagnosis) == (Status.FAILED, diagnosis)
    assert (None if found.where is None else str(found.where)) == (None if line is None else NODE_FILE + line)


@pytest.mark.parametrize("giver", ["super().__init__", "create_node"])
def test_the_name_of_a_node_is_where_the_node_is_created(giver: str) -> None:
    made = of("other name", ("super().__init__(", f"self.made = {giver.replace('create', 'rclpy.create')}("))
    assert finding("node-name", made).cause == f"The node name is the first argument of {giver}."


def test_a_crash_is_reported_with_its_meaning() -> None:
    found = finding("start", of("crash at the start"))
    assert found.observed == "draw_circle crashed at startup: ZeroDivisionError: division by zero."
    assert found.cause == "A number was divided by zero."


def test_a_program_that_crashed_while_its_node_was_waited_for_is_reported_to_have_made_none() -> None:
    late = replace(SHAPES["crash at the start"](), end=crashed(5.0), graphs=(graph((), topic=None),))
    found = finding("start", evidence(late))
    assert found.diagnosis == "crash"
    assert (
        found.observed
        == "draw_circle crashed before a node appeared in the ROS graph: ZeroDivisionError: division by zero."
    )


def test_a_node_that_crashed_while_it_ran_did_start() -> None:
    assert finding("start", of("crash")).status is Status.PASSED


@pytest.mark.parametrize(
    ("clock", "t_s", "diagnosis"),
    [
        ("wall", 0.2, "ends-at-once"),
        ("wall", 0.21, None),
        ("simulated", 0.2, "ends-at-once"),
        ("simulated", 0.21, None),
    ],
)
def test_by_either_clock_an_end_in_the_first_moment_is_one_at_the_start(
    clock: ClockName, t_s: float, diagnosis: str | None
) -> None:
    """In wall time, the clock starts when the node appears in the graph.

    When the clock starts, parts of the node may still be missing.
    """
    end = ProcessEnd(by="itself", exit_code=0, t_s=t_s, stop_s=None)
    observed = evidence(recording([], clock=clock, end=end))
    assert finding("start", observed).diagnosis == diagnosis
    assert end_observed(observed).endswith("at startup." if diagnosis else f"after {t_s:.1f} s.")


@pytest.mark.parametrize("clock", ["wall", "simulated"])
@pytest.mark.parametrize(("frame", "starts"), [("await_or_execute", True), ("handler", True), ("spin_once", False)])
def test_a_node_that_crashes_in_its_first_callback_has_started(clock: ClockName, frame: str, *, starts: bool) -> None:
    """The node counts as started even if it exits very early.

    If rclpy.spin gets a class instead of a node, no callback is called, and the node does not count as started.
    """
    text = f'{START}\n  File "/ros/rclpy/executors.py", line 838, in {frame}\n    x\nValueError: x\n'
    end = ProcessEnd(by="itself", exit_code=1, t_s=0.0, stop_s=None)
    crashed_early = evidence(recording([], clock=clock, end=end, stderr=Output(text)))
    assert (finding("start", crashed_early).status is Status.PASSED) == starts


def test_a_missing_spin_is_reported_where_the_node_ends_at_once() -> None:
    found = finding("start", of("ends at once", ("rclpy.spin(DrawCircleNode())", "DrawCircleNode()")))
    assert found.cause == "rclpy.spin keeps a node running, but it is never called."


@pytest.mark.parametrize(
    ("names", "observed"),
    [
        (("/draw_cirle",), "The node is named /draw_cirle."),
        (("/a", "/b"), "The nodes are named /a and /b."),
        (("/robot/draw_circle",), "The node is named /robot/draw_circle."),
    ],
)
def test_another_name_is_shown(names: tuple[str, ...], observed: str) -> None:
    found = finding("node-name", evidence(recording([], graphs=(graph(names),))))
    assert found.observed == observed


def test_a_namespace_is_reported_as_such() -> None:
    found = finding("node-name", evidence(recording([], graphs=(graph(("/robot/draw_circle",)),))))
    assert (found.diagnosis, str(found.where)) == ("node-namespace", f"{NODE_FILE}:8")


def test_a_node_that_took_the_simulators_name_is_the_submissions() -> None:
    found = finding("node-name", evidence(recording([], graphs=(graph(("/turtlesim",)),))))
    assert found.observed == "The node is named /turtlesim."


def test_a_node_observed_once_counts() -> None:
    observed = recording([], graphs=(graph((), topic=None), graph(), graph((), topic=None)))
    assert finding("start", evidence(observed)).status is Status.PASSED


def test_the_topic_in_use_is_named() -> None:
    assert finding("topic", of("other topic")).observed.startswith("The node publishes on /turtle1/cmd_val,")


@pytest.mark.parametrize(
    ("changes", "diagnosis", "line"),
    [
        ([("self.publisher.publish(msg)", "pass")], "no-publish", ""),
        ([("create_timer(0.5,", "create_timer(500,")], "timer-milliseconds", ":10"),
        ([("self.send)", "self.send())")], "callback-called", ":10"),
        ([("rclpy.spin(", "print(")], "no-spin", ""),
    ],
)
def test_silence_is_explained_by_the_source(changes: list[tuple[str, str]], diagnosis: str, line: str) -> None:
    found = finding("topic", of("no messages", *changes))
    assert (found.diagnosis, str(found.where)) == (diagnosis, NODE_FILE + line)


def test_silence_after_a_crash_is_the_crash() -> None:
    silent = replace(SHAPES["crash"](), commands=())
    found = finding("topic", evidence(silent))
    assert (found.diagnosis, str(found.where)) == ("crash", f"{NODE_FILE}:14")


def test_a_subscription_in_place_of_a_publisher_is_reported() -> None:
    listening = Endpoint("subscription", "/draw_circle", TOPIC, "geometry_msgs/msg/Twist")
    observed = graph(topic=None)
    found = finding(
        "topic", evidence(recording([], graphs=(replace(observed, endpoints=(*observed.endpoints, listening)),)))
    )
    assert (found.diagnosis, str(found.where)) == ("subscription-instead", NODE_FILE)


def test_a_second_type_beside_twist_fails_the_type_alone() -> None:
    both = graph()
    second = Endpoint("publisher", "/draw_circle", TOPIC, OTHER)
    given = evidence(replace(good(), graphs=(replace(both, endpoints=(*both.endpoints, second)),)))
    assert finding("topic", given).status is Status.PASSED
    assert finding("type", given).diagnosis == "second-type"


def test_a_second_type_that_the_graph_missed_is_observed_by_its_messages() -> None:
    made = good()
    stray = Message(TOPIC, OTHER, b"", 3.0, 3.0)
    assert finding("type", evidence(replace(made, messages=(*made.messages, stray)))).diagnosis == "second-type"


def test_messages_forged_for_the_recorder_are_not_commands() -> None:
    forged = replace(good(), commands=())
    assert finding("topic", evidence(forged)).status is Status.FAILED


def test_a_missing_spin_is_reported_where_the_node_ends_early() -> None:
    without = finding("stop", of("ends early", ("rclpy.spin(DrawCircleNode())", "DrawCircleNode()")))
    assert without.cause == "rclpy.spin keeps a node running, but it is never called."
    assert finding("stop", of("ends early")).cause == ""


def test_a_signal_is_named() -> None:
    end = replace(crashed(3.0), exit_code=-11)
    assert "SIGSEGV" in finding("stop", evidence(recording([], end=end))).observed


def test_no_timer_is_advice() -> None:
    found = finding("timer", evidence(good(), node(("self.create_timer(0.5, self.send)", "None"))))
    assert found.diagnosis == "no-timer"


@pytest.mark.parametrize(
    ("loop", "advised"),
    [
        ("while rclpy.ok():\n        time.sleep(0.5)\n        node.publisher.publish(msg)", True),
        ("while True:\n        rate.sleep()\n        node.publisher.publish(msg)", True),
        ("while not node.ready:\n        time.sleep(0.5)\n        node.get_logger().info('waiting')", False),
        ("while rclpy.ok():\n        time.sleep(0.5)", False),
    ],
)
def test_a_timer_beside_a_loop_that_sends_gives_no_rhythm(loop: str, *, advised: bool) -> None:
    changed = node(("    rclpy.spin(DrawCircleNode())", f"    node = DrawCircleNode()\n    {loop}"))
    assert (finding("timer", evidence(good(), changed)).diagnosis == "no-timer") == advised


def test_what_setup_py_and_tests_call_is_not_the_nodes() -> None:
    files = {NODE_FILE: "pass\n", "test/test_node.py": "node.create_timer(1, f)\n"}
    assert finding("timer", evidence(good(), submission(files))).diagnosis == "no-timer"


SILENT = SHAPES["no node"]()
LATER = replace(SILENT, end=crashed(4.5), stderr=Output(TRACEBACK.partition('  File "/opt')[0] + "ValueError: no\n"))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("draw_circle ran, but no node appeared in the ROS graph.", SILENT, good()),
        ("The program creates a node and spins it.", SILENT, good()),
        ("draw_circle crashed before a node appeared in the ROS graph: ValueError: no.", LATER, SILENT),
    ],
)
def test_a_sentence_about_the_start_is_true(words: str, true: Recording, near: Recording) -> None:
    assert words in told(finding("start", evidence(true)))
    assert words not in told(finding("start", evidence(near)))


@pytest.mark.parametrize(("trial", "found"), [(SILENT, True), (SHAPES["other name"](), False)])
def test_a_node_that_did_not_appear_has_no_name(trial: Recording, *, found: bool) -> None:
    assert ("No node appeared in the ROS graph." in told(finding("node-name", evidence(trial)))) == found


@pytest.mark.parametrize(
    ("source", "status", "observed"),
    [
        ('super().__init__("draw_circle")', Status.PASSED, "The node is named draw_circle."),
        ('super().__init__("circle")', Status.FAILED, "The node is named /circle."),
        ("super().__init__(read_name())", Status.SKIPPED, "the node crashed before it appeared in the ROS graph"),
    ],
)
def test_the_source_names_a_node_that_crashed_before_other_nodes_discovered_it(
    source: str, status: Status, observed: str
) -> None:
    text = f'{START}\n  File "/ros/rclpy/executors.py", line 838, in _execute_timer\n    x\nValueError: x\n'
    trial = recording([], end=crashed(0.1), graphs=(), stderr=Output(text))
    found = finding("node-name", evidence(trial, node(('super().__init__("draw_circle")', source))))
    assert found.status is status
    assert observed in told(found)
    unseen = finding("node-name", evidence(replace(trial, stderr=Output("")), node()))
    assert (unseen.status, "crashed before it appeared" in told(unseen)) == (Status.FAILED, False)
