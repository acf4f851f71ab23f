from __future__ import annotations

import ast
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.common.package_managers import MANAGERS
from grader.ros.installation import find_ros
from grader.setup import machine
from grader.setup.machine import Python, SourcedRos

if TYPE_CHECKING:
    from collections.abc import Iterator

SYSTEMS = Python("/usr/bin/python3.11", (3, 11, 2), cpython=True, venv=True, headers=True)
APT = MANAGERS[0]
JAZZY = SourcedRos("/opt/ros/jazzy", (3, 12), turtlesim=False)


@pytest.fixture
def closed() -> Iterator[Path]:
    """Create a folder in /tmp that only its owner can access, and another folder inside that folder."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name, "home")
        (folder / "bin").mkdir(parents=True)
        Path(name).chmod(0o755)
        folder.chmod(0o700)
        yield folder


def fake_python(folder: Path, name: str, version: tuple[int, int, int], path: str | None = None) -> None:
    """Create a program that describes itself as an interpreter when the set-up runs it."""
    folder.mkdir(parents=True, exist_ok=True)
    answer = {"path": path or str(folder / name), "version": version, "cpython": True, "venv": True, "headers": True}
    (folder / name).write_text(f"#!/bin/sh\necho '{json.dumps(answer)}'\n")
    (folder / name).chmod(0o755)


def fake_ros(prefix: Path, *packages: str, python: str = "python3.12") -> None:
    for package in packages:
        index = prefix / "share/ament_index/resource_index/packages"
        index.mkdir(parents=True, exist_ok=True)
        (index / package).touch()
    (prefix / f"lib/{python}/site-packages/rclpy").mkdir(parents=True)


RUNS_FIRST = (
    *(
        "__init__.py",
        "common/__init__.py",
        "common/interpreter.py",
        "common/noexec.py",
        "common/package_managers.py",
        "common/readable_by_all.py",
        "common/system_errors.py",
        "common/terminal_text.py",
    ),
    *(
        "setup/__init__.py",
        "setup/bootstrap.py",
        "setup/compiled_modules.py",
        "setup/installers.py",
        "setup/machine.py",
        "setup/place.py",
        "setup/provide.py",
        "setup/setup_errors.py",
    ),
)


@pytest.mark.parametrize("name", RUNS_FIRST)
def test_what_runs_first_reads_under_an_old_python(name: str) -> None:
    text = (Path(machine.__file__).parents[1] / name).read_text(encoding="utf-8")
    assert too_new(ast.parse(text, feature_version=(3, 6))) == []


def too_new(tree: ast.Module) -> list[str]:
    """Return code that Python 3.6 can parse but not run: types in the syntax of later versions, and later modules."""
    found = [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    found = [name for name in found if name in ("__future__", "collections.abc", "dataclasses")]
    for node in ast.walk(tree):
        if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name):
            found += [node.value.id] if node.value.id in ("dict", "frozenset", "list", "set", "tuple", "type") else []
        if isinstance(node, (ast.arg, ast.AnnAssign)):
            found += ["|"] if isinstance(node.annotation, ast.BinOp) else []
        if isinstance(node, ast.FunctionDef):
            found += ["|"] if isinstance(node.returns, ast.BinOp) else []
    return found


@pytest.mark.parametrize(
    "line",
    [
        "def f(x: int | None): pass",
        "def f() -> int | None: pass",
        "x: list[int]",
        "from __future__ import annotations",
        "from collections.abc import Mapping",
    ],
)
def test_types_of_a_later_python_are_noticed(line: str) -> None:
    assert too_new(ast.parse(line)) != []


def test_the_bootstrap_imports_only_the_listed_modules() -> None:
    code = "import sys; from grader.setup import bootstrap; print(*(n for n in sys.modules if n.startswith('grader')))"
    root = Path(machine.__file__).parents[2]
    done = subprocess.run([sys.executable, "-S", "-c", code], cwd=root, capture_output=True, text=True, check=True)
    paths = {name.replace(".", "/") for name in done.stdout.split()}
    known = {name.replace("/__init__.py", "").replace("__init__.py", "").replace(".py", "") for name in RUNS_FIRST}
    assert {path.partition("/")[2] for path in paths} == known


# --- Python ---


def test_finds_pythons_in_the_order_of_path_then_the_newest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "SYSTEM_PATH", (str(tmp_path / "system"),))
    fake_python(tmp_path / "a", "python3", (3, 9, 1))
    fake_python(tmp_path / "a", "python3.12", (3, 12, 1))
    fake_python(tmp_path / "system", "python3", (3, 11, 2))
    fake_python(tmp_path / "system", "python3.14", (3, 14, 0))
    found = machine.find_pythons(str(tmp_path / "a"))
    assert [python.version[1] for python in found] == [9, 11, 14, 12]


def test_one_interpreter_of_two_names_is_found_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "SYSTEM_PATH", ())
    fake_python(tmp_path, "python3", (3, 12, 1), "/x/python3.12")
    fake_python(tmp_path, "python3.12", (3, 12, 1), "/x/python3.12")
    assert len(list(machine.find_pythons(str(tmp_path)))) == 1


def test_a_shim_that_only_complains_is_no_python(tmp_path: Path) -> None:
    shim = tmp_path / "python3"
    shim.write_text("#!/bin/sh\necho 'python3: command not found' >&2\nexit 127\n")
    shim.chmod(0o755)
    assert machine.probe(str(shim)) is None


def test_probe_names_the_interpreter_behind_a_virtual_environment() -> None:
    python = machine.probe(str(Path(sys.prefix, "bin/python3")))
    assert python is not None
    assert not Path(python.path).is_relative_to(sys.prefix)
    assert python.cpython


def test_takes_the_first_python_that_will_do() -> None:
    old = SYSTEMS._replace(path="/a/python3.9", version=(3, 9, 9))
    new = SYSTEMS._replace(path="/a/python3.15", version=(3, 15, 0))
    pypy = SYSTEMS._replace(path="/a/pypy", cpython=False)
    other = SYSTEMS._replace(path="/b/python3.12", version=(3, 12, 0))
    assert machine.choose_python([old, new, pypy, SYSTEMS, other], root=False) == SYSTEMS
    assert machine.choose_python([old, new, pypy], root=False) is None


def test_prefers_a_python_that_lacks_nothing() -> None:
    lacking = SYSTEMS._replace(headers=False)
    whole = SYSTEMS._replace(path="/opt/python3.12", version=(3, 12, 0))
    assert machine.choose_python([lacking, whole], root=False) == whole
    assert machine.choose_python([lacking], root=False) == lacking


def test_a_python_that_no_package_manager_can_complete_will_not_do() -> None:
    assert machine.choose_python([SYSTEMS._replace(path="/opt/python3.12", venv=False)], root=False) is None


def test_root_prefers_a_python_that_others_can_run(closed: Path) -> None:
    roots = SYSTEMS._replace(path=str(closed / "bin/python3.12"))
    assert machine.choose_python([roots, SYSTEMS], root=True) == SYSTEMS
    assert machine.choose_python([roots, SYSTEMS], root=False) == roots
    assert machine.choose_python([roots], root=True) == roots


def test_a_sourced_ros_decides_the_version() -> None:
    other = SYSTEMS._replace(path="/usr/bin/python3.12", version=(3, 12, 3))
    assert machine.choose_python([SYSTEMS, other], root=False, wanted=(3, 12)) == other
    assert machine.choose_python([SYSTEMS], root=False, wanted=(3, 12)) is None


def test_a_python_that_lacks_what_a_sourced_ros_needs_comes_last_and_only_the_systems_can_get_it() -> None:
    pyenvs = SYSTEMS._replace(path="/home/me/.pyenv/bin/python3.11", lacks=("em",))
    bare = SYSTEMS._replace(lacks=("numpy", "em"))
    assert machine.choose_python([pyenvs, SYSTEMS], root=False, wanted=(3, 11)) == SYSTEMS
    assert machine.choose_python([pyenvs, bare], root=False, wanted=(3, 11)) == bare
    assert machine.choose_python([pyenvs], root=False, wanted=(3, 11)) is None
    assert [need.package for need in machine.missing_of_python(bare)] == ["python3-numpy", "python3-empy"]


def test_a_python_that_was_refused_is_reported_with_what_it_lacks() -> None:
    pyenvs = SYSTEMS._replace(path="/home/me/.pyenv/bin/python3.11", lacks=("numpy", "em"))
    (what,) = {need.what for need in machine.missing_of_python(None, (3, 11), refused=[pyenvs])}
    assert "(/home/me/.pyenv/bin/python3.11 cannot import numpy and em)" in what
    assert "PYTHON=/path/to/python3" in what


def test_a_python_is_tried_with_the_environment_that_the_ros_needs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = SYSTEMS._replace(path=sys.executable, version=sys.version_info[:3])
    ros = SourcedRos("/opt/ros/jazzy", sys.version_info[:2], turtlesim=True)
    assert machine.for_ros(here, ros).lacks == ()
    monkeypatch.delenv("PYTHONPATH", raising=False)  # a sourced ROS 2 may have these modules in its own prefix
    (tmp_path / "python3").write_text(f'#!/bin/sh\nexec {sys.executable} -S "$@"\n')
    (tmp_path / "python3").chmod(0o755)
    bare = here._replace(path=str(tmp_path / "python3"))
    assert machine.for_ros(bare, ros).lacks == tuple(machine.LEFT_TO_ROS)
    assert machine.for_ros(bare, ros._replace(python=(3, 9))).lacks == (), "its version does not match"
    assert machine.for_ros(here._replace(path="/nowhere/python3"), ros).lacks == tuple(machine.LEFT_TO_ROS)


def test_closed_folder_is_the_topmost_one(closed: Path) -> None:
    (closed / "bin").chmod(0o700)
    assert machine.closed_folder(str(closed / "bin/python3")) == closed.resolve()
    assert machine.closed_folder("/usr/bin/python3") is None


# --- ROS 2 ---


def test_a_sourced_jazzy_is_found_with_its_python_and_turtlesim(tmp_path: Path) -> None:
    fake_ros(tmp_path / "jazzy", "rclpy", "turtlesim")
    env = {"ROS_DISTRO": "jazzy", "AMENT_PREFIX_PATH": f"{tmp_path}/mine:{tmp_path}/jazzy"}
    assert machine.sourced_ros(env, tmp_path / ".venv") == SourcedRos(f"{tmp_path}/jazzy", (3, 12), turtlesim=True)


@pytest.mark.parametrize(
    "change",
    [{"ROS_DISTRO": "humble"}, {"ROS_DISTRO": ""}, {"AMENT_PREFIX_PATH": ""}, {"AMENT_PREFIX_PATH": "/nowhere"}],
)
def test_another_or_half_a_ros_is_not_a_sourced_jazzy(tmp_path: Path, change: dict[str, str]) -> None:
    fake_ros(tmp_path, "rclpy")
    env = {"ROS_DISTRO": "jazzy", "AMENT_PREFIX_PATH": str(tmp_path), **change}
    assert machine.sourced_ros(env, tmp_path / ".venv") is None


def test_our_own_wheels_are_not_a_sourced_ros(tmp_path: Path) -> None:
    fake_ros(tmp_path, "rclpy")
    env = {"ROS_DISTRO": "jazzy", "AMENT_PREFIX_PATH": str(tmp_path)}
    assert machine.sourced_ros(env, tmp_path) is None


def test_the_environment_of_another_clone_is_not_a_sourced_ros(tmp_path: Path) -> None:
    fake_ros(tmp_path / "clone/.venv", "rclpy")
    fake_ros(tmp_path / "jazzy", "rclpy")
    env = {"ROS_DISTRO": "jazzy", "AMENT_PREFIX_PATH": f"{tmp_path}/clone/.venv:{tmp_path}/jazzy"}
    (tmp_path / "clone/.venv/course-setup.json").write_text("{}")
    (tmp_path / "jazzy/share/rclpy").mkdir(parents=True)
    (tmp_path / "jazzy/share/rclpy/package.xml").write_text("<package><version>7.1.5</version></package>")
    found = machine.sourced_ros(env, tmp_path / ".venv")
    assert found is not None
    assert found.prefix == str(tmp_path / "jazzy")
    assert find_ros(env).prefix == tmp_path / "jazzy"
    alone = {**env, "AMENT_PREFIX_PATH": f"{tmp_path}/clone/.venv"}
    assert machine.sourced_ros(alone, tmp_path / ".venv") is None


# --- the platform ---


@pytest.mark.parametrize(
    ("system", "architecture", "libc", "observed"),
    [
        ("Darwin", "arm64", ("", ""), "This is macOS on arm64."),
        ("Windows", "AMD64", ("", ""), "This is Windows on AMD64."),
        ("Linux", "aarch64", ("glibc", "2.36"), "This is Linux on aarch64."),
        ("Linux", "x86_64", ("", ""), "a C library other than glibc"),
        ("Linux", "x86_64", ("glibc", "2.17"), "a Linux with glibc 2.17."),
    ],
)
def test_other_platforms_are_reported_with_two_alternatives(
    system: str, architecture: str, libc: tuple[str, str], observed: str
) -> None:
    problem = machine.platform_problem(system, architecture, libc, None)
    assert observed in problem
    assert "docker run" in problem
    assert "source /opt/ros/jazzy/setup.bash" in problem


def test_platforms_that_will_do() -> None:
    assert machine.platform_problem("Linux", "x86_64", ("glibc", "2.28"), None) == ""
    assert machine.platform_problem("Linux", "aarch64", ("glibc", "2.39"), JAZZY) == ""
    assert machine.platform_problem("Darwin", "arm64", ("", ""), JAZZY) != ""
