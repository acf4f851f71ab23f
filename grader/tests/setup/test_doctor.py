from __future__ import annotations

import errno
import io
import os
import shutil
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from rich.console import Console

from grader.errors import MachineError
from grader.ros import underlay
from grader.ros.installation import Ros, find_ros
from grader.sandbox import bubblewrap
from grader.setup import bootstrap, doctor, machine, node_test
from grader.setup.doctor import Line
from grader.submission import reader
from grader.tests.both_worlds import REAL_TURTLESIM, SOURCED_ENV

OURS = bootstrap.Stamp(str(bootstrap.ROOT), "wheels", "/usr/bin/python3", [3, 11, 2], bootstrap.digest(), [], {})
JAZZY = machine.SourcedRos("/opt/ros/jazzy", (3, 12), turtlesim=True)


USERS = {**os.environ, **({} if SOURCED_ENV else {"ROS_DISTRO": ""})}
"""Ignore any sourced ROS 2 that is not the ROS 2 of the tests."""


def states(lines: list[Line]) -> dict[str, str]:
    return {line.subject: line.state for line in lines}


@pytest.fixture
def wheels() -> Ros:
    """Return the ROS 2 of the tests as if it had been installed from the wheels."""
    return replace(find_ros(), kind="wheels")


@pytest.fixture
def bare(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """Replace all slow checks with good results. Each test makes one of the checks fail."""
    monkeypatch.setattr(bubblewrap, "why_unavailable", lambda: None)
    monkeypatch.setattr(underlay, "ensure", lambda _ros, _tell: Path("/cache/turtlesim"))
    monkeypatch.setattr(doctor, "look_at_node", lambda _ros, **_: Line("a node", "starts"))
    return monkeypatch


def test_all_is_well_on_a_machine_that_runs_these_tests() -> None:
    lines = doctor.run_doctor(USERS)
    assert [line for line in lines if line.state == "broken"] == []
    expected = {"system", "Python", "set-up", "colcon", "sandbox", "reading", "ROS 2", "turtlesim", "a node"}
    assert {*expected, *([] if REAL_TURTLESIM else ["g++"])} <= set(states(lines))
    assert doctor.exit_code(lines) == 0


def test_a_reading_process_without_confinement_is_reported(bare: pytest.MonkeyPatch) -> None:
    assert doctor.look_at_reading().state == "ok"
    bare.setattr(reader, "is_confined", lambda: False)
    line = doctor.look_at_reading()
    assert line.state == "advice"
    assert "Landlock" in line.todo


def test_one_broken_line_is_exit_code_3() -> None:
    assert doctor.exit_code([Line("a", "x"), Line("b", "x", "advice")]) == 0
    assert doctor.exit_code([Line("a", "x"), Line("b", "x", "broken")]) == 3


def test_every_broken_line_says_what_to_do(bare: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def no_ros(_env: object) -> Ros:
        raise MachineError("No ROS 2 Jazzy was found. Run `make demo`.")  # noqa: EM101

    bare.setattr(doctor, "find_ros", no_ros)
    bare.setattr(bubblewrap, "why_unavailable", lambda: "user namespaces are refused: `sudo sysctl ...`")
    bare.setattr(machine, "SYSTEM_PATH", ())
    bare.setattr(shutil, "disk_usage", lambda _path: SimpleNamespace(free=1024))
    lines = doctor.run_doctor({**SOURCED_ENV, "PATH": str(tmp_path)})
    assert {subject for subject, state in states(lines).items() if state == "broken"} == {
        "programs",
        "disk",
        "ROS 2",
    }
    assert [line for line in lines if line.state == "broken" and not (line.todo or "`" in line.observed)] == []


def test_missing_programs_are_one_line_with_one_command(bare: pytest.MonkeyPatch, tmp_path: Path) -> None:
    bare.setattr(machine, "SYSTEM_PATH", ())
    broken = [line for line in doctor.look_at_tools({"PATH": str(tmp_path)}) if line.state == "broken"]
    assert len(broken) == 1
    assert broken[0].todo.endswith("apt-get install -y util-linux g++ cmake make")


def test_missing_headers_are_found(bare: pytest.MonkeyPatch, tmp_path: Path) -> None:
    bare.setattr("sysconfig.get_path", lambda _name: str(tmp_path))
    broken = [line for line in doctor.look_at_tools({"PATH": os.environ["PATH"]}) if line.state == "broken"]
    assert f"python3.{sys.version_info.minor}-dev" in broken[0].todo


def test_interfaces_that_cannot_be_built_are_broken(bare: pytest.MonkeyPatch) -> None:
    def fails(_ros: Ros, _tell: object) -> None:
        raise MachineError("disk full")  # noqa: EM101

    bare.setattr(underlay, "ensure", fails)
    lines = doctor.run_doctor(USERS)
    assert (lines[-1].subject, lines[-1].state, lines[-1].todo) == ("turtlesim", "broken", "disk full")


def test_an_old_set_up_is_advice(bare: pytest.MonkeyPatch) -> None:
    bare.setattr(sys, "prefix", str(bootstrap.VENV))
    assert [line.state for line in doctor.look_at_set_up({}, OURS)] == ["ok"]
    assert [line.todo for line in doctor.look_at_set_up({}, OURS._replace(digest="old"))] == ["make demo"]


def test_an_environment_made_for_another_ros_than_the_sourced_one_is_advice(bare: pytest.MonkeyPatch) -> None:
    bare.setattr(sys, "prefix", str(bootstrap.VENV))
    bare.setattr(machine, "sourced_ros", lambda _env, _ours: JAZZY)
    (line,) = doctor.look_at_set_up({}, OURS)
    assert line.state == "advice"
    assert line.observed == "made for the course's own ROS 2, but /opt/ros/jazzy is sourced and used"


def test_an_environment_whose_ros_is_not_sourced_is_broken(bare: pytest.MonkeyPatch) -> None:
    bare.setattr(sys, "prefix", str(bootstrap.VENV))
    (line,) = doctor.look_at_set_up({}, OURS._replace(ros="/opt/ros/jazzy"))
    assert line.state == "broken"
    assert line.todo.startswith("source /opt/ros/jazzy/setup.bash")


def test_a_ros_by_another_name_is_the_same_one(bare: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "jazzy").mkdir()
    (tmp_path / "link").symlink_to("jazzy")
    bare.setattr(sys, "prefix", str(bootstrap.VENV))
    bare.setattr(machine, "sourced_ros", lambda _env, _ours: JAZZY._replace(prefix=str(tmp_path / "link")))
    assert [line.state for line in doctor.look_at_set_up({}, OURS._replace(ros=str(tmp_path / "jazzy")))] == ["ok"]


def test_a_colcon_that_cannot_start_is_broken(bare: pytest.MonkeyPatch) -> None:
    assert doctor.look_at_colcon().state == "ok"
    bare.setattr(doctor, "find_spec", lambda _name: None)
    assert "does not start without empy" in doctor.look_at_colcon().observed


def test_a_sourced_ros_for_another_python_is_broken(bare: pytest.MonkeyPatch, wheels: Ros) -> None:
    bare.setattr(machine, "sourced_ros", lambda _env, _ours: JAZZY._replace(python=(3, 9)))
    sourced = Ros("sourced", "7.1.6", Path("/opt"), (Path("/opt"),), wheels.python, (), ())
    assert doctor.look_at_ros(sourced, {"ROS_DISTRO": "jazzy"}).state == "broken"


def test_another_sourced_distribution_is_reported(wheels: Ros) -> None:
    line = doctor.look_at_ros(wheels, {"ROS_DISTRO": "humble"})
    assert line.state == "advice"
    assert "humble is sourced, but not used" in line.observed


@pytest.mark.parametrize(("free", "state"), [(10 * 2**30, "ok"), (2**30, "advice"), (2**20, "broken")])
def test_disk(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, free: int, state: str) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda _path: SimpleNamespace(free=free))
    assert doctor.look_at_disk(tmp_path / "not/yet/there").state == state


def test_a_cache_that_may_not_be_entered(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def denied(path: Path) -> bool:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))

    monkeypatch.setattr(Path, "is_dir", denied)
    assert str(tmp_path / "cache") in doctor.look_at_disk(tmp_path / "cache").observed


@pytest.mark.parametrize(
    ("meminfo", "state"),
    [
        ("MemTotal: 8000000 kB\nMemAvailable: 4000000 kB\n", "ok"),
        ("MemTotal: 8000000 kB\nMemAvailable: 500000 kB\n", "advice"),
        ("MemTotal: 8000000 kB\n", "ok"),
    ],
)
def test_memory(meminfo: str, state: str) -> None:
    assert doctor.look_at_memory(meminfo).state == state


def test_a_node_that_is_not_heard_is_reported(monkeypatch: pytest.MonkeyPatch, wheels: Ros) -> None:
    monkeypatch.setattr(node_test, "_TALKER", "raise SystemExit")
    monkeypatch.setattr(node_test, "_LISTENER", node_test._LISTENER.replace("20.0", "1.0"))
    line = doctor.look_at_node(wheels)
    assert line.state == "broken"
    assert "no message arrived" in line.observed


def test_a_machine_without_a_sandbox_is_good_enough_for_ones_own_code(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bubblewrap, "program", lambda: None)
    lines = doctor.run_doctor(USERS)
    assert [line for line in lines if line.state == "broken"] == []
    (reported,) = [line for line in lines if line.subject == "sandbox"]
    assert reported.state == "advice"
    assert "limits on time, memory, processes and file size" in reported.observed
    assert "install -y bubblewrap" in reported.todo
    assert states(lines)["a node"] == "ok"


def test_a_node_that_is_not_heard_without_a_cell_is_reported(monkeypatch: pytest.MonkeyPatch, wheels: Ros) -> None:
    monkeypatch.setattr(node_test, "_TALKER", "raise SystemExit")
    monkeypatch.setattr(node_test, "_LISTENER", node_test._LISTENER.replace("20.0", "1.0"))
    line = doctor.look_at_node(wheels, confined=False)
    assert (line.state, "no message arrived" in line.observed) == ("broken", True)


def test_one_core_is_in_the_singular(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    assert doctor.look_at_system().observed.endswith(", 1 core")


def test_lines_are_plain_and_whole_when_piped() -> None:
    output = io.StringIO()
    long = "x" * 200
    doctor.render([Line("disk", long, "broken", "make [room]"), Line("ROS 2", "Jazzy")], Console(file=output))
    assert output.getvalue().splitlines() == [
        f"broken  disk        {long}",
        "                    -> make [room]",
        "ok      ROS 2       Jazzy",
    ]
