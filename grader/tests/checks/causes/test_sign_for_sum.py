"""=+ in place of +=: the cause of a counter that does not count."""

from __future__ import annotations

import pytest

from grader.checks.subjects.log import LOG_COUNTER
from grader.tests.checks.made import NODE_FILE, evidence, found, recording, submission
from grader.tests.checks.node_log import HELLO, LOGS, hello


@pytest.mark.parametrize("numbers", [(0, 1, 1), (1, 1, 1)])
def test_a_sign_in_place_of_a_sum_is_named(numbers: tuple[int, ...]) -> None:
    source = LOGS.replace("def send(self):", "def send(self):\n        self.count =+ 1")
    assert source != LOGS
    given = evidence(recording([], log=hello(*numbers)), submission({NODE_FILE: source}))
    finding = found(LOG_COUNTER, given, format=HELLO, counts="counter")
    line = source[: source.index("=+")].count("\n") + 1
    assert (str(finding.where), finding.cause) == (
        f"{NODE_FILE}:{line}",
        "=+ sets self.count to 1 in each call. += adds.",
    )
    in_init = LOGS.replace("super()", "self.count = +1\n        super()", 1)
    given = evidence(recording([], log=hello(*numbers)), submission({NODE_FILE: in_init}))
    assert "=+" not in found(LOG_COUNTER, given, format=HELLO, counts="counter").cause
