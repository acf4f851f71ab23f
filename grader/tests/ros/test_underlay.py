"""The turtlesim interfaces are built once and completely, or not at all.

Finding the built interfaces starts no process.
"""

from __future__ import annotations

import errno
import os
import shutil
import stat
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.errors import MachineError
from grader.ros import installation, underlay
from grader.tests.both_worlds import of_a_sourced_ros
from grader.tests.pretended import mounted_noexec
from grader.tests.traps import Traps, careless

if TYPE_CHECKING:
    from collections.abc import Sequence

INDEX = "share/ament_index/resource_index/packages"


@pytest.fixture
def ros(monkeypatch: pytest.MonkeyPatch) -> installation.Ros:
    """Return a ROS 2 without turtlesim, so that the interfaces must be built, even if the sourced ROS 2 has it."""
    found, has_turtlesim = installation.find_ros(), installation.has_turtlesim
    monkeypatch.setattr(
        installation, "has_turtlesim", lambda ros: ros.prefixes != found.prefixes and has_turtlesim(ros)
    )
    return found


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "grader"


@pytest.fixture
def builds(monkeypatch: pytest.MonkeyPatch) -> list[Sequence[str]]:
    """Replace cmake. Return the list of commands that were run. The install command creates one file."""
    ran: list[Sequence[str]] = []

    def run(command: Sequence[str], env: dict[str, str], _: object) -> None:
        ran.append(command)
        if command[1] == "--install":
            words = [word for words in ran for word in words if word.startswith("-DCMAKE_INSTALL_PREFIX=")]
            prefix = words[-1].partition("=")[2]
            made = Path(env["DESTDIR"] + prefix, "lib", "made")
            made.parent.mkdir(parents=True)
            made.touch(mode=0o600)

    monkeypatch.setattr(underlay, "_run", run)
    return ran


def without(monkeypatch: pytest.MonkeyPatch, *programs: str) -> None:
    found = shutil.which
    monkeypatch.setattr(shutil, "which", lambda name, path=None: None if name in programs else found(name, path=path))


@pytest.mark.parametrize("home", ["home of Zoë", "O'Brien"])
def test_cmake_gets_no_path_that_it_would_cut(
    ros: installation.Ros, builds: list[Sequence[str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, home: str
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / home))
    prefix = underlay.ensure(ros)
    assert prefix is not None
    assert (prefix / "lib/made").is_file()
    folders = [command[command.index("-B") + 1] for command in builds if "-B" in command]
    assert [folder for folder in folders if home in folder] == []
    assert len(folders) == 1


def test_a_build_on_another_disk_is_copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    staged, prefix = tmp_path / "staged", tmp_path / "turtlesim-1"
    (staged / "lib").mkdir(parents=True)
    (staged / "lib/made").touch()
    rename = Path.rename

    def on_one_disk(self: Path, to: Path) -> Path:
        if self == staged:
            raise OSError(errno.EXDEV, "Invalid cross-device link")
        return rename(self, to)

    monkeypatch.setattr(Path, "rename", on_one_disk)
    underlay._move(staged, prefix)
    assert (prefix / "lib/made").is_file()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["staged", "turtlesim-1"]


@of_a_sourced_ros
def test_ros_2_is_found_with_each_name_of_the_interpreter() -> None:
    code = "from grader.ros.installation import find_ros; print(find_ros().python)"
    names = [str(Path(sys.executable).with_name(name)) for name in ("python", "python3")]
    said = {subprocess.check_output([name, "-I", "-c", code], text=True) for name in names}
    assert said == {f"{names[1]}\n"}


@pytest.mark.exhaustive
def test_two_processes_build_the_underlay_only_once(ros: installation.Ros, tmp_path: Path) -> None:
    """The current folder contains false modules and programs with familiar names, which the build must not use."""
    traps = Traps(tmp_path / "current", tmp_path / "touched")
    code = "from grader.ros import installation, underlay; print(underlay.ensure(installation.find_ros(), print))"
    env = {**careless(), "XDG_CACHE_HOME": str(tmp_path / "home of Zoë O'Brien")}
    command = [sys.executable, "-I", "-c", code]
    both = [subprocess.Popen(command, cwd=traps.folder, env=env, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    lines = [process.communicate()[0].splitlines() for process in both]
    assert traps.touched == []
    prefixes = {Path(reported[-1]) for reported in lines}
    assert len(prefixes) == 1
    prefix = prefixes.pop()
    assert sum("once; this takes" in line for reported in lines for line in reported) == 1
    assert (prefix / INDEX / "turtlesim").is_file()
    assert sorted(path.name for path in prefix.parent.iterdir()) == [prefix.name, "turtlesim.lock"]

    traces = [path for path in prefix.rglob("*") if path.is_file() and b"/.building-" in path.read_bytes()]
    assert traces == []

    # The folder is usable where it is, and other users can read it.
    closed = [path for path in prefix.rglob("*") if not path.stat().st_mode & stat.S_IROTH]
    assert closed == []
    script = "from turtlesim.srv import Spawn; print(Spawn.Request(x=1.0).x)"
    done = subprocess.run(
        [ros.python, "-c", script],
        env=installation.environment(replace(ros, underlay=prefix), home=tmp_path),
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.stdout, done.stderr) == ("1.0\n", "")


def test_what_is_built_is_found_without_starting_a_process(
    ros: installation.Ros, cache: Path, builds: list[Sequence[str]]
) -> None:
    prefix = underlay.ensure(ros)
    assert prefix is not None
    assert prefix.parent == cache
    builds.clear()
    assert underlay.ensure(ros) == prefix
    assert builds == []


def test_other_sources_are_built_anew(
    ros: installation.Ros,
    cache: Path,  # noqa: ARG001
    builds: list[Sequence[str]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    prefix = underlay.ensure(ros)
    sources = tmp_path / "sources"
    sources.mkdir()
    monkeypatch.setattr(underlay, "SOURCES", sources)
    builds.clear()
    assert underlay.ensure(ros) != prefix
    assert builds


def test_another_ros_is_built_for_anew(ros: installation.Ros, cache: Path, builds: list[Sequence[str]]) -> None:  # noqa: ARG001
    assert underlay.ensure(ros) != underlay.ensure(replace(ros, version="7.1.999"))


def test_a_build_that_fails_leaves_nothing_and_says_why(
    ros: installation.Ros, cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sources = tmp_path / "sources"
    sources.mkdir()
    (sources / "CMakeLists.txt").write_text('cmake_minimum_required(VERSION 3.20)\nmessage(FATAL_ERROR "so it goes")\n')
    monkeypatch.setattr(underlay, "SOURCES", sources)
    with pytest.raises(MachineError, match="so it goes"):
        underlay.ensure(ros)
    assert [path.name for path in cache.iterdir()] == ["turtlesim.lock"]


def test_sources_that_are_dated_in_the_future_are_built(
    ros: installation.Ros, cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As after a clone with a clock that was set back later."""
    sources = tmp_path / "sources"
    sources.mkdir()
    file = sources / "CMakeLists.txt"
    file.write_text(
        "cmake_minimum_required(VERSION 3.20)\nproject(a NONE)\ninstall(FILES CMakeLists.txt DESTINATION lib)\n"
    )
    os.utime(file, (time.time() + 86400,) * 2)
    monkeypatch.setattr(underlay, "SOURCES", sources)
    prefix = underlay.ensure(ros)
    assert prefix is not None
    assert prefix.parent == cache
    assert (prefix / "lib/CMakeLists.txt").is_file()


def test_a_build_that_fails_on_a_full_disk_names_the_disk(
    ros: installation.Ros, cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sources = tmp_path / "sources"
    sources.mkdir()
    (sources / "CMakeLists.txt").write_text('message(FATAL_ERROR "The C compiler is broken")\n')
    monkeypatch.setattr(underlay, "SOURCES", sources)
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage._replace(free=4096))
    with pytest.raises(MachineError, match=rf"built in {cache}: No space left on device\. .* set XDG_CACHE_HOME"):
        underlay.ensure(ros)


def test_a_cache_from_which_nothing_can_be_loaded_is_named(
    ros: installation.Ros, cache: Path, builds: list[Sequence[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    underlay.ensure(ros)
    builds.clear()
    mounted_noexec(monkeypatch, cache.parent)
    with pytest.raises(MachineError, match=rf"^{cache.parent} is mounted with the option noexec.* set XDG_CACHE_HOME"):
        underlay.ensure(ros)
    assert builds == []


def test_what_a_killed_build_left_is_removed(ros: installation.Ros, cache: Path, builds: list[Sequence[str]]) -> None:  # noqa: ARG001
    left = cache / ".building-dead"
    left.mkdir(parents=True)
    underlay.ensure(ros)
    assert not left.exists()


def test_missing_tools_are_named_with_what_installs_them(
    ros: installation.Ros,
    cache: Path,  # noqa: ARG001
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    without(monkeypatch, "c++", "cmake")
    with pytest.raises(MachineError, match=r"lacks a C\+\+ compiler and cmake\. .*apt-get install -y g\+\+ cmake"):
        underlay.ensure(ros)


def test_what_was_built_before_the_compiler_went_is_still_used(
    ros: installation.Ros,
    cache: Path,  # noqa: ARG001
    builds: list[Sequence[str]],  # noqa: ARG001
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    prefix = underlay.ensure(ros)
    without(monkeypatch, "c++")
    assert underlay.ensure(ros) == prefix


def test_a_cache_that_cannot_be_written_is_the_machines_fault(
    ros: installation.Ros, cache: Path, builds: list[Sequence[str]]
) -> None:
    cache.write_text("a file where a folder should be")
    with pytest.raises(MachineError, match="XDG_CACHE_HOME"):
        underlay.ensure(ros)
    assert builds == []


def test_nothing_is_built_where_ros_has_its_own_turtlesim(
    ros: installation.Ros, tmp_path: Path, cache: Path, builds: list[Sequence[str]]
) -> None:
    (tmp_path / INDEX).mkdir(parents=True)
    (tmp_path / INDEX / "turtlesim").touch()
    assert underlay.ensure(replace(ros, prefixes=(tmp_path, *ros.prefixes))) is None
    assert builds == []
    assert not cache.exists()


def test_a_build_command_that_is_killed_has_no_negative_exit_code(tmp_path: Path) -> None:
    with pytest.raises(MachineError, match=r"`sh` was killed \(SIGKILL\)\.$"):
        underlay._run(["sh", "-c", "kill -9 $$"], {"HOME": str(tmp_path)}, lambda _: None)
