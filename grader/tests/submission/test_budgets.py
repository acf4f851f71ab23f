"""Source code that would take too much time or memory is read within a time limit, or reported as too large."""

from __future__ import annotations

import pickle
import subprocess

import pytest

from grader.common.interpreter import interpreter

READ = """
import pickle, resource, sys
resource.setrlimit(resource.RLIMIT_CPU, (20, 20))
resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
from grader.colcon.runner import read_entry_points
from grader.errors import TooLargeError
from grader.submission.code import read_code
from grader.submission.setup_py import read_setup_py
from grader.trial.clues import wall_clues
kind, files = pickle.load(sys.stdin.buffer)
try:
    if kind == "setup":
        setup = read_setup_py(files["setup.py"])
        print("read", len(setup.name or ""), len(setup.entry_points or ()), len(setup.stray))
    elif kind == "entry points":
        print("read", len(read_entry_points(files["entry_points.txt"].decode())))
    else:
        code = read_code(files, "p/node.py")
        print("read", len(code.modules), len(code.calls("sleep")), len(wall_clues(files, "p.node")))
except TooLargeError as error:
    print(error)
"""


def doubled(join: str, first: str, lines: int = 60) -> bytes:
    """Return code in which each name gets the value of the previous name, repeated several times."""
    names = [f"a{number} = {join.format(f'a{number - 1}')}" for number in range(1, lines)]
    return "\n".join([f"a0 = {first}", *reversed(names), f"setup(name=a{lines - 1})"]).encode()


def circle() -> bytes:
    return b"a = b\nb = a\nsetup(name=a, entry_points={'console_scripts': a})\n"


SETUPS = {
    "sums": doubled("{0} + {0}", "1"),
    "texts": doubled("{0} + {0}", "''"),
    "wide": doubled("f'" + "{{{0}}}" * 50 + "'", "''", 9),
    "formatted": doubled("f'" + "{{{0}}}" * 8 + "'", repr("x" * 300_000), 9),
    "joined": doubled("join({0}, {0}, {0}, {0}, {0}, {0}, {0}, {0})", repr("x" * 300_000), 9),
    "circle": circle(),
    "blanks": b"\n".join(b"'a" + b" " * 290 + b"=:'" for _ in range(1300)),
    "brackets": b"\n".join(b"'a = b:c[" + b"] " * 140 + b"x'" for _ in range(1300)),
}


def read(kind: str, files: dict[str, bytes]) -> str:
    start = interpreter("-c", READ)
    given = pickle.dumps((kind, files))
    done = subprocess.run(start.argv, env=start.env, input=given, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()[-1000:]
    return done.stdout.decode().strip()


@pytest.mark.parametrize("name", SETUPS)
def test_a_setup_py_is_read_whatever_it_says(name: str) -> None:
    assert read("setup", {"setup.py": SETUPS[name]}) == "read 0 0 0"


def test_entry_points_are_read_in_one_pass() -> None:
    line = "a" + " " * 90_000 + "b"
    text = f"[console_scripts]\n{line}\nnode = p.node:main\n# no = x:y\n[other]\nelse = x:y\n"
    assert read("entry points", {"entry_points.txt": text.encode()}) == "read 1"


IMPORTS = {
    "many": {f"p/{name}.py": b"import x\n" * 36_000 for name in ("node", "b")} | {"p/c.py": b""},
    "one another": {f"p/m{number}.py": b"from p import node\n" * 3000 for number in range(15)},
    "long": {"p/node.py": b"from " + b"x" * 100_000 + b" import " + b",".join(b"y" for _ in range(90_000))},
    "chain": {"p/node.py": b"node" + b".a().sleep" * 80 + b"\n" + b"x.sleep" + b".sleep" * 900},
}


@pytest.mark.parametrize("name", IMPORTS)
def test_imports_are_followed_in_a_bounded_time(name: str) -> None:
    files = {"p/node.py": b"from p import m0\n", **IMPORTS[name]}
    assert read("code", files).startswith("read ")


@pytest.mark.parametrize(
    ("files", "reported"),
    [
        ({"p/node.py": b"x = 1\n" * 80_000}, "p/node.py is too large to be read: more than 400 kB"),
        ({"p/node.py": b"x = " + b"-" * 100_000 + b"1"}, "p/node.py is nested too deeply to be read"),
        (
            {"p/node.py": b"import p.a, p.b, p.c", **{f"p/{name}.py": b"x = 1\n" * 60_000 for name in "abc"}},
            "its Python files are too large to be read: more than 1000 kB together",
        ),
    ],
)
def test_what_is_too_large_is_reported(files: dict[str, bytes], reported: str) -> None:
    assert read("code", files) == reported
