from __future__ import annotations

import sys
from pathlib import Path

import pytest

from grader.errors import MachineError
from grader.setup import install, lock
from grader.setup.bootstrap import PARTS


class Installers:
    """What the installers were asked for, instead of being run."""

    def __init__(self) -> None:
        self.pip: list[str] = []
        self.uv: list[str] = []
        self.pip_code = 0
        self.uv_works = True

    def run_pip(self, requirements: Path) -> int:
        self.pip.append(requirements.read_text(encoding="utf-8"))
        return self.pip_code

    def run_uv(self, *arguments: str) -> float | None:
        if "--editable" in arguments:
            return 0.0
        assert {"--no-deps", "--require-hashes", "--no-build-isolation"} <= set(arguments)
        self.uv.append(Path(arguments[arguments.index("-r") + 1]).read_text(encoding="utf-8"))
        return 4.0 if self.uv_works else None


@pytest.fixture
def installers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Installers:
    installers = Installers()
    monkeypatch.setattr(install, "STAMP", tmp_path / "stamp.json")
    monkeypatch.setattr(install, "_pip", installers.run_pip)
    monkeypatch.setattr(install, "_uv", installers.run_uv)
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


def test_pip_installs_what_uv_could_not(installers: Installers) -> None:
    installers.uv_works = False
    install.install(PARTS["learner"], sourced=False)
    assert installers.pip[1] == installers.uv[0]


def test_without_a_network_it_is_the_machine(installers: Installers) -> None:
    installers.pip_code = 1
    with pytest.raises(MachineError, match="online"):
        install.install(PARTS["learner"], sourced=False)


def test_progress_is_shown_and_the_rest_only_on_failure(capfd: pytest.CaptureFixture[str]) -> None:
    talk = "print('  Downloading numpy (from -r x)'); print('noise'); print('Prepared 3 packages in 2s')"
    assert install._run([sys.executable, "-c", talk], {}) == (0, ["Downloading numpy", "Prepared 3 packages in 2s"])
    assert capfd.readouterr().out == "  Downloading numpy\n  Prepared 3 packages in 2s\n"
    assert install._run([sys.executable, "-c", talk + "; raise SystemExit(7)"], {})[0] == 7
    assert capfd.readouterr().out.endswith("Prepared 3 packages in 2s\nnoise\n")


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
