"""Every attack in hostile/ is stopped. Without a sandbox, the attacks on the host work."""

from __future__ import annotations

import dataclasses
import json
import os
import shlex
import sys
import tempfile
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import load_exercise
from grader.checks.judge import judge
from grader.checks.outcome import Status
from grader.evidence import recording_format
from grader.evidence.evidence import Run
from grader.ros import installation, underlay
from grader.sandbox import bubblewrap
from grader.tests.attack import Attack, make_attack, read_attacks
from grader.tests.case import copy_solution
from grader.tests.gradings import AT_ONCE
from grader.tests.observed_host import SECRET, Host, Left, readable_by_others
from grader.tests.waiting import is_crowded
from grader.trial.recorder import NAMESAKE, OWN_NAMESPACE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from grader.evidence.evidence import Evidence

UNKNOWN = "_NODE_NAME_UNKNOWN_"
"""The name of a node in rclpy while only its endpoints are known."""
EXERCISE = "03-circle-publisher"
ATTACKS = read_attacks()
WAYS = ("defended", "as-user", "undefended")
pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="the sandbox is not available")


@dataclass(frozen=True)
class Graded:
    """The result of an attack: its effects on the host, and a folder with report.json, report.html and recording/."""

    left: Left
    work: Path
    crowded: bool
    """Whether the report says that the machine was too busy, and other programs kept it busy."""

    @property
    def evidence(self) -> Evidence:
        return recording_format.load(self.work / "recording", load_exercise).evidence

    @property
    def points(self) -> float:
        return float(json.loads((self.work / "report.json").read_bytes())["points"])

    @property
    def said(self) -> str:
        """Return the output of the build and of the node, or the report of the student's tests."""
        evidence = self.evidence
        log = evidence.build.log if evidence.build else ""
        if evidence.run.bench is not None:
            return log + "".join(run.message for run in evidence.run.bench.runs)
        if evidence.run.recording is None:
            return log
        return log + evidence.run.recording.stdout.text + evidence.run.recording.stderr.text


class Runs:
    """Run the attacks that this session needs, as many in parallel as there are processors."""

    def __init__(self, wanted: list[tuple[Attack, str]], folder: Path, pool: ThreadPoolExecutor) -> None:
        self._futures: dict[tuple[str, str], Future[Graded]] = {
            (attack.name, mode): pool.submit(run, attack, mode, folder / f"{attack.name}.{mode}")
            for attack, mode in wanted
        }

    def of(self, attack: Attack, mode: str) -> Graded:
        return self._futures[attack.name, mode].result()


def run(attack: Attack, mode: str, folder: Path) -> Graded:
    host = Host(folder, underlay.ensure(installation.find_ros()), as_user=mode == "as-user")
    make_attack(attack, host.work)
    if mode == "undefended" and attack.raw:
        raw = attack.raw.replace("{python}", shlex.quote(sys.executable))
        script = f"cd my_robot_controller && {{ {raw}; }} 2>&1"
        return Graded(host.run(["sh", "-c", script], defended=False), host.work, crowded=False)
    wanted = ["--json", "report.json", "--html", "report.html", "--recording", "recording", "--clock", attack.clock]
    check = [sys.executable, "-m", "grader.cli", "check", "my_robot_controller", "--exercise", attack.base, *wanted]
    left = host.run(check, defended=mode != "undefended")
    return Graded(left, host.work, is_crowded(left.stdout))


@pytest.fixture(scope="session")
def runs(request: pytest.FixtureRequest) -> Iterator[Runs]:
    wanted: dict[tuple[str, str], tuple[Attack, str]] = {}
    for item in request.session.items:
        attack = getattr(item, "callspec", None) and item.callspec.params.get("attack")  # type: ignore[attr-defined]
        if isinstance(attack, Attack):
            for mark in item.iter_markers("clocks"):
                wanted.update({(attack.name, mode): (attack, mode) for mode in mark.args})
    # Other users cannot read pytest's own folders.
    with tempfile.TemporaryDirectory(prefix="hostile-") as folder, ThreadPoolExecutor(AT_ONCE) as pool:
        Path(folder).chmod(0o755)
        yield Runs(list(wanted.values()), Path(folder), pool)
        pool.shutdown(cancel_futures=True)


def each(which: Callable[[Attack], bool], *, sampled: bool = True) -> pytest.MarkDecorator:
    def marks(attack: Attack) -> tuple[pytest.MarkDecorator, ...]:
        return () if sampled and attack.sample else (pytest.mark.exhaustive,)

    chosen = [pytest.param(attack, id=attack.name, marks=marks(attack)) for attack in ATTACKS if which(attack)]
    return pytest.mark.parametrize("attack", chosen)


@pytest.mark.clocks("defended")
@each(lambda _: True)
def test_an_attack_is_stopped(attack: Attack, runs: Runs) -> None:
    assert_held(attack, runs.of(attack, "defended"))


@pytest.mark.skipif(not readable_by_others(Path(__file__)), reason="other users cannot read this folder")
@pytest.mark.skipif(os.geteuid() != 0, reason="the other tests already run as an ordinary user")
@pytest.mark.clocks("as-user")
@each(lambda _: True, sampled=False)
def test_an_attack_is_stopped_for_an_ordinary_user(attack: Attack, runs: Runs) -> None:
    assert_held(attack, runs.of(attack, "as-user"))


def assert_held(attack: Attack, done: Graded) -> None:
    left = done.left
    # If other programs keep the machine busy, the report may mention it, and the attack may not get as far as it
    # otherwise does. The attacker alone must not cause this.
    crowded = done.crowded
    if not crowded:
        assert left.exit_code in (0, 1), left.stdout + left.stderr
    assert (sorted(left.files), left.processes, left.sockets) == ([], (), ())
    if attack.points >= 0.0 and not crowded:
        assert done.points == pytest.approx(attack.points), left.stdout
    assert done.points <= attack.most, left.stdout
    said = done.said
    assert SECRET not in said
    if attack.says:
        assert attack.says not in said
    html = (done.work / "report.html").read_text("utf-8")
    assert SECRET not in html
    assert [text for text in attack.never if text in left.stdout + left.stderr] == []
    assert [text for text in attack.never_html if text in html] == []
    if attack.reaches and not crowded:
        assert attack.reaches in said or was_there(done.evidence, attack.reaches), said


def was_there(evidence: Evidence, what: str) -> bool:
    """Return whether `what` is in the evidence: a topic, a node, an intervention, an output of a call, or "... files".

    If the simulator was overwhelmed, return True.
    """
    if evidence.run.overwhelmed is not None:
        return True
    if what.endswith(" files"):
        return evidence.build is not None and evidence.build.out_of is not None
    seen: set[str] = set()
    for recording in (run.recording for run in evidence.runs.values() if run.recording is not None):
        seen |= {node.lstrip("/") for graph in recording.graphs for node in graph.nodes}
        seen |= {*recording.topics, *recording.interventions}
    outputs = [called.stdout for run in evidence.runs.values() for called in run.called or ()]
    return what in seen or any(what in output for output in outputs)


@pytest.mark.clocks("undefended")
@each(lambda attack: attack.is_of_the_host, sampled=False)
def test_an_attack_without_a_sandbox_leaves_its_trace(attack: Attack, runs: Runs) -> None:
    done = runs.of(attack, "undefended")
    left = done.left
    graded = (done.work / "recording").is_dir()
    said = done.said if graded else left.stdout
    if attack.kills:
        assert left.exit_code in (None, -9, 137), left
    if attack.says:
        assert attack.says in said, left
    if attack.secret:
        assert SECRET in said, left
    if attack.file:
        assert attack.file in left.files, left
    if attack.process:
        assert any(attack.process in process for process in left.processes), left
    if attack.socket:
        assert any(attack.socket in each for each in left.sockets), left


@pytest.mark.clocks("defended")
@each(lambda attack: bool(attack.passes))
def test_without_its_defence_a_check_would_pass(attack: Attack, runs: Runs) -> None:
    evidence = runs.of(attack, "defended").evidence
    recording = evidence.recording
    if attack.without == "interventions":
        blind = dataclasses.replace(recording, interventions=())
    else:
        graphs = tuple(
            dataclasses.replace(graph, endpoints=tuple(each for each in graph.endpoints if not is_double(each.node)))
            for graph in recording.graphs
        )
        blind = dataclasses.replace(recording, graphs=graphs)
    before, after = (
        {outcome.id: outcome.status for outcome in judge(each)}[attack.passes]
        for each in (evidence, evidence.with_run(Run(blind)))
    )
    assert (before, after) == (Status.FAILED, Status.PASSED)


def is_double(node: str) -> bool:
    """Return whether a student's node has the name of a node of the grader, or its name has not arrived yet.

    DDS announces the endpoints of a participant before the name of its node.
    """
    return node.endswith((NAMESAKE, UNKNOWN)) or node.startswith(OWN_NAMESPACE)


@pytest.mark.exhaustive
def test_an_attack_does_not_change_the_grading_of_the_next_submission(tmp_path: Path) -> None:
    """Grade a correct submission after three attacks on the same machine.

    The attacks must leave no files or processes.
    """
    host = Host(tmp_path / "host", underlay.ensure(installation.find_ros()))
    chosen = [attack for attack in ATTACKS if attack.name[:3] in ("301", "304", "406")]
    commands = []
    for attack in chosen:
        make_attack(attack, host.work / attack.name)
        commands.append(f"{attack.name}/my_robot_controller")
    copy_solution(EXERCISE, host.work / "honest")
    commands.append("honest --json honest.json")
    check = f"{shlex.quote(sys.executable)} -m grader.cli check --exercise {EXERCISE}"
    left = host.run(["sh", "-c", "; ".join(f"{check} {command}" for command in commands)])
    report = json.loads((host.work / "honest.json").read_bytes())
    assert (left.exit_code, report["points"], sorted(left.files), left.processes) == (0, 100.0, [], ()), left.stdout


def test_there_are_at_least_sixty_attacks() -> None:
    assert len(ATTACKS) >= 100
    unproven = [a.name for a in ATTACKS if not (a.is_of_the_host or a.passes or a.reaches)]
    assert unproven == []
