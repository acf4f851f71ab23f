"""The configuration of the development container, tested without starting one."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from grader.setup.machine import missing_tools

ROOT = Path(__file__).resolve().parents[3]
FILE = ROOT / ".devcontainer/devcontainer.json"
RIGHTS = ("seccomp=unconfined", "apparmor=unconfined", "systempaths=unconfined")


@pytest.fixture
def container() -> dict[str, Any]:
    described: dict[str, Any] = json.loads(FILE.read_text("utf-8"))
    return described


def test_it_installs_every_program_that_the_set_up_looks_for(
    container: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("grader.setup.machine.SYSTEM_PATH", ())
    installed = container["onCreateCommand"].partition(" install ")[2].split()
    needed = {need.package for need in missing_tools("", None)}
    assert {"bubblewrap", "cmake", "g++", "make"} <= needed
    assert needed <= set(installed)
    assert {"python3", "python3-dev", "python3-venv"} <= set(installed)


def test_it_ends_with_a_target_of_make(container: dict[str, Any]) -> None:
    target = container["postCreateCommand"].removeprefix("make ")
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)


def test_its_user_may_make_cells_and_is_not_root(container: dict[str, Any]) -> None:
    assert tuple(container["securityOpt"]) == RIGHTS
    assert container["remoteUser"] != "root"
    assert "privileged" not in container
    reported = (ROOT / "docs/security.md").read_text("utf-8")
    assert [right for right in RIGHTS if f"--security-opt {right}" not in " ".join(reported.split())] == []


def test_it_runs_on_the_only_machine_that_has_wheels_of_ros_2(container: dict[str, Any]) -> None:
    assert "--platform=linux/amd64" in container["runArgs"]


def test_grader_is_found_in_its_terminals(container: dict[str, Any]) -> None:
    first = container["remoteEnv"]["PATH"].split(":")[0]
    assert first == "${containerWorkspaceFolder}/.venv/bin"
