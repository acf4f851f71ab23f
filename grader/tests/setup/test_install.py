from __future__ import annotations

import re
import signal
import subprocess
import sys
import sysconfig
from importlib import metadata
from pathlib import Path

import pytest

from grader.errors import MachineError
from grader.setup import install, lock
from grader.setup.bootstrap import PARTS


class Installers:
    """Records the requests to the installers instead of running them."""

    def __init__(self) -> None:
        self.pip: list[str] = []
        self.uv: list[str] = []
        self.failed: dict[str, str] = {}
        """The output of an installer that fails, by its name."""

    def run(self, command: list[str], _: dict[str, str]) -> install.Ran:
        if "--editable" in command:
            return install.Ran(0, [], "")
        assert {"--no-deps", "--require-hashes", "--no-build-isolation"} <= set(command)
        requirements = Path(command[command.index("-r") + 1]).read_text(encoding="utf-8")
        name = "uv" if command[0].endswith("/uv") else "pip"
        (self.uv if name == "uv" else self.pip).append(requirements)
        said = self.failed.get(name, "")
        return install.Ran(1 if said else 0, ["Prepared 3 packages in 4s"], said)


@pytest.fixture
def installers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Installers:
    installers = Installers()
    monkeypatch.setattr(install, "STAMP", tmp_path / "stamp.json")
    monkeypatch.setattr(install, "_run", installers.run)
    # Without this, the files of the .venv that runs the tests would be replaced.
    monkeypatch.setattr("site.getsitepackages", lambda: [str(tmp_path)])
    return installers


def names(requirements: str) -> set[str]:
    return {entry.name for entry in lock.parse("# part: x\n" + requirements)["x"]}


def test_pip_installs_the_installer_and_uv_the_rest(installers: Installers) -> None:
    seconds = install.install(PARTS["learner"], sourced=False)
    assert [names(text) for text in installers.pip] == [{"uv", "setuptools"}]
    assert {"hatchling", "numpy", "ros-rclpy"} <= names(installers.uv[0])
    assert not {"nbgrader", "mypy"} & names(installers.uv[0])
    assert seconds["download"] == 4.0


def test_tests_install_everything(installers: Installers) -> None:
    install.install(PARTS["tests"], sourced=False)
    text = lock.LOCK_FILE.read_text(encoding="utf-8")
    assert names(installers.uv[0]) == {entry.name for part in lock.parse(text).values() for entry in part}


@pytest.mark.parametrize("parts", PARTS.values(), ids=list(PARTS))
def test_a_sourced_ros_keeps_its_own_packages(installers: Installers, parts: list[str]) -> None:
    install.install(parts, sourced=True)
    installed = names(installers.uv[0])
    assert {name for name in installed if name.startswith("ros-")} == set()
    assert not {"numpy", "empy", "lark-parser"} & installed
    assert {"colcon-core", "rosbags", "matplotlib"} <= installed


@pytest.mark.parametrize(
    ("version", "added"), [("1.21.5", True), ("1.24.2", True), ("1.26.4", False), ("2.2.4", False)]
)
def test_a_numpy_that_is_too_old_for_the_images_is_replaced_in_the_environment(
    installers: Installers, monkeypatch: pytest.MonkeyPatch, version: str, *, added: bool
) -> None:
    monkeypatch.setattr(metadata, "version", lambda _: version)
    install.install(PARTS["learner"], sourced=True)
    assert ("numpy==1.26.4 " in installers.uv[0]) is added
    install.install(PARTS["learner"], sourced=False)
    assert "numpy==1.26.4" not in installers.uv[-1], "the wheels of ROS 2 use the numpy of the lock file"


def test_a_sourced_ros_gets_a_pytest_that_can_load_its_plugins(installers: Installers) -> None:
    install.install(PARTS["learner"], sourced=True)
    install.install(PARTS["learner"], sourced=False)
    chosen = [re.findall(r"^pytest==(\d+)", text, re.MULTILINE) for text in installers.uv]
    assert chosen == [["8"], ["9"]]


def test_a_numpy_that_only_the_ros_itself_can_import_is_none_of_the_graders(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> str:
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "version", missing)
    assert install.numpy_is_missing()


def test_pip_installs_what_uv_could_not(installers: Installers) -> None:
    installers.failed["uv"] = "error: invalid peer certificate\n"
    install.install(PARTS["learner"], sourced=False)
    assert installers.pip[1] == installers.uv[0]


@pytest.mark.parametrize("failed", ["Retrying: [Errno 111] Connection refused\n", "ERROR: No matching distribution\n"])
def test_an_index_that_pip_was_configured_to_use_is_named(installers: Installers, failed: str) -> None:
    installers.failed["pip"] = f"Looking in indexes: http://127.0.0.1:9/simple\n{failed}"
    with pytest.raises(MachineError, match=r"configured to use http://127\.0\.0\.1:9/simple \(`pip config list`\)\.$"):
        install.install(PARTS["learner"], sourced=False)


def test_without_a_network_it_is_the_machine(installers: Installers, capfd: pytest.CaptureFixture[str]) -> None:
    installers.failed["pip"] = "WARNING: Retrying: [Errno -3] Temporary failure in name resolution\nERROR: none\n"
    with pytest.raises(MachineError, match=r"\(Temporary failure in name resolution\)\. Is it online\? HTTPS_PROXY"):
        install.install(PARTS["learner"], sourced=False)
    assert "ERROR" not in capfd.readouterr().out


def test_what_a_machine_has_no_room_for_pip_is_not_requested(installers: Installers) -> None:
    installers.failed["uv"] = "error: Failed\n  cause: failed to copy file: No space left on device (os error 28)\n"
    with pytest.raises(MachineError, match=r"^The disk is full for .*: free some space there"):
        install.install(PARTS["learner"], sourced=False)
    assert len(installers.pip) == 1


def test_what_is_not_understood_is_repeated(installers: Installers, capfd: pytest.CaptureFixture[str]) -> None:
    installers.failed["pip"] = "ERROR: THESE PACKAGES DO NOT MATCH THE HASHES\n"
    with pytest.raises(MachineError, match="the installer's messages are above"):
        install.install(PARTS["learner"], sourced=False)
    assert "DO NOT MATCH THE HASHES" in capfd.readouterr().out


def test_a_name_that_is_not_found_twice_ends_the_installer() -> None:
    line = "print('WARNING: Retrying after: [Errno -3] Temporary failure in name resolution', flush=True)"
    done = install._run([sys.executable, "-c", f"{line}\n{line}\nimport time\nwhile True: time.sleep(1)"], {})
    assert done.code == -signal.SIGTERM


def test_progress_is_shown_and_the_rest_is_kept(capfd: pytest.CaptureFixture[str]) -> None:
    talk = "print('  Downloading numpy (from -r x)'); print('noise'); print('Prepared 3 packages in 2s')"
    done = install._run([sys.executable, "-c", talk], {})
    assert done == (0, ["Downloading numpy", "Prepared 3 packages in 2s"], "noise\n")
    assert capfd.readouterr().out == "  Downloading numpy\n  Prepared 3 packages in 2s\n"
    assert install._run([sys.executable, "-c", talk + "; raise SystemExit(7)"], {}).code == 7


@pytest.mark.parametrize(
    ("line", "seconds"),
    [
        ("Prepared 9 packages in 302ms", 0.302),
        ("Prepared 9 packages in 5.66s", 5.66),
        ("Prepared 156 packages in 1m 05s", 65.0),
        ("Prepared 156 packages in 1h 02m 03s", 3723.0),
        ("Prepared no packages", 0.0),
        ("", 0.0),
    ],
)
def test_reads_uvs_durations(line: str, seconds: float) -> None:
    assert install.seconds_of(line) == pytest.approx(seconds)


@pytest.mark.usefixtures("installers")
def test_the_path_of_the_course_is_rewritten_without_a_change_of_the_installers_cache(tmp_path: Path) -> None:
    line = f"{tmp_path}/Köln\n"
    cached, path = tmp_path / "cache", tmp_path / "_editable_impl_ros2_topics_course.pth"
    cached.write_text(line, "utf-8")
    path.hardlink_to(cached)
    install.install(PARTS["learner"], sourced=False)
    assert path.read_text("ascii") == install.ascii_only(line)
    assert cached.read_text("utf-8") == line
    assert [each.name for each in tmp_path.glob("_editable*")] == [path.name]


@pytest.mark.usefixtures("installers")
def test_the_tests_do_not_install_into_their_own_environment() -> None:
    # A sourced ROS 2 has a site-packages folder of its own on sys.path.
    path = Path(sysconfig.get_path("purelib"))
    before = {file: (file.stat().st_ino, file.stat().st_mtime_ns) for file in path.glob("*.pth")}
    install.install(PARTS["learner"], sourced=False)
    assert before
    assert {file: (file.stat().st_ino, file.stat().st_mtime_ns) for file in path.glob("*.pth")} == before


@pytest.mark.parametrize("name", ["plain", "O'Brien in Köln"])
def test_a_course_in_any_folder_is_found_in_every_locale(tmp_path: Path, name: str) -> None:
    packages = tmp_path / name
    packages.mkdir()
    (packages / "course.pth").write_text(install.ascii_only(str(packages)), "ascii")
    code = f"import site, sys; site.addpackage({str(packages)!a}, 'course.pth', set()); print(ascii(sys.path[-1]))"
    env = {"LC_ALL": "C"}
    said = subprocess.run([sys.executable, "-I", "-c", code], env=env, capture_output=True, text=True, check=False)
    assert said.stdout == f"{str(packages)!a}\n", said.stderr


@pytest.mark.parametrize(("env", "imported"), [({}, True), ({"_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}, False)])
def test_the_bootstrapper_of_the_wheels_is_imported_only_if_it_has_not_run(
    tmp_path: Path, env: dict[str, str], *, imported: bool
) -> None:
    cached, folder = tmp_path / "cache.pth", tmp_path / "site-packages"
    folder.mkdir()
    cached.write_text("import ros_wheels_bootstrapper\n")
    (folder / "ros_wheels_bootstrapper.pth").hardlink_to(cached)
    (folder / "ros_wheels_bootstrapper.py").write_text("print('imported')\n")
    install.start_fast(folder)
    assert cached.read_text() == "import ros_wheels_bootstrapper\n"
    code = f"import site; site.addsitedir({str(folder)!r})"
    said = subprocess.run(
        [sys.executable, "-I", "-S", "-c", code], env=env, capture_output=True, text=True, check=False
    )
    assert said.stdout == "imported\n" * imported, said.stderr
