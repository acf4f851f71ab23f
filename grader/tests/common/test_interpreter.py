from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from grader.common.interpreter import clean, interpreter
from grader.tests.both_worlds import SOURCED_ENV

GRADER = Path(__file__).parents[2]
COMMAND = Path(sys.prefix, "bin")
SHOW = (
    "import sys, os, json, encodings; print(json.__file__, sys.argv[1:], sys.path.count(os.getcwd()), '' in sys.path)"
)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Change to a folder whose modules print a line when they are imported. Return another folder with a package."""
    (tmp_path / "other" / "module_of_ours").mkdir(parents=True)
    (tmp_path / "other" / "module_of_ours" / "__init__.py").touch()
    (tmp_path / "other" / "module_of_ours" / "show.py").write_text(SHOW)
    (tmp_path / "here").mkdir()
    for name in ("json", "encodings", "runpy", "sitecustomize", "usercustomize", "module_of_ours"):
        (tmp_path / "here" / f"{name}.py").write_text(f"print('TRAP {name}')\n")
    monkeypatch.chdir(tmp_path / "here")
    return tmp_path / "other"


def ran(*arguments: str, env: dict[str, str], searches: bool = False, root: Path | None = None) -> str:
    start = interpreter(*arguments, env=env, searches=searches, root=root)
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("searched", ["", ".", ":", "here", "..:", "/nowhere::../here"])
@pytest.mark.parametrize("form", ["code", "module", "module of a folder", "script", "isolated code"])
def test_nothing_is_imported_from_the_current_folder(folder: Path, form: str, searched: str) -> None:
    env = {"PYTHONPATH": f"{searched}:{folder}:", "PYTHONHOME": "here", "PYTHONUSERBASE": "."}
    script = str(folder / "module_of_ours" / "show.py")
    said = {
        "code": lambda: ran("-c", SHOW, "one", "two", env=env, searches=True),
        "module": lambda: ran("-m", "module_of_ours.show", "one", "two", env=env, searches=True),
        "module of a folder": lambda: ran("-m", "module_of_ours.show", "one", "two", env=env, root=folder),
        "script": lambda: ran(script, "one", "two", env=env, searches=True),
        "isolated code": lambda: ran("-c", SHOW, "one", "two", env=env),
    }[form]()
    assert said.endswith("json/__init__.py ['one', 'two'] 0 False\n")
    assert "TRAP" not in said


def test_an_isolated_interpreter_has_nothing_of_pythonpath(folder: Path) -> None:
    with pytest.raises(AssertionError, match="No module named"):
        ran("-m", "module_of_ours.show", env={"PYTHONPATH": str(folder)})


def test_a_script_is_named_by_its_absolute_path() -> None:
    with pytest.raises(ValueError, match="absolute path"):
        interpreter("script.py")


def test_only_entries_that_lead_to_the_current_folder_are_removed() -> None:
    env = {
        "PATH": ":/usr/bin:.:bin",
        "PYTHONPATH": ":",
        "LD_LIBRARY_PATH": "/a:/b",
        "PYTHONSTARTUP": "x.py",
        "LANG": "C",
    }
    assert clean(env) == {"PATH": "/usr/bin", "LD_LIBRARY_PATH": "/a:/b", "LANG": "C"}


def test_variables_that_describe_another_python_are_removed() -> None:
    """As the compilers of conda set them."""
    env = {**os.environ, "_PYTHON_SYSCONFIGDATA_NAME": "_sysconfigdata_x86_64_conda_cos6_linux_gnu"}
    code = "import sysconfig; print(sysconfig.get_config_var('EXT_SUFFIX') is not None)"
    asking = interpreter("-c", code, env=env)
    assert subprocess.check_output(asking.argv, env=asking.env, text=True) == "True\n"


COMMANDS = ("grader", "ros2", "rqt", "rqt_console", "rqt_graph", "rqt_plot")


@pytest.mark.parametrize("name", COMMANDS)
def test_our_commands_import_nothing_from_the_current_folder(folder: Path, name: str) -> None:
    (folder.parent / "here" / "grader.py").write_text("print('TRAP grader')\n")
    listed = {"PYTHONPATH": f":{folder}:x y", "PYTHONHOME": "here", "LD_LIBRARY_PATH": ":", "PYTHONIOENCODING": "ascii"}
    listed["PYTHONINSPECT"] = "1"
    # with another home folder, `ros2` would build the turtlesim interfaces there
    cache = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    env = {**SOURCED_ENV, "PATH": ":/usr/bin:/bin", "HOME": str(folder), "XDG_CACHE_HOME": cache, **listed}
    if SOURCED_ENV:
        env["PYTHONPATH"] += f":{SOURCED_ENV['PYTHONPATH']}"
        env["LD_LIBRARY_PATH"] += f":{SOURCED_ENV['LD_LIBRARY_PATH']}"
    done = subprocess.run([COMMAND / name, "--help"], env=env, input="", capture_output=True, text=True, check=False)
    assert (done.returncode, "TRAP" in done.stdout + done.stderr, "Traceback" in done.stderr) == (0, False, False)


def test_our_commands_are_installed_as_they_are_and_differ_in_what_they_call() -> None:
    texts = [(GRADER / "setup/commands" / name).read_text("utf-8") for name in COMMANDS]
    assert [(COMMAND / name).read_text("utf-8") for name in COMMANDS] == texts
    starts = {name: text.partition("\nimport ")[0].splitlines() for name, text in zip(COMMANDS, texts, strict=True)}
    own = [line for line in starts["grader"] if "BOOTSTRAP" in line or "start each Python" in line]
    assert len(own) == 2
    common = [line for line in starts["grader"] if line not in own]
    assert all(lines == common for name, lines in starts.items() if name != "grader")
