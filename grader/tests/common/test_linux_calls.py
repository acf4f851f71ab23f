"""The grader can use pidfds and file locks even in a Python that was built for an old system."""

from __future__ import annotations

import ast
import fcntl
import importlib
import os
import resource
import select
import signal
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from grader.common import linux_calls
from grader.tests.case import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

MISSING = {
    "os": {"pidfd_open", "memfd_create", "getrandom", "copy_file_range", "eventfd", "splice", "O_TMPFILE"},
    "signal": {"pidfd_send_signal"},
    "fcntl": {"F_OFD_SETLK", "F_OFD_SETLKW", "F_OFD_GETLK", "F_ADD_SEALS"},
}
"""Names that Python lacks if it was built with the headers of Linux 3.10 and glibc 2.17."""

CLOSES = """
import os, resource, sys
from grader.common import linux_calls

def refused(*_):
    raise OSError

if sys.argv[1] != "has close_range":
    linux_calls._call = refused
os.dup2(os.open("/dev/null", os.O_RDONLY), 900)
resource.setrlimit(resource.RLIMIT_NOFILE, (100, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
linux_calls.close_from(3)
print([number for number in range(1000) if os.path.exists(f"/proc/self/fd/{number}")])
"""


@pytest.fixture(params=["the names of Python", "without these names"])
def _old(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    if request.param == "without these names":
        for module, names in MISSING.items():
            for name in names:
                monkeypatch.delattr(importlib.import_module(module), name, raising=False)
        assert not hasattr(os, "pidfd_open")
        importlib.reload(linux_calls)
    yield
    monkeypatch.undo()
    importlib.reload(linux_calls)


@pytest.mark.usefixtures("_old")
def test_a_process_is_watched_and_killed_through_its_descriptor() -> None:
    with subprocess.Popen(["sleep", "600"]) as process:
        descriptor = linux_calls.pidfd_open(process.pid)
        assert not os.get_inheritable(descriptor)
        ends = select.poll()
        ends.register(descriptor, select.POLLIN)
        assert ends.poll(0) == []
        linux_calls.pidfd_send_signal(descriptor, signal.SIGKILL)
        assert ends.poll(60_000) != []
    assert process.returncode == -signal.SIGKILL
    with pytest.raises(ProcessLookupError):
        linux_calls.pidfd_send_signal(descriptor, signal.SIGKILL)
    os.close(descriptor)
    with pytest.raises(ProcessLookupError):
        linux_calls.pidfd_open(process.pid)


@pytest.mark.usefixtures("_old")
def test_the_command_for_locks_is_that_of_the_kernel() -> None:
    assert linux_calls.F_OFD_SETLK == 37


@pytest.mark.parametrize("kernel", ["has close_range", "before Linux 5.9"])
def test_all_descriptors_from_a_number_on_are_closed_whatever_the_limit(kernel: str) -> None:
    done = subprocess.run([sys.executable, "-c", CLOSES, kernel], capture_output=True, text=True, check=True)
    assert done.stdout == "[0, 1, 2]\n"


def names_used(path: Path) -> Iterator[str]:
    """Yield what a file uses of the modules in MISSING, such as "os.fork"."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in MISSING:
            yield f"{node.value.id}.{node.attr}"
        elif isinstance(node, ast.ImportFrom) and node.module in MISSING:
            yield from (f"{node.module}.{each.name}" for each in node.names)


def test_no_other_module_needs_a_name_that_such_a_python_lacks() -> None:
    files = [path for path in (ROOT / "grader").rglob("*.py") if "tests" not in path.parts]
    missing = {f"{module}.{name}" for module, names in MISSING.items() for name in names}
    used = {str(path.relative_to(ROOT)): missing & {*names_used(path)} for path in files}
    assert {path: names for path, names in used.items() if names} == {
        "grader/common/linux_calls.py": {"os.pidfd_open", "signal.pidfd_send_signal"}
    }
    assert hasattr(fcntl, "F_OFD_SETLK")


def test_the_cpu_time_that_the_kernel_limits_is_known_exactly_even_after_the_process_has_ended() -> None:
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (1, 2))

    with subprocess.Popen([sys.executable, "-c", "while True: pass"], preexec_fn=limit) as process:
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        assert 1.0 <= linux_calls.limited_cpu_s(process.pid) < 2.0
    assert process.returncode == -signal.SIGXCPU
    with pytest.raises(OSError, match="Invalid argument"):
        linux_calls.limited_cpu_s(process.pid)
