from __future__ import annotations

import os
import pwd
import subprocess
from pathlib import Path

import pytest

from grader.common.interpreter import interpreter

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
