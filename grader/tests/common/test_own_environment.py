"""A .venv that was copied together with the folder of the course is refused."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from grader.common.interpreter import interpreter
from grader.common.own_environment import require_own_environment
from grader.errors import MachineError

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize("root", ["", "old", "removed", None])
def test_only_an_environment_that_was_copied_with_the_course_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, root: str | None
) -> None:
    (tmp_path / "a copy/.venv").mkdir(parents=True)
    (tmp_path / "old").mkdir()
    (tmp_path / "link").symlink_to("a copy")
    if root is not None:
        made = {"root": str(tmp_path / (root or "a copy"))}
        (tmp_path / "a copy/.venv/course-setup.json").write_text(json.dumps(made))
    for here in ("a copy", "link"):
        monkeypatch.setattr(sys, "prefix", str(tmp_path / here / ".venv"))
        if root == "old":
            again = f"was copied from {tmp_path / 'old'}, .* cd '?{tmp_path / here}'? && make demo"
            with pytest.raises(MachineError, match=again):
                require_own_environment()
        else:
            require_own_environment()


def test_the_commands_of_a_copied_course_name_the_command_that_sets_it_up(tmp_path: Path) -> None:
    (tmp_path / "copy/.venv").mkdir(parents=True)
    (tmp_path / "copy/.venv/course-setup.json").write_text(json.dumps({"root": str(tmp_path)}))
    code = (
        "import sys; from grader import cli; "
        f"sys.prefix = {str(tmp_path / 'copy/.venv')!r}; sys.argv = ['grader', 'env']; cli.main()"
    )
    start = interpreter("-c", code, searches=True)
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (3, "")
    assert f"Set up the course again: cd {tmp_path / 'copy'} && make demo" in " ".join(done.stderr.split())
