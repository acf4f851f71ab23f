"""The reasons why a node is blocked or not spun, each with a program that is nearly the same."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_blocked import not_spun, why_blocked
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, submission

NODE = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.pen = self.create_client(SetPen, "/turtle1/set_pen")
        {init}
        self.create_timer(0.1, self.step)

    def step(self):
        {step}


{main}
"""


def blocked(init: str = "pass", step: str = "pass", main: str = "rclpy.spin(Driver())") -> tuple[str, int | None]:
    source = NODE.format(init=init, step=step, main=main)
    cause = why_blocked(evidence(package=submission({NODE_FILE: source})))
    place = None if cause is None or cause.where is None else cause.where.line
    assert place in (None, line_with(LOOK, source))
    return ("", place) if cause is None else (cause.text, place)


IDLE = "This loop is in a callback. While it waits, a node with one thread calls no other callback"
CALL = "call waits for the response, which arrives only while the node is spun. __init__ runs before"


@pytest.mark.parametrize(
    ("init", "step", "main", "words"),
    [
        ("pass", "while self.pose is None: pass  # look", "rclpy.spin(Driver())", IDLE),
        ("pass", "while self.paused: time.sleep(0.1)  # look", "rclpy.spin(Driver())", IDLE),
        ("pass", "while not self.pose: print('waiting'); time.sleep(0.1)  # look", "rclpy.spin(Driver())", IDLE),
        ("pass", "while self.pose is None: self.pose = self.look()", "rclpy.spin(Driver())", ""),
        ("pass", "while self.is_late(): time.sleep(0.1)", "rclpy.spin(Driver())", ""),
        ("pass", "while self.pose is None: pass", "MultiThreadedExecutor().spin()", ""),
        ("self.pen.call(request)  # look", "pass", "rclpy.spin(Driver())", CALL),
        (
            "self.pen.call(request, timeout_sec=1.0)  # look",
            "pass",
            "rclpy.spin(Driver())",
            f"{CALL} rclpy.spin, so no",
        ),
        ("self.pen.call(request, None)  # look", "pass", "rclpy.spin(Driver())", f"{CALL} rclpy.spin, so call never"),
        ("self.pen.call_async(request)", "pass", "rclpy.spin(Driver())", ""),
        ("self.pens.call(request)", "pass", "rclpy.spin(Driver())", ""),
        ("self.pen.call(request)", "pass", "Thread(target=spin).start()", ""),
    ],
)
def test_what_blocks_the_node_is_told(init: str, step: str, main: str, words: str) -> None:
    text, line = blocked(init, step, main)
    assert (text.startswith(words), line is None) == (True, not words)


def unspun(main: str) -> tuple[str, int | None]:
    source = NODE.format(init="pass", step="pass", main=main)
    cause = not_spun(evidence(package=submission({NODE_FILE: source})))
    if cause is None:
        return "", line_with(LOOK, source)
    assert cause.where is not None
    assert cause.where.line == line_with(LOOK, source)
    return cause.text, cause.where.line


EMPTY = "executor has no node, so it calls no callback. add_node adds a node to an executor."
SECOND = "Nothing spins the node {}, so none of its callbacks is called. rclpy.spin spins one node."


@pytest.mark.parametrize(
    ("main", "words"),
    [
        ("executor = SingleThreadedExecutor()\nexecutor.spin()  # look", EMPTY),
        ("executor = MultiThreadedExecutor()\nexecutor.spin()  # look", EMPTY),
        ("executor = MultiThreadedExecutor()\nexecutor.add_node(Driver())\nexecutor.spin()", ""),
        ("executor = MultiThreadedExecutor()\nlist(map(executor.add_node, [Driver()]))\nexecutor.spin()", ""),
        ("executor = MultiThreadedExecutor()\nnode = Driver()\nnode.executor = executor\nexecutor.spin()", ""),
        ("executor = MultiThreadedExecutor()\nrclpy.spin(node, executor)\nexecutor.spin()", ""),
        ("node = Driver()  # look\nmain = rclpy.create_node('main')\nrclpy.spin(main)", SECOND.format("node")),
        (
            "node = Driver()\nmain = rclpy.create_node('main')  # look\nmain.create_timer(1, print)\nrclpy.spin(node)",
            SECOND.format("main"),
        ),
        ("node = Driver()\nmain = rclpy.create_node('main')\nmain.create_publisher(A, 'a', 1)\nrclpy.spin(node)", ""),
        ("class Other(Driver, Node):\n    def run(self): rclpy.spin(self)\nnode = Driver()\nnode.run()", ""),
        ("node = Driver()\nmain = Driver()\nThread(target=rclpy.spin, args=(node,)).start()\nrclpy.spin(main)", ""),
        ("node = Driver()\nmain = Driver()\nexecutor.add_node(main)\nnode.executor = executor", ""),
        ("node = Driver()\nmain = rclpy.create_node('main')\nrclpy.spin_once(main)\nrclpy.spin(node)", ""),
        ("node = Driver()\nmain = rclpy.create_node('main')\nfor each in (node, main): add_node(each)", ""),
        ("node = Driver()\nrclpy.spin(node)", ""),
        ("rclpy.spin(Driver())", ""),
    ],
)
def test_a_node_that_nothing_spins_is_told(main: str, words: str) -> None:
    assert unspun(main)[0] == words
