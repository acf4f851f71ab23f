"""Parallel test processes get different domains, and none of them waits."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from grader.tests.domains import FIRST, LAST, MOST

PROCESSES = 6
"""Programs that are running on this machine may use some of the domains."""
CODE = f"""
import sys
from grader.tests.domains import default_domain, own_domain
print(default_domain(), *(own_domain() for _ in range({MOST + 3})), flush=True)
sys.stdin.read()
"""


def test_no_two_processes_share_a_domain(tmp_path: Path) -> None:
    command = [sys.executable, "-c", CODE]
    started = [
        subprocess.Popen(
            command,
            cwd=Path(__file__).parents[2],
            env={"TMPDIR": str(tmp_path)},  # the tests that are running keep their locks in another folder
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for _ in range(PROCESSES)
    ]
    given = [list(map(int, process.stdout.readline().split())) for process in started if process.stdout]
    for process in started:
        process.communicate()
    for domains in given:
        assert len(set(domains)) == 1 + MOST
        assert domains[0] not in domains[1:]
        assert domains[-3:] == domains[1:4]
    all_of_them = [domain for domains in given for domain in set(domains)]
    assert len(set(all_of_them)) == len(all_of_them)
    assert all(FIRST <= domain <= LAST for domain in all_of_them)
