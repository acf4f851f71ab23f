from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from grader.setup import bootstrap, machine
from grader.setup.bootstrap import Stamp
from grader.setup.machine import SourcedRos
from grader.setup.setup_errors import MACHINE_BROKEN
from grader.tests.setup.course import LEARNER, SYSTEMS, TESTS, Course

ROOT = Path(bootstrap.__file__).parents[2]


def test_first_set_up_makes_the_environment_and_fills_it(course: Course) -> None:
    assert course.set_up() == 0
    assert course.programs == ["venv", "grader.setup.install"]
    stamp = bootstrap.read_stamp()
    assert stamp is not None
    assert (stamp.parts, stamp.ros, stamp.version) == (LEARNER, "wheels", [3, 11, 2])


@pytest.mark.parametrize(("user", "mask", "mode"), [(0, 0o022, 0o644), (1000, 0o077, 0o600)])
def test_what_root_sets_up_can_be_read_by_the_user_of_a_cell(
    course: Course, monkeypatch: pytest.MonkeyPatch, user: int, mask: int, mode: int
) -> None:
    monkeypatch.setattr(os, "getuid", lambda: user)
    monkeypatch.setattr(machine, "platform_problem", lambda *_: "")
    monkeypatch.setattr(machine, "sourced_ros", lambda *_: None)
    module = course.root / "grader/module.py"
    module.parent.mkdir()
    module.touch(mode=0o600)
    before = os.umask(0o077)
    try:
        assert bootstrap.main(["learner"]) == 0
    finally:
        during = os.umask(before)
    assert (during, module.stat().st_mode & 0o777) == (mask, mode)


def test_a_second_set_up_says_that_it_waits_for_the_first(tmp_path: Path) -> None:
    code = "import sys; from grader.setup.bootstrap import wait_for; wait_for(open(sys.argv[1])); print('mine')"
    file = tmp_path / "lock"
    with file.open("w") as first:
        bootstrap.wait_for(first)
        second = subprocess.Popen([sys.executable, "-c", code, str(file)], cwd=ROOT, stdout=subprocess.PIPE, text=True)
        assert second.stdout is not None
        assert second.stdout.readline() == "Waiting for another process, which is setting up this folder\n"
    assert second.communicate()[0] == "mine\n"


def test_second_set_up_does_nothing(course: Course) -> None:
    course.set_up()
    assert course.set_up() == 0
    assert course.commands == []


def test_an_environment_that_does_not_find_the_course_is_mended(course: Course) -> None:
    course.set_up()
    for text in (None, ""):
        course.path_file.unlink() if text is None else course.path_file.write_text(text)
        assert (course.set_up(), course.programs) == (0, ["grader.setup.install"])


def test_tests_are_added_to_what_is_there_and_stay(course: Course) -> None:
    course.set_up()
    course.set_up(TESTS)
    assert course.programs == ["grader.setup.install"]
    course.set_up(LEARNER)
    assert course.commands == []
    (course.root / "requirements.lock").write_text("newer")
    course.set_up(LEARNER)
    stamp = bootstrap.read_stamp()
    assert stamp is not None
    assert stamp.parts == TESTS


@pytest.mark.parametrize("name", ["requirements.lock", "pyproject.toml"])
def test_a_changed_list_of_packages_is_installed_into_the_same_environment(course: Course, name: str) -> None:
    course.set_up()
    (course.root / name).write_text("changed")
    course.set_up()
    assert course.programs == ["grader.setup.install"]


def test_an_interrupted_set_up_begins_anew(course: Course) -> None:
    course.set_up()
    course.stamp.unlink()
    course.set_up()
    assert course.programs == ["venv", "grader.setup.install"]
    course.stamp.write_text('{"root": ')
    course.set_up()
    assert course.programs == ["venv", "grader.setup.install"]


@pytest.mark.parametrize("stage", ["venv", "grader.setup.install"])
def test_a_set_up_that_was_stopped_within_a_stage_is_made_whole(
    course: Course, monkeypatch: pytest.MonkeyPatch, stage: str
) -> None:
    carry_out = course.call

    def stopped(command: list[str], **options: object) -> int:
        if stage in command:
            (course.root / ".venv").mkdir(exist_ok=True)
            raise KeyboardInterrupt
        return carry_out(command, **options)

    for name in ("call", "check_output"):
        monkeypatch.setattr(subprocess, name, stopped)
    with pytest.raises(KeyboardInterrupt):
        course.set_up()
    for name in ("call", "check_output"):
        monkeypatch.setattr(subprocess, name, carry_out)
    assert course.set_up() == 0
    assert course.programs == ["venv", "grader.setup.install"]


def test_without_a_network_nothing_is_begun(course: Course, capsys: pytest.CaptureFixture[str]) -> None:
    course.offline = True
    assert course.set_up() == MACHINE_BROKEN
    assert course.commands == []
    assert "(it has no network). Is it online?" in capsys.readouterr().err
    course.offline = False
    course.set_up()
    course.offline = True
    assert course.set_up() == 0


def test_another_python_behind_the_environment_makes_it_anew(course: Course) -> None:
    course.set_up()
    course.python = SYSTEMS._replace(version=(3, 11, 9))
    course.set_up()
    assert course.programs == ["venv", "grader.setup.install"]


def test_a_moved_folder_makes_the_environment_anew(course: Course, monkeypatch: pytest.MonkeyPatch) -> None:
    course.set_up()
    monkeypatch.setattr(bootstrap, "ROOT", Path("/elsewhere"))
    assert not bootstrap.stands(Stamp(**json.loads(course.stamp.read_text())), None, None)


def test_a_sourced_ros_sees_the_systems_packages(course: Course) -> None:
    course.set_up()
    course.python = SYSTEMS._replace(path="/usr/bin/python3.12", version=(3, 12, 3))
    course.set_up(ros=SourcedRos("/opt/ros/jazzy", (3, 12), turtlesim=True))
    assert course.programs == ["venv", "grader.setup.install"]
    assert "--system-site-packages" in course.commands[0]
    assert json.loads(course.commands[1][-1])["ros"] == "/opt/ros/jazzy"


JAZZY = SourcedRos("/opt/ros/jazzy", (3, 11), turtlesim=True)


def test_of_two_pythons_the_one_that_can_import_what_a_sourced_ros_needs_is_taken(
    course: Course, monkeypatch: pytest.MonkeyPatch
) -> None:
    pyenvs = SYSTEMS._replace(path="/home/me/.pyenv/bin/python3.11", lacks=("em",))
    monkeypatch.setattr(machine, "find_pythons", lambda _path: iter([pyenvs, SYSTEMS]))
    assert course.set_up(ros=JAZZY) == 0
    assert SYSTEMS.path in course.commands[0]


def test_the_set_up_stops_if_no_python_can_import_the_modules_of_ros_2(
    course: Course, capsys: pytest.CaptureFixture[str]
) -> None:
    course.python = SYSTEMS._replace(path="/home/me/.pyenv/bin/python3.11", lacks=("em",))
    assert course.set_up(ros=JAZZY) == MACHINE_BROKEN
    assert course.commands == []
    assert "/home/me/.pyenv/bin/python3.11 cannot import em" in capsys.readouterr().err


def test_an_environment_that_lacks_what_the_sourced_ros_needs_is_made_anew(
    course: Course, monkeypatch: pytest.MonkeyPatch
) -> None:
    course.set_up(ros=JAZZY)
    course.set_up(ros=JAZZY)
    assert course.commands == []
    monkeypatch.setattr(machine, "for_ros", lambda python, _ros: python._replace(lacks=("em",)))
    monkeypatch.setattr(machine, "find_pythons", lambda _path: iter([SYSTEMS]))
    course.set_up(ros=JAZZY)
    assert course.requested == [["python3-empy"]]


def test_a_set_up_for_a_sourced_ros_is_not_replaced_without_a_word(
    course: Course, capsys: pytest.CaptureFixture[str]
) -> None:
    course.set_up(ros=JAZZY)
    assert "with its own ROS 2" not in capsys.readouterr().out
    course.set_up()
    assert "made for the ROS 2 in /opt/ros/jazzy, which is not sourced" in capsys.readouterr().out


def test_a_prefix_by_another_name_is_the_same_ros(course: Course, tmp_path: Path) -> None:
    (tmp_path / "jazzy").mkdir()
    (tmp_path / "link").symlink_to("jazzy")
    course.set_up(ros=JAZZY._replace(prefix=str(tmp_path / "jazzy")))
    course.set_up(ros=JAZZY._replace(prefix=str(tmp_path / "link")))
    assert course.commands == []


def test_a_python_that_cannot_make_an_environment_is_reported(
    course: Course, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(command: list[str], **_options: object) -> bytes:
        raise subprocess.CalledProcessError(1, command, b"Error: no space left on device\n")

    monkeypatch.setattr(subprocess, "check_output", fails)
    assert course.set_up() == MACHINE_BROKEN
    assert "no space left on device" in capsys.readouterr().err
    assert course.commands == []


# --- its command line ---


def bootstrapped(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run with only the standard library (-S), as on a machine where nothing is installed yet."""
    command = [sys.executable, "-S", "-m", "grader.setup.bootstrap", *arguments]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def test_help_names_every_target() -> None:
    done = bootstrapped("--help")
    assert (done.returncode, done.stderr) == (0, "")
    assert all(target in done.stdout for target in bootstrap.PARTS)
    assert all(target in (bootstrap.__doc__ or "") for target in bootstrap.PARTS)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "the following arguments are required: parts"),
        (["learners"], "invalid choice: 'learners'"),
        (["learner", "tests"], "unrecognized arguments: tests"),
        (["learner", "--verbose"], "unrecognized arguments: --verbose"),
        (["learner", "--python"], "argument --python: expected one argument"),
        (["learner", "--python", "python9"], "argument --python: python9 is not a Python that runs on this machine"),
    ],
)
def test_a_wrong_argument_is_reported_with_the_usage(arguments: list[str], said: str) -> None:
    done = bootstrapped(*arguments)
    assert done.returncode == 2
    assert done.stderr.startswith("usage: python3 -m grader.setup.bootstrap ")
    assert done.stderr.endswith(f"{said}\n") or f"{said} (choose from" in done.stderr


@pytest.mark.parametrize("arguments", [["tests"], ["tests", "--python", "python3"], ["--python=python3", "tests"]])
def test_the_target_and_the_python_requested_are_set_up(
    course: Course, monkeypatch: pytest.MonkeyPatch, arguments: list[str]
) -> None:
    requested: list[object] = []

    def set_up(*given: object) -> int:
        requested.extend(given)
        return 7

    monkeypatch.setattr(bootstrap, "set_up", set_up)
    assert bootstrap.main(arguments) == 7
    assert requested == [TESTS, machine.sourced_ros(os.environ, ROOT), course.python if len(arguments) > 1 else None]


def test_a_failed_import_after_an_update_names_the_command_that_sets_up_again(course: Course) -> None:
    course.set_up()
    error = ImportError("No module named 'new'")
    assert bootstrap.outdated(error) is None, "the packages are those of the lock file"
    (course.root / "requirements.lock").write_text("newer")
    again = f"Set it up again: cd {course.root} && make demo"
    assert bootstrap.outdated(error) == f"the course has changed since its set-up (No module named 'new'). {again}"
    assert bootstrap.outdated(ValueError()) is None
