"""The reasons why a program exited on its own, or ran without a node."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_ended import named_only, why_ended, why_no_node
from grader.evidence.activity import START_S
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission
from grader.trial.recording import ProcessEnd

SOURCE = """\
import rclpy
from rclpy.node import Node

class Driver(Node):
    pass

def main():
    rclpy.init()
    {body}
"""


def ended(source: str, t_s: float = 3.0) -> tuple[str, str, int | None]:
    end = ProcessEnd(by="itself", exit_code=0, t_s=t_s, stop_s=None)
    cause = why_ended(evidence(recording([], end=end), submission({NODE_FILE: source})))
    return cause.diagnosis, cause.text, None if cause.where is None else cause.where.line


@pytest.mark.parametrize(
    ("body", "diagnosis", "words"),
    [
        ("rclpy.spin  # look", "not-called", "This line mentions rclpy.spin but does not call it"),
        ("return  # look\n    rclpy.spin(Driver())", "ends-at-once", "main returns here, before it spins the node."),
        (
            "pass\n\nif __name__ == '__main__':  # look\n    rclpy.spin(Driver())",
            "ends-at-once",
            "The node is spun only in this block, which does not run",
        ),
        (
            "rclpy.spin(Driver())  # look\n\nif __name__ == '__main__':\n    main(); rclpy.spin(Driver())",
            "ended-early",
            "",
        ),
        ("node = Driver()", "no-spin", "rclpy.spin keeps a node running, but it is never called."),
        (
            "Thread(target=rclpy.spin, args=(Driver(),)).start()  # look",
            "ends-at-once",
            "rclpy.spin runs in this thread. The main thread does not wait for it",
        ),
        (
            "thread = Thread(target=rclpy.spin); thread.join()",
            "no-spin",
            "rclpy.spin keeps a node running, but it is never called.",
        ),
        (
            "rclpy.spin_until_future_complete(Driver(), done, timeout_sec=3.0)  # look",
            "ended-early",
            "With timeout_sec, spin_until_future_complete returns after this time at the latest. rclpy.spin runs",
        ),
        ("rclpy.spin_until_future_complete(Driver(), done)", "ended-early", ""),
        ("rclpy.spin_once(Driver())  # look", "spin-once", "rclpy.spin_once handles one event"),
        ("while True: rclpy.spin_once(Driver())", "ended-early", ""),
        ("for _ in range(3): rclpy.spin_once(Driver())", "ended-early", ""),
        ("rclpy.spin_once(node); rclpy.spin(Driver())  # look", "ended-early", ""),
        ("rclpy.spin(Driver())  # look", "ended-early", ""),
        ("count = 3; rclpy.spin(Driver())  # look", "ended-early", ""),
    ],
)
def test_an_end_before_ctrl_c_is_explained_by_the_source(body: str, diagnosis: str, words: str) -> None:
    source = SOURCE.format(body=body)
    assert ended(source)[::2] == (diagnosis, line_with(LOOK, source) or 8)
    assert ended(source)[1].startswith(words)


def test_an_end_at_the_start_is_reported_as_such() -> None:
    source = SOURCE.format(body="rclpy.spin(Driver())")
    found = [ended(source, t_s)[0] for t_s in (-0.1, 0.0, START_S, START_S + 0.1)]
    assert found == ["ends-at-once", "ends-at-once", "ends-at-once", "ended-early"]


@pytest.mark.parametrize("name", ["rclpy.init", "rclpy.spin", "main"])
def test_a_function_that_is_only_named_is_found(name: str) -> None:
    source = f"import rclpy\nrclpy.spin(node)\n{name}\n"
    assert ended(source)[::2] == ("not-called", 3)


def test_only_the_functions_that_are_requested_are_found() -> None:
    given = evidence(recording([]), submission({NODE_FILE: "import rclpy\nrclpy.ok\nprint(main)\nmain()\n"}))
    assert named_only(given, "rclpy.init", "main") is None


NO_NODE = """\
import rclpy

class Plain:
    pass

{node}
    pass

def main():
    {init}
    {body}
"""


@pytest.mark.parametrize(
    ("node", "init", "body", "diagnosis", "line"),
    [
        ("class Driver(Node):", "rclpy.init", "rclpy.spin(Driver())", "not-called", 10),
        ("class Driver(Node):", "pass", "rclpy.spin(Driver())", "no-init", None),
        ("class Driver(Node):", "rclpy.init()", "rclpy.spin(node)", "node-not-made", 6),
        ("class Driver(rclpy.node.Node):", "rclpy.init()", "rclpy.spin(node)", "node-not-made", 6),
        ("class Driver(Base()):", "rclpy.init()", "rclpy.spin(node)", "no-node", 10),
        ("class Driver(Node):", "rclpy.init()", "node = Driver", "node-not-made", 11),
        ("class Driver(Node):", "rclpy.init()", "kind = Driver; rclpy.spin(kind())", "no-node", 10),
        ("class Driver(Node):", "rclpy.init()", "rclpy.spin(Driver())", "no-node", 10),
        ("def drive():", "rclpy.init()", "rclpy.spin(node)", "no-node", 10),
    ],
)
def test_a_program_without_a_node_is_explained_by_the_source(
    node: str, init: str, body: str, diagnosis: str, line: int | None
) -> None:
    source = NO_NODE.format(node=node, init=init, body=body)
    cause = why_no_node(evidence(recording([]), submission({NODE_FILE: source})))
    assert (cause.diagnosis, cause.where and cause.where.line) == (diagnosis, line)
    assert cause.where is not None
    assert cause.where.file == NODE_FILE
    words = "The class Driver is defined but never called. Call the class to create the node."
    stored = "This line stores the class Driver, not an object. Add parentheses after the class name"
    assert (cause.text == words) == (diagnosis == "node-not-made" and body != "node = Driver")
    assert cause.text.startswith(stored) == (body == "node = Driver")


SENDS = """\
class Driver(Node):
    def send(self):
        {line}  # look

rclpy.spin(Driver())
"""


@pytest.mark.parametrize(
    ("line", "told"), [("rclpy.shutdown()", True), ("rclpy.try_shutdown()", True), ("rclpy.ok()", False)]
)
def test_a_method_that_shuts_ros_down_may_end_the_program(line: str, *, told: bool) -> None:
    diagnosis, text, where = ended(SENDS.format(line=line))
    assert (diagnosis, text == "This line may end the program.", where == 3) == ("ended-early", told, told)
