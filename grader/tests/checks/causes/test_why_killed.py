"""A target that was removed without being caught: by /kill, by /reset, or for an unknown reason."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.causes.why_killed import why_killed
from grader.checks.exercises import find_exercise
from grader.evidence.evidence import Evidence, Run
from grader.submission.package import open_submission
from grader.tests.case import ROOT
from grader.tests.checks.made import evidence, recording
from grader.trial.observed import Call, Track

FAR = Track("far", ((0.0, 9.0, 5.5, 0.0),), 5.0)
KILLED = (
    "/kill was called for far, but /catch was not called before. Call /kill only in the callback of /catch, with the "
    "name in its request."
)
ONLY = "Remove a target only in the callback of /catch."


def kill(t_s: float, name: str) -> Call:
    return Call(t_s, "/kill", "turtlesim/srv/Kill", {"name": name}, {}, t_s)


def reset(t_s: float, *, by_trial: bool = False) -> Call:
    return Call(t_s, "/reset", "std_srvs/srv/Empty", {}, {}, t_s, by_trial=by_trial)


@pytest.mark.parametrize(
    ("call", "cause"),
    [
        (kill(4.9, "far"), KILLED),
        (kill(4.9, "near"), ONLY),
        (reset(4.9), "/reset was called, which removes all turtles except turtle1."),
        (reset(1.0), ONLY),
        (reset(5.5), ONLY),
        (reset(4.9, by_trial=True), ONLY),
    ],
)
def test_only_the_call_that_removed_the_target_is_told(call: Call, cause: str) -> None:
    assert why_killed(evidence(recording([], calls=(call,))), FAR, "/catch").text == cause


SPAWNER = "class Spawner(Node):\n    def __init__(self):\n        super().__init__('{}')\n"
CATCHER = "class Catcher(Node):\n    def __init__(self):\n        super().__init__('catcher')\n"


IMPORTS = "from my_robot_controller.{} import TURTLES\n"


@pytest.mark.parametrize(
    ("spawner", "catcher", "told"),
    [
        (SPAWNER.format("catcher"), CATCHER, True),
        (SPAWNER.format("spawner"), CATCHER, False),
        (SPAWNER.format("spawner"), IMPORTS.format("spawner") + CATCHER, False),
        (IMPORTS.format("catcher") + SPAWNER.format("spawner"), CATCHER, False),
        (None, CATCHER + SPAWNER.format("spawner"), False),
    ],
)
def test_two_nodes_of_one_name_are_told(spawner: str | None, catcher: str, *, told: bool) -> None:
    package = open_submission(ROOT / "solutions/13-catch-them-all")
    files = {"my_robot_controller/spawner.py": spawner or "", "my_robot_controller/catcher.py": catcher}
    if spawner is None:
        setup = package.files["setup.py"].decode()
        files["setup.py"] = setup.replace("my_robot_controller.spawner:", "my_robot_controller.catcher:")
    package = replace(package, files={**package.files, **{path: text.encode() for path, text in files.items()}})
    runs = {"referee": Run(recording=recording([], calls=(kill(4.9, "far"),)))}
    given = Evidence(find_exercise("13-catch-them-all"), package, runs=runs).from_trial("referee")
    found = why_killed(given, FAR, "/catch")
    assert ("Both nodes have the name catcher, so it is unknown which node calls a service." in found.text) == told
    assert (found.diagnosis == "node-name") == told
