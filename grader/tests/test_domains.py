"""Parallel test processes get different domains. A process that finds none waits until another gives one back."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from grader.tests.domains import FIRST, LAST, MOST

if TYPE_CHECKING:
    from collections.abc import Iterator

PROCESSES = 6
"""Programs that are running on this machine may use some of the domains."""
SHARED = f"""
import sys
from grader.tests.domains import default_domain, own_domain, separate_domain
with separate_domain() as domain:
    print(domain, default_domain(), *(own_domain() for _ in range({MOST + 3})), flush=True)
    sys.stdin.read()
"""
TAKES_ALL = """
import sys
from grader.tests import domains
domains.participant_ports = lambda _: set()
while domains._free() is not None:
    pass
print("all", flush=True)
sys.stdin.readline()
domain, file = domains._held.popitem()
file.close()
print(domain, flush=True)
sys.stdin.read()
"""
WAITS = """
from grader.tests import domains
domains.participant_ports = lambda _: set()
domains.default_domain = lambda: 0
domains.time.sleep = lambda _: print("waits", flush=True)
with domains.separate_domain() as domain:
    print(domain, flush=True)
"""
TWICE = """
from grader.tests import domains
domains.participant_ports = lambda _: set()  # a node of another test may use the domain in between
for _ in range(2):
    with domains.separate_domain() as domain:
        print(domain)
"""


def test_no_two_processes_share_a_domain(tmp_path: Path) -> None:
    started = [begin(SHARED, tmp_path) for _ in range(PROCESSES)]
    given = [list(map(int, next(said(process)).split())) for process in started]
    for process in started:
        process.communicate()
    for separate, default, *own in given:
        assert len({separate, default, *own}) == 2 + MOST
        assert not {separate, default} & set(own)
        assert own[-3:] == own[:3]
    all_of_them = [domain for domains in given for domain in set(domains)]
    assert len(set(all_of_them)) == len(all_of_them)
    assert all(FIRST <= domain <= LAST for domain in all_of_them)


def test_a_process_waits_for_a_domain(tmp_path: Path) -> None:
    holder = begin(TAKES_ALL, tmp_path)
    assert next(said(holder)) == "all"
    waiting = begin(WAITS, tmp_path)
    assert next(said(waiting)) == "waits"
    print("give one back", file=holder.stdin, flush=True)
    given_back = next(said(holder))
    assert next(line for line in said(waiting) if line != "waits") == given_back
    for process in (holder, waiting):
        process.communicate()


def test_a_domain_is_given_back(tmp_path: Path) -> None:
    first, second = begin(TWICE, tmp_path).communicate()[0].split()
    assert first == second


def begin(code: str, temporary: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", code],
        cwd=Path(__file__).parents[2],
        env={"TMPDIR": str(temporary)},  # the tests that are running keep their locks in another folder
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


def said(process: subprocess.Popen[str]) -> Iterator[str]:
    assert process.stdout is not None
    return map(str.rstrip, process.stdout)
