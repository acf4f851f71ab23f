"""Calls of a student's function or program in a sandbox cell: a call can change only its own result."""

from __future__ import annotations

import io
import json
import math
import tarfile
from typing import TYPE_CHECKING, Any

import pytest

from grader.ros.installation import environment, find_ros
from grader.sandbox import bubblewrap
from grader.trial import calling
from grader.trial.called import MOST_TEXT, TOO_LATE, Called, called_from_json, read_called

if TYPE_CHECKING:
    from pathlib import Path

    from grader.ros.installation import Ros

PACKAGE = "my_package"
POINTS = [{"id": id_, "x": [1.0, 2.0], "y": [3.0, 4.0], "lists": False} for id_ in ("first", "second")]


@pytest.fixture(scope="module")
def ros() -> Ros:
    return find_ros()


def tree_of(ros: Ros, path: str, source: str) -> bytes:
    """Return an install tree with one file, a module or a program.

    The `path` of a module begins with "python/", and the `path` of a program begins with "lib/".
    """
    home = bubblewrap.WORKSPACE
    python = environment(ros, home=home, overlays=[home / PACKAGE])["PYTHONPATH"].split(":")[0]
    place = path.replace("python/", python.removeprefix(f"{home}/{PACKAGE}/") + f"/{PACKAGE}/")
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w|") as tar:
        member = tarfile.TarInfo(f"./{PACKAGE}/{place}")
        member.size = len(source.encode())
        tar.addfile(member, io.BytesIO(source.encode()))
    return stream.getvalue()


def called(ros: Ros, source: str) -> list[Called]:
    """Return the results of two calls of the function `f` in this module."""
    tree = tree_of(ros, "python/module.py", source)
    output = calling.make_calls(
        ros, PACKAGE, tree, POINTS, {}, function=f"{PACKAGE}.module:f", in_cell=bubblewrap.usable()
    )
    return list(read_called(output, ["first", "second"]))


def test_numbers_come_back(ros: Ros) -> None:
    first, second = called(ros, "def f(x, y):\n    print('hello')\n    return x.sum(), y.sum(), float('nan')\n")
    assert (first.ended, first.stdout, first.kind) == ("exit 0", "hello\n", "tuple")
    assert first.values is not None
    assert first.values[:2] == (3.0, 7.0)
    assert math.isnan(first.values[2])
    assert second.values is not None


def test_an_exception_comes_back_with_its_classes_and_without_our_frames(ros: Ros) -> None:
    first, second = called(ros, "class Mine(ValueError):\n    pass\n\ndef f(x, y):\n    raise Mine('no')\n")
    assert "ValueError" in first.kind.split()
    assert first.stderr.count("File ") == 1
    assert first.stderr.splitlines()[-1] == f"{PACKAGE}.module.Mine: no"
    assert second.ended == "exit 1"


def test_each_call_has_a_process_of_its_own(ros: Ros) -> None:
    source = "calls = []\n\ndef f(x, y):\n    calls.append(1)\n    return calls\n"
    assert [each.values for each in called(ros, source)] == [(1.0,), (1.0,)]


def limit_calls(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, call_s: float, waited_s: float = 0.0) -> None:
    """Limit each call to 1 s of CPU time and to this wall time (s). Each call seems to have waited for `waited_s`."""
    source = calling._SCRIPT.read_text("utf-8")
    for old, new in (
        ("FUNCTION_CPU_S = 2", "FUNCTION_CPU_S = 1"),
        ("CALL_S = 20.0", f"CALL_S = {call_s}"),
        ("        return int(Path(", f"        return {waited_s} or int(Path("),
    ):
        assert old in source
        source = source.replace(old, new)
    script = tmp_path / "cell_calls.py"
    script.write_text(source, "utf-8")
    monkeypatch.setattr(calling, "_SCRIPT", script)


def test_a_call_that_does_not_end_is_stopped_and_the_others_are_not_made(
    ros: Ros, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    limit_calls(monkeypatch, tmp_path, 3.0)
    for body in ("while True: pass", "import time; time.sleep(1000)"):
        first, second = called(ros, f"def f(x, y):\n    {body}\n")
        assert (first.ended, second.ended) == (TOO_LATE, ""), body


@pytest.mark.parametrize(
    ("waited_s", "values"), [(0.0, [None, None]), (1e6, [(1.0,), (1.0,)])], ids=["idle", "crowded"]
)
def test_the_time_for_which_a_call_waits_for_a_processor_does_not_count(
    ros: Ros, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, waited_s: float, values: list[object]
) -> None:
    limit_calls(monkeypatch, tmp_path, 0.0, waited_s)
    sleep_s = 0.2 if waited_s else 1000.0
    source = f"import time\n\ndef f(x, y):\n    time.sleep({sleep_s})\n    return (1.0,)\n"
    assert [each.values for each in called(ros, source)] == values


@pytest.mark.parametrize("action", ["signal.SIG_IGN", "lambda *_: os._exit(0)"], ids=["ignored", "handled"])
def test_a_call_cannot_hide_that_it_exceeded_its_cpu_time(
    ros: Ros, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, action: str
) -> None:
    limit_calls(monkeypatch, tmp_path, 60.0)
    body = f"signal.signal(signal.SIGXCPU, {action})\n    while True: pass"
    first, second = called(ros, f"import os, signal\n\ndef f(x, y):\n    {body}\n")
    assert (first.ended, second.ended) == (TOO_LATE, "")


def test_the_cpu_time_of_the_processes_that_a_call_has_started_does_not_count(
    ros: Ros, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The kernel limits the CPU time of each process."""
    limit_calls(monkeypatch, tmp_path, 60.0)
    source = """
import os, time

def f(x, y):
    for _ in range(2):
        if os.fork() == 0:
            while time.process_time() < 0.7:
                pass
            os._exit(0)
        os.wait()
    return (1.0,)
"""
    assert [each.values for each in called(ros, source)] == [(1.0,), (1.0,)]


@pytest.mark.parametrize(
    "body",
    [
        "import os, signal; os.kill(os.getppid(), signal.SIGKILL)",
        "import os; os._exit(0)",
        "raise SystemExit(0)",
        "import os\n    while True: os.write(1, b'x' * 65536)",
    ],
)
def test_a_function_that_breaks_the_call_has_no_result(ros: Ros, body: str) -> None:
    assert [each.values for each in called(ros, f"def f(x, y):\n    {body}\n")] == [None, None]


@pytest.mark.skipif(not bubblewrap.usable(), reason="the sandbox is not available")
def test_a_process_of_a_call_does_not_live_on(ros: Ros) -> None:
    source = """
import os
import time

def f(x, y):
    alive = [name for name in os.listdir("/proc") if name.isdigit() and int(name) not in (1, os.getpid())]
    if os.fork() == 0:
        os.setsid()
        time.sleep(1000)
    return (len(alive),)
"""
    assert [each.values for each in called(ros, source)] == [(0.0,), (0.0,)]


def test_a_result_that_cannot_be_parsed_does_not_affect_the_next_call(ros: Ros) -> None:
    source = """
import os

def f(x, y):
    if os.path.exists("not-the-first"):
        return (1.0,)
    open("not-the-first", "w").close()
    for number in range(3, 20):
        try:
            os.pwrite(number, b"[" * 20_000, 0)
        except OSError:
            pass
    os._exit(0)
"""
    assert [each.values for each in called(ros, source)] == [None, (1.0,)]


def test_a_program_reads_the_files_beside_it(ros: Ros) -> None:
    source = "import sys\nprint(open(sys.argv[1]).read())\nsys.exit('the end')\n"
    tree = tree_of(ros, f"lib/{PACKAGE}/program", source)
    output = calling.make_calls(
        ros,
        PACKAGE,
        tree,
        [{"id": "one", "arguments": ["bags/file"]}],
        {"bags/file": b"content"},
        executable="program",
        in_cell=bubblewrap.usable(),
    )
    (one,) = read_called(output, ["one"])
    assert (one.ended, one.stdout, one.stderr) == ("exit 1", "content\n", "the end\n")


GOOD = {"id": "one", "ended": "exit 0", "stdout": "", "stderr": "", "values": [1, 2], "kind": "list"}


@pytest.mark.parametrize(
    "line",
    [
        "",
        "null",
        "[]",
        "[" * 5000,
        json.dumps({**GOOD, "values": "many"}),
        json.dumps({**GOOD, "values": [[1]]}),
        json.dumps({**GOOD, "values": {"a": 1}}),
        json.dumps({**GOOD, "stdout": 1}),
        json.dumps({**GOOD, "values": [10**400]}),
        json.dumps({"id": "one"}),
    ],
)
def test_a_line_that_is_no_result_is_left_out(line: str) -> None:
    assert read_called(line.encode(), ["one"]) == (Called("one"),)


def test_a_number_that_is_too_large_is_told_as_all_other_wrong_values() -> None:
    with pytest.raises(ValueError, match="too large"):
        called_from_json({**GOOD, "values": [10**400]})


def test_long_results_are_cut() -> None:
    line: dict[str, Any] = {**GOOD, "stdout": "x" * 2 * MOST_TEXT, "values": list(range(1000))}
    (one,) = read_called(json.dumps(line).encode(), ["one"])
    assert (len(one.stdout), len(one.values or ())) == (MOST_TEXT, 10)
