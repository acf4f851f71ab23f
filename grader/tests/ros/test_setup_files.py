"""setup.bash and setup.zsh in the wrong shell, run as programs, or sourced in a shell with unusual settings."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

import grader.ros

FOLDER = Path(grader.ros.__file__).parent


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("sh setup.bash", "this shell is not bash. In zsh, source setup.zsh"),
        ("sh -c '. ./setup.bash || exit 1'", "In another shell, type bash first."),
        ("bash setup.bash", "so this terminal is as it was before. Type: source setup.bash"),
        ("zsh -c '. ./setup.bash || exit 1'", "this shell is not bash. In zsh, source setup.zsh"),
        ("sh setup.zsh", "this shell is not zsh. In bash, source setup.bash"),
        ("bash -c '. ./setup.zsh || exit 1'", "this shell is not zsh. In bash, source setup.bash"),
        ("zsh setup.zsh", "so this terminal is as it was before. Type: source setup.zsh"),
    ],
)
def test_the_wrong_use_is_one_sentence_with_the_right_one(line: str, said: str) -> None:
    if shutil.which(line.split()[0]) is None:
        pytest.skip("zsh is not installed")
    done = subprocess.run(["sh", "-c", line], cwd=FOLDER, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (1, "", 1)
    assert said in done.stderr


@pytest.mark.parametrize("shell", ["bash", "zsh"])
def test_the_line_to_type_works_as_it_stands_if_the_path_has_spaces_and_quotes(shell: str, tmp_path: Path) -> None:
    if shutil.which(shell) is None:
        pytest.skip("zsh is not installed")
    folder = tmp_path / "Mein Kürs, it's $HOME"
    (folder / "bin").mkdir(parents=True)
    (folder / "bin/grader").write_text("#!/bin/sh\necho echo sourced\n")
    (folder / "bin/grader").chmod(0o755)
    setup = shutil.copy(FOLDER / f"setup.{shell}", folder)
    done = subprocess.run([shell, setup], capture_output=True, text=True, check=False)
    line = done.stderr.rstrip("\n").partition("Type: ")[2]
    typed = subprocess.run([shell, "-c", line], capture_output=True, text=True, check=False)
    assert (typed.stdout, typed.stderr) == ("sourced\n", "")


SETTINGS = {
    "nothing": ":",
    "exits at errors": "set -eu",
    "no patterns": "set -f",
    "separates by colons": "IFS=:",
    "a cd that does something else": "cd() { echo changed; }",
    "a CDPATH": "export CDPATH=/:/usr",
    "a pwd that does something else": "alias pwd='echo here'",
}


@pytest.mark.parametrize("shell", ["bash", "zsh"])
@pytest.mark.parametrize("setting", SETTINGS.values(), ids=SETTINGS)
def test_settings_of_the_shell_do_not_matter(shell: str, setting: str, tmp_path: Path) -> None:
    if shutil.which(shell) is None:
        pytest.skip("zsh is not installed")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/grader").write_text("#!/bin/sh\necho echo sourced\n")
    (tmp_path / "bin/grader").chmod(0o755)
    shutil.copy(FOLDER / f"setup.{shell}", tmp_path)
    (elsewhere := tmp_path / "elsewhere").mkdir()
    lines = f"{setting}\nsource ../setup.{shell}\n"
    done = subprocess.run([shell, "-s"], input=lines, cwd=elsewhere, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "sourced\n", "")


@pytest.mark.parametrize("shell", ["bash", "zsh"])
def test_a_command_that_the_system_does_not_run_is_explained(shell: str, tmp_path: Path) -> None:
    """A file without the permission to run stands for a file system that is mounted with the option noexec."""
    if shutil.which(shell) is None:
        pytest.skip("zsh is not installed")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/grader").touch(mode=0o644)
    setup = shutil.copy(FOLDER / f"setup.{shell}", tmp_path)
    done = subprocess.run([shell, "-c", f". {setup}"], capture_output=True, text=True, check=False)
    assert "To see the reason, type make demo in the folder of the course." in done.stderr
