"""A submission with scripts in every text that its author can choose."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from grader.evidence.evidence import Run
from grader.tests.checks.made import BUILD, NODE, NODE_FILE, TOPIC, TWIST, every, evidence, recording, submission
from grader.trial.recording import Endpoint, Graph, LogLine, Output

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

SCRIPTS = (
    "<script>pwned(1)</script>",
    "<img src=x onerror=pwned(2)>",
    '"><svg onload=pwned(3)>',
    "'-pwned(4)-'",
    "</script><script>pwned(5)</script>",
    "{{ pwned(6) }}{% raw %}",
    "</title></style></textarea><iframe srcdoc='<script>parent.pwned(7)</script>'>",
    "javascript:pwned(8)",
    "]]><body onpageshow=pwned(9)>",
)
ODD = "\x00\x1b[31mred\x1b[0m \u202eltr\u202c \ud800 \u2028 \x85 \ufeff"
ALL = " ".join(SCRIPTS)


def hostile() -> Evidence:
    """Return evidence with scripts in file names, code, graph, logs, outputs and the name of the submission."""
    name = f"draw{SCRIPTS[1]}.py"
    code = NODE.replace("linear.x = 2.0", f'linear.x = 9.0  # {ALL}\n        self.x = """{ALL}"""')
    given = submission({NODE_FILE: code, name: code, f"{SCRIPTS[2]}/{SCRIPTS[3]}.py": "print(1)"}, (f"{ALL} leaves.",))
    endpoints = tuple(
        Endpoint(kind, f"/{text}", f"/topic{text}", f"type/{text}")
        for text in SCRIPTS
        for kind in ("publisher", "subscription")
    )
    trial = recording(
        every(0.5, 9.0, 1.0),
        graphs=(
            Graph(0.0, ("/turtlesim", "/draw_circle", ALL), (Endpoint("publisher", ALL, TOPIC, TWIST), *endpoints)),
        ),
        topics={TOPIC: (TWIST, ALL), ALL: (ALL,)},
        stdout=Output(f"{ALL}\n{ODD}\nError: {ALL}\n"),
        stderr=Output(f"Traceback (most recent call last):\n  {ALL}\nValueError: {ALL}\n{ODD}"),
        log=(LogLine(1.0, "ERROR", ALL, f"{ALL} {ODD}"),),
        interventions=(ALL,),
        why=ALL,
    )
    return evidence(
        trial, replace(given, name=f"alice {ALL} {ODD}"), replace(BUILD, log=f"ERROR {ALL}\n{ODD}", exit_code=1)
    )


def enormous() -> Evidence:
    """Return the hostile evidence with huge amounts of everything. Its page must stay small."""
    given = hostile()
    assert given.run.recording is not None
    worst = '"' * 2000 + "\n"
    line = f"# {'<' * 3000} {worst}"
    slow = "1<" * 190 + "1"
    code = (
        NODE.replace("msg.linear.x = 2.0", f"{slow}\n        msg.linear.x = 9.0; {slow}\n        {slow}") + line * 300
    )
    names = tuple(f"/node{'<' * 100}{index}" for index in range(300))
    trial = replace(
        given.run.recording,
        stdout=Output(worst * 2000, dropped=10**9),
        stderr=Output(f"Error {worst}" * 2000),
        log=tuple(LogLine(0.001 * index, "ERROR", worst, worst) for index in range(1000)),
        graphs=(Graph(0.0, names, tuple(Endpoint("publisher", name, f"{name}/topic", '"' * 200) for name in names)),),
        commands=tuple(recording(every(0.002, 9.0, 1.0)).commands),
    )
    return replace(
        given.with_run(Run(trial)),
        submission=replace(submission({NODE_FILE: code}), name='"' * 3000),
        build=replace(BUILD, log=worst * 3000, exit_code=0),
    )
