"""The reasons why a node keeps running after Ctrl-C."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_ignored import why_ignored
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission

MAIN = "import rclpy\n\n\ndef main():\n    rclpy.init()\n{body}\n"
LOOP = "    while True:\n        try:\n            rclpy.spin(node)\n        except {caught}:{look}\n            {then}"
CALL = """\
    rclpy.spin(node)


class Asker(Node):
    def __init__(self):
        self.client = self.create_client(Empty, "/clear")
        self.create_timer(1.0, self.ask)

    def ask(self):
        {asks}
"""


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (
            "    signal.signal(signal.SIGINT, signal.SIG_IGN)  # look\n    rclpy.spin(node)",
            "the program ignores SIGINT",
        ),
        ("    signal.signal(signal.SIGTERM, signal.SIG_IGN)\n    rclpy.spin(node)  # look", ""),
        (LOOP.format(caught="BaseException", look="  # look", then="pass"), "then the loop on line 6 continues."),
        (
            LOOP.format(caught="(KeyboardInterrupt, OSError)", look="  # look", then="pass"),
            "This except clause catches Ctrl-C",
        ),
        (
            LOOP.format(caught="KeyboardInterrupt", look="", then="break").replace("spin(node)", "spin(node)  # look"),
            "",
        ),
        (LOOP.format(caught="OSError", look="", then="pass").replace("True:", "True:  # look"), "This loop never ends"),
        (LOOP.format(caught="OSError", look="", then="sys.exit()").replace("spin(node)", "spin(node)  # look"), ""),
        ("    while rclpy.ok():\n        rclpy.spin(node)  # look", ""),
        ("    threading.Thread(target=work).start()  # look\n    rclpy.spin(node)", "the thread is not a daemon"),
        ("    threading.Thread(target=work, daemon=True).start()\n    rclpy.spin(node)  # look", ""),
        (CALL.format(asks="self.client.call(Empty.Request())  # look"), "A callback that waits forever"),
        (CALL.format(asks="self.client.call_async(Empty.Request())").replace("spin(node)", "spin(node)  # look"), ""),
    ],
)
def test_only_a_reason_that_the_source_shows_is_told(body: str, words: str) -> None:
    source = MAIN.format(body=body)
    found = why_ignored(evidence(recording([]), submission({NODE_FILE: source})))
    assert words in found.text
    assert bool(found.text) == bool(words)
    assert found.where is not None
    assert found.where.line == line_with(LOOK, source)
