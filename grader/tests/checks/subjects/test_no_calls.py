"""Checks for functions that a task forbids, and checks that only give advice."""

from __future__ import annotations

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.advice import USES_TIMER
from grader.checks.subjects.no_calls import NO_CALLS
from grader.tests.checks.made import NODE, NODE_FILE, evidence, found, submission
from grader.tests.checks.told import told

NAMES = ("teleport", "create_client")


@pytest.mark.parametrize(
    ("last", "observed"),
    [
        ("node.create_client(x)", "The node uses create_client."),
        ("create_client(x)", "The node uses create_client."),
        ("turtles.teleport(1)\nnode.create_client(x)", "The node uses teleport."),
    ],
)
def test_a_forbidden_call_is_shown_where_it_stands(last: str, observed: str) -> None:
    given = evidence(package=submission({NODE_FILE: f"{NODE}\n{last}\n"}))
    finding = found(NO_CALLS, given, names=NAMES, cause="Drive there.")
    assert (finding.diagnosis, finding.observed, str(finding.where)) == ("forbidden-call", observed, f"{NODE_FILE}:23")


SLEEP = ("sleep", "sleep_for", "create_rate")


def used(text: str, **files: str) -> tuple[Status, str]:
    """Return the status and the observation for a node with this code at its end, and with these modules next to it."""
    beside = {f"my_robot_controller/{name}.py": code for name, code in files.items()}
    package = submission({NODE_FILE: f"import time\n{NODE}\n{text}\n", **beside})
    finding = found(NO_CALLS, evidence(package=package), names=SLEEP, cause="Count.")
    return finding.status, finding.observed


@pytest.mark.parametrize(
    "text",
    [
        "from time import sleep as nap\nnap(1)",
        "import time as t\nt.sleep(1)",
        "nap = time.sleep\nnap(1)",
        "import time as t\nnap: object = t.sleep",
        'nap = getattr(time, "sleep")\nnap(1)',
        'nap = getattr(__import__("time"), "sl" "eep")',
        "def wait():\n    from time import sleep as nap\n    nap(1)",
        "class Waits:\n    nap = staticmethod(time.sleep)",
        "from functools import partial\nnap = partial(time.sleep, 1)",
        "def wait(nap=time.sleep):\n    nap(1)",
        "list(map(time.sleep, [1]))",
        'time.__dict__["sleep"](1)',
        'vars(time)["sleep"](1)',
        'from operator import methodcaller\nmethodcaller("sleep", 1)(time)',
        'exec("import time; time.sleep(1)")',
        'nap = getattr(time, "sl" + "eep")',
        'end = "eep"\nnap = getattr(time, f"sl{end}")',
        'vars(time)["sl" + "eep"](1)',
        "match time:\n    case object(sleep=nap):\n        nap(1)",
        "nap = node.get_clock().sleep_for",
        "make = node.create_rate",
        "if (nap := time.sleep): nap(1)",
        "naps = {'a': time.sleep}",
    ],
)
def test_a_function_by_another_name_is_the_same_function(text: str) -> None:
    status, observed = used(text)
    assert status is Status.FAILED
    assert any(name in observed for name in SLEEP)


@pytest.mark.parametrize(
    ("text", "helper"),
    [
        ("from my_robot_controller.helper import nap\nnap(1)", "from time import sleep as nap"),
        ("from my_robot_controller import helper\nhelper.nap(1)", "import time\nnap = time.sleep"),
        ("from .helper import wait\nwait()", "import time\ndef wait():\n    time.sleep(1)"),
        ("from .helper import wait as w\nw()", "import time\ndef rest():\n    time.sleep(1)\ndef wait():\n    rest()"),
        (
            "from .helper import Waits\nWaits().go()",
            "import time\nclass Waits:\n    def go(self):\n        time.sleep(1)",
        ),
        ("import my_robot_controller.helper as h\nh.wait()", "import time\ndef wait():\n    time.sleep(1)"),
        ("from .helper import *\nwait()", "import time\ndef wait():\n    time.sleep(1)"),
    ],
)
def test_another_file_does_not_hide_it(text: str, helper: str) -> None:
    assert used(text, helper=helper)[0] is Status.FAILED


def test_another_file_behind_another_does_not_hide_it() -> None:
    text = "from my_robot_controller.helper import wait\nwait()"
    helper = "from my_robot_controller.deeper import rest\ndef wait():\n    rest()"
    assert used(text, helper=helper, deeper="import time\nrest = time.sleep")[0] is Status.FAILED


@pytest.mark.parametrize(
    ("text", "helper"),
    [
        ("", ""),
        ("from time import sleep", ""),
        ("node.sleep = 3\nprint(node.sleep)", ""),
        ('print("no sleep here")', ""),
        ('names = {"sleep": 1}\nnames["sleep"]', ""),
        (
            "from my_robot_controller.helper import count\ncount()",
            "import time\ndef wait():\n    time.sleep(1)\ndef count(): ...",
        ),
        (
            "from my_robot_controller import helper\nhelper.count()",
            "import time\ndef wait():\n    time.sleep(1)\ndef count(): ...",
        ),
    ],
)
def test_code_that_does_not_call_a_forbidden_function_passes(text: str, helper: str) -> None:
    assert used(text, helper=helper)[0] is Status.PASSED


def test_what_other_files_call_is_not_the_nodes() -> None:
    helper = {
        NODE_FILE: f"from my_robot_controller import helper\n{NODE}",
        "my_robot_controller/helper.py": "teleport(1)\n",
    }
    given = evidence(package=submission(helper))
    assert found(NO_CALLS, given, names=NAMES, cause="Drive there.").status is Status.PASSED


def test_a_node_without_a_timer_is_shown_what_takes_its_place() -> None:
    loops = NODE.replace("self.create_timer(0.5, self.send)", "None")
    finding = found(USES_TIMER, evidence(package=submission({NODE_FILE: loops})))
    assert (finding.diagnosis, str(finding.where)) == ("no-timer", f"{NODE_FILE}:16")
    assert "loop" not in finding.cause
    finding = found(USES_TIMER, evidence(package=submission({NODE_FILE: f"{loops}\nwhile True:\n    pass\n"})))
    assert "receives no messages" in finding.cause


def test_a_node_with_a_rate_does_not_fail_for_a_lack_of_messages() -> None:
    rate = NODE.replace("self.create_timer(0.5, self.send)", "self.create_rate(2)")
    finding = found(USES_TIMER, evidence(package=submission({NODE_FILE: rate})))
    assert finding.diagnosis == "no-timer"
    assert "create_rate" in finding.cause


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (None, "the file of the node is unknown."),
        ("def (:\n", "cannot be read"),
        ("", "contains no code"),
        ("# later\n", "contains no code"),
    ],
)
def test_no_advice_is_given_on_a_file_that_is_missing_unreadable_or_empty(text: str | None, words: str) -> None:
    package = submission({NODE_FILE: text, "setup.py": "setup()\n"})
    finding = found(USES_TIMER, evidence(package=package, build=None))
    assert finding.status is Status.SKIPPED
    assert words in finding.observed


TIMER = "self.create_timer(0.5, self.send)"
LOOP = "\nwhile True:\n    pass\n"
SPINNING_LOOP = "\nwhile True:\n    rclpy.spin_once(node)\n"


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The node uses a timer.", NODE, NODE.replace(TIMER, "None")),
        ("While a node with one thread loops, it receives no messages.", NODE.replace(TIMER, "None") + LOOP, NODE),
        (
            "While a node with one thread loops, it receives no messages.",
            NODE.replace(TIMER, "None") + LOOP,
            NODE.replace(TIMER, "None") + SPINNING_LOOP,
        ),
        (
            (
                "A rate from create_rate works only while another thread spins the node. A timer does not need an "
                "additional thread."
            ),
            NODE.replace(TIMER, "self.create_rate(2)"),
            NODE.replace(TIMER, "None"),
        ),
    ],
)
def test_a_sentence_about_timers_is_true(words: str, true: str, near: str) -> None:
    assert words in told(found(USES_TIMER, evidence(package=submission({NODE_FILE: true}))))
    assert words not in told(found(USES_TIMER, evidence(package=submission({NODE_FILE: near}))))
