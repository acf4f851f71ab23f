from __future__ import annotations

import os
import pwd
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from grader.errors import MachineError, UsageError
from grader.ros import installation, shell, underlay
from grader.tests.both_worlds import HERE, PATH, REAL_ROS2, SOURCED_ENV, of_the_wheels
from grader.tests.lacking import give_up

BIN = str(Path(sys.prefix, "bin"))


WHEELS, SOURCED = replace(HERE, kind="wheels"), replace(HERE, kind="sourced")


def users(env: dict[str, str], domain: int | None = None, ros: installation.Ros = HERE) -> dict[str, str]:
    return installation.users_environment(ros, {"HOME": "/tmp", **env}, domain)


def sourced(code: str, what: str, **env: str) -> str:
    done = subprocess.run(
        ["bash", "-c", f'eval "$CODE"; unset CODE; {what}'],
        env={"PATH": "/usr/bin:/bin", "HOME": "/tmp", "CODE": code, **env},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stderr == ""
    return done.stdout


def test_a_domain_of_the_users_own_unless_they_chose_one() -> None:
    assert users({}, ros=WHEELS)["ROS_DOMAIN_ID"] == str(installation.domain_of(os.getuid()))
    assert users({"ROS_DOMAIN_ID": "7"})["ROS_DOMAIN_ID"] == "7"
    assert users({"ROS_DOMAIN_ID": "7"}, domain=9)["ROS_DOMAIN_ID"] == "9"


def test_a_sourced_ros_2_stays_where_a_terminal_has_it_in_which_nothing_else_was_sourced() -> None:
    assert users({}, ros=SOURCED)["ROS_DOMAIN_ID"] == "0"
    assert "ROS_AUTOMATIC_DISCOVERY_RANGE" not in users({}, ros=SOURCED)
    theirs = {"ROS_DOMAIN_ID": "7", "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
    assert theirs.items() <= users(theirs, ros=SOURCED).items()
    assert users(theirs, domain=9, ros=SOURCED)["ROS_DOMAIN_ID"] == "9"


@pytest.mark.parametrize(
    ("env", "reported"),
    [
        (
            {"ROS_DOMAIN_ID": "5", "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"},
            "domain 5, reachable only on this machine",
        ),
        ({"ROS_LOCALHOST_ONLY": "1"}, "domain 0, reachable only on this machine"),
        ({}, "domain 0, reachable from the network"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, "domain 0, reachable from the network"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}, "RANGE=OFF, so nodes do not find each other"),
    ],
)
def test_the_shell_reports_from_where_a_node_can_be_reached(env: dict[str, str], reported: str) -> None:
    assert reported in installation.who_hears(env)


@pytest.mark.parametrize("domain", ["abc", "500", "-1", "233", "1.5", "²"])
def test_a_domain_that_does_not_exist_is_named_before_a_node_fails(domain: str) -> None:
    with pytest.raises(UsageError, match=r"from 0 to 232 was expected. .* unset ROS_DOMAIN_ID"):
        users({"ROS_DOMAIN_ID": domain})
    assert users({"ROS_DOMAIN_ID": domain}, domain=9)["ROS_DOMAIN_ID"] == "9"


def test_only_a_sourced_ros_2_can_have_another_middleware() -> None:
    theirs = {"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}
    assert users(theirs, ros=WHEELS)["RMW_IMPLEMENTATION"] == "rmw_fastrtps_cpp"
    assert users(theirs, ros=SOURCED)["RMW_IMPLEMENTATION"] == "rmw_cyclonedds_cpp"


@pytest.mark.parametrize("env", [{}, {"HOME": ""}, {"HOME": "here"}])
def test_a_user_without_a_home_in_the_environment_gets_the_one_of_the_system(env: dict[str, str]) -> None:
    own = pwd.getpwuid(os.getuid()).pw_dir
    assert installation.users_environment(HERE, env)["HOME"] == own


def test_the_users_settings_of_fast_dds_stay() -> None:
    theirs = {"FASTRTPS_DEFAULT_PROFILES_FILE": "/home/me/fast.xml", "FASTDDS_BUILTIN_TRANSPORTS": "SHM"}
    assert theirs.items() <= users(theirs).items()


@pytest.mark.parametrize("domain", [-1, 102])
def test_an_invalid_domain_is_a_usage_error(domain: int) -> None:
    with pytest.raises(UsageError, match="from 0 to 101"):
        shell.users_environment(domain, lambda _: None)


@pytest.mark.parametrize("home", ["home", "home of Ada", "home*"])
def test_colcons_scripts_get_a_python_without_a_space_in_its_path(home: str, tmp_path: Path) -> None:
    # colcon's scripts start Python without quotes around its path.
    python = tmp_path / home / ".venv/bin/python3"
    python.parent.mkdir(parents=True)
    python.symlink_to(Path(sys.executable).resolve())
    env = installation.users_environment(replace(HERE, python=python), {"HOME": str(tmp_path)})
    assert env.get("COLCON_PYTHON_EXECUTABLE") == (None if home == "home" else str(python.resolve()))


def test_the_environment_has_what_every_node_needs() -> None:
    env = users({}, ros=WHEELS)
    assert env["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    assert env["ROS_PYTHON_CHECK_FIELDS"] == "1"
    assert Path(env["FASTRTPS_DEFAULT_PROFILES_FILE"]).is_file()
    assert "ROS_LOG_DIR" not in env


def test_a_home_that_cannot_be_written_gets_a_log_folder(tmp_path: Path) -> None:
    assert "ros-log" in users({"HOME": str(tmp_path / "nowhere")})["ROS_LOG_DIR"]
    assert "ROS_LOG_DIR" not in users({"HOME": str(tmp_path / "nowhere"), "ROS_HOME": "/x"})


def test_a_workspace_that_was_sourced_stays_in_front(tmp_path: Path) -> None:
    overlay = tmp_path / "install/my_robot_controller"
    overlay.mkdir(parents=True)
    first = users({})
    again = users({**first, "AMENT_PREFIX_PATH": f"{overlay}:{first['AMENT_PREFIX_PATH']}"})
    assert again["AMENT_PREFIX_PATH"] == f"{overlay}:{first['AMENT_PREFIX_PATH']}"
    assert users(again) == again


@of_the_wheels
def test_another_ros_2_and_an_older_turtlesim_do_not_mix_with_ours(tmp_path: Path) -> None:
    humble = tmp_path / "opt/ros/humble"
    marker = humble / "share/ament_index/resource_index/packages/rclpy"
    marker.parent.mkdir(parents=True)
    marker.touch()
    stale = tmp_path / "turtlesim-0123"
    before = {
        "ROS_DISTRO": "humble",
        "AMENT_PREFIX_PATH": f"{stale}:{humble}",
        "LD_LIBRARY_PATH": f"/usr/local/cuda:{humble}/lib",
        "PYTHONPATH": f"{humble}/lib/python3/site-packages",
    }
    env = users(before)
    assert env["ROS_DISTRO"] == "jazzy"
    assert str(tmp_path) not in " ".join(env.values())
    assert env["LD_LIBRARY_PATH"].startswith("/usr/local/cuda:")


def test_our_commands_come_first_unless_a_ros_2_is_sourced() -> None:
    assert users({"PATH": "/usr/bin"}, ros=WHEELS)["PATH"] == f"{BIN}:/usr/bin"
    assert users({"PATH": "/usr/bin"}, ros=SOURCED)["PATH"] == f"/usr/bin:{BIN}"
    assert users({"PATH": f"/usr/bin:{BIN}"})["PATH"] == f"/usr/bin:{BIN}"


def test_the_code_does_in_a_shell_what_it_says() -> None:
    code = shell.code({"ROS_DOMAIN_ID": "5", "STRANGE": "a 'b' \"c\" $HOME `d`", "SAME": "x"}, {"SAME": "x"})
    assert sourced(code, 'echo "$STRANGE|$ROS_DOMAIN_ID|$SAME"', SAME="x") == "a 'b' \"c\" $HOME `d`|5|x\n"
    assert "SAME" not in code
    assert "_python_argcomplete ros2" in sourced(code, "complete -p ros2")


def test_the_completion_of_a_sourced_ros_2_is_left_alone() -> None:
    code = "complete -F theirs ros2\n" + shell.code({"ROS_DOMAIN_ID": "5"}, {})
    assert sourced(code, "complete -p ros2") == "complete -F theirs ros2\n"
    assert "_python_argcomplete rqt_graph" in sourced(code, "complete -p rqt_graph")


def test_with_a_sourced_ros_2_our_rqt_graph_reads_the_options_first(tmp_path: Path) -> None:
    (tmp_path / "rqt_graph").write_text("#!/bin/sh\necho real\n")
    (tmp_path / "rqt_graph").chmod(0o755)
    for of_a_sourced_one, shown in [(False, "real\n"), (True, "usage: rqt_graph ")]:
        code = shell.code({"ROS_DOMAIN_ID": "5"}, {}, sourced=of_a_sourced_one)
        printed = sourced(code, "rqt_graph --text --help", PATH=f"{tmp_path}:/usr/bin:/bin")
        assert printed.startswith(shown)


def test_the_code_is_read_by_a_plain_sh() -> None:
    code = shell.code({"ROS_DOMAIN_ID": "5"}, {})
    done = subprocess.run(["sh", "-euc", f"{code}\necho $ROS_DOMAIN_ID"], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("5\n", "")


def test_an_error_reaches_whoever_sources_it() -> None:
    done = subprocess.run(
        ["bash", "-c", f"source <({BIN}/grader env --domain 500) || echo not sourced"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout == "not sourced\n"
    assert done.stderr.startswith("grader: --domain takes a whole number")


@pytest.mark.parametrize(("domain", "used"), [("150", "150"), ("", "0")])
def test_a_shell_keeps_every_domain_that_the_user_may_have_set(domain: str, used: str, tmp_path: Path) -> None:
    env = {**SOURCED_ENV, "PATH": f"{BIN}:{PATH}", "HOME": str(tmp_path), "SHELL": "/bin/bash", "ROS_DOMAIN_ID": domain}
    env["XDG_CACHE_HOME"] = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    underlay.ensure(HERE)
    (tmp_path / ".bashrc").write_text("export ROS_DOMAIN_ID=3\n")
    typed = 'echo "domain ${ROS_DOMAIN_ID:-0}"\nexit\n'
    done = subprocess.run(["grader", "shell"], env=env, input=typed, capture_output=True, text=True, check=False)
    assert f"domain {used}\n" in done.stdout
    assert "--domain" not in done.stderr


@pytest.mark.parametrize("name", ["bash", "zsh"])
def test_what_grader_env_prints_is_understood(tmp_path: Path, name: str) -> None:
    if shutil.which(name) is None:
        give_up(name, name)
    env = {**SOURCED_ENV, "PATH": f"{BIN}:{PATH}", "HOME": str(tmp_path)}
    env["XDG_CACHE_HOME"] = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    underlay.ensure(HERE)  # without this, the output would contain the progress of the build
    what = "source <(grader env --domain 57) && echo $ROS_DISTRO $ROS_DOMAIN_ID"
    done = subprocess.run([name, "-c", what], cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
    used = f"Using the ROS 2 that is sourced in this terminal: {HERE.prefix} (ROS domain 57, "
    assert done.stdout == "jazzy 57\n"
    assert done.stderr.startswith(used) if SOURCED_ENV else done.stderr == ""


@pytest.mark.parametrize("name", ["bash", "zsh"])
def test_one_line_from_any_folder_brings_ros_2_and_our_commands(tmp_path: Path, name: str) -> None:
    if shutil.which(name) is None:
        give_up(name, name)
    env = {**SOURCED_ENV, "PATH": PATH, "HOME": str(tmp_path)}
    env["XDG_CACHE_HOME"] = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    env["PYTHONHOME"] = "/usr"  # with this, no command of .venv would start
    env["_PYTHON_SYSCONFIGDATA_NAME"] = "_of_conda"  # with this, colcon would fail
    python = "python3 -c 'import sysconfig; print(len(sysconfig.get_config_vars()) > 0)'"
    what = f"source {sys.prefix}/setup.{name} && echo $ROS_DISTRO && command -v ros2 grader && {python}"
    done = subprocess.run([name, "-c", what], cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
    ros2 = f"{HERE.prefix}/bin/ros2" if REAL_ROS2 else f"{BIN}/ros2"
    assert done.stdout.splitlines() == ["jazzy", ros2, f"{BIN}/grader", "True"], done.stderr


def test_the_words_of_grader_are_completed() -> None:
    code = shell.code(users({}))
    requested = "COMP_WORDS=(grader sta); COMP_CWORD=1; _grader_completion grader grader; echo ${COMPREPLY[@]}"
    assert set(sourced(code, requested, PATH=f"{BIN}:/usr/bin:/bin").split()) == {"start", "status"}


def test_a_set_up_for_a_sourced_ros_2_names_it_where_it_is_not_sourced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "course-setup.json").write_text('{"ros": "/opt/ros/jazzy"}')
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    with pytest.raises(MachineError, match="Type: source /opt/ros/jazzy/setup"):
        installation.find_ros({})
