from __future__ import annotations

import json
import os
import pwd
import subprocess
import sys
from pathlib import Path

import pytest

from grader.common.interpreter import interpreter
from grader.common.own_process import require_own_environment
from grader.errors import MachineError

PREPARED = "from grader.common.own_process import prepare; prepare(); "


def prepared(code: str, **changed: str | None) -> str:
    """Return what the code prints after `prepare`, with these variables changed (None: unset)."""
    env = {name: value for name, value in {**os.environ, **changed}.items() if value is not None}
    start = interpreter("-c", PREPARED + code, env=env, searches=True)
    return subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=True).stdout.strip()


@pytest.mark.parametrize("home", [None, "", "here"])
def test_every_program_finds_a_home(home: str | None) -> None:
    own = pwd.getpwuid(os.getuid()).pw_dir
    assert prepared("import os; print(os.path.expanduser('~/x'))", HOME=home) == str(Path(own, "x"))


def test_a_home_that_is_set_stays_unchanged() -> None:
    assert prepared("import os; print(os.environ['HOME'])", HOME="/else where") == "/else where"


def test_a_warning_is_not_an_error() -> None:
    assert prepared("import warnings; warnings.warn('old'); print('done')", PYTHONWARNINGS="error") == "done"


@pytest.mark.parametrize(("mask", "after"), [(0o777, 0o077), (0o022, 0o022), (0, 0)])
def test_the_grader_can_read_what_it_writes(mask: int, after: int) -> None:
    before = os.umask(mask)
    try:
        assert int(prepared("import os; print(os.umask(0))")) == after
    finally:
        os.umask(before)


@pytest.mark.parametrize("columns", ["0", "000"])
def test_columns_without_a_width_are_the_terminals(columns: str) -> None:
    assert prepared("import os; print(os.environ.get('COLUMNS'))", COLUMNS=columns) == "None"


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
