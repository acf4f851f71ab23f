"""The last part of `make demo`: grade the solution of a step as a learner does, and print the times and the next steps.

`python -m grader.setup.demo --since SECONDS`: SECONDS is the uptime (/proc/uptime) at the start of `make`. Unlike the
system time, the uptime does not change if somebody sets the clock. The times of the set-up are printed only if this run
of `make` did the set-up.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

from grader.common import terminal_text
from grader.common.interpreter import interpreter
from grader.errors import GraderError
from grader.learner import progress
from grader.learner.steps import needs_bash
from grader.setup.bootstrap import ROOT, STAMP, read_stamp, say
from grader.setup.setup_errors import MACHINE_BROKEN, run_and_exit

STEP = "03-circle-publisher"
FOLDER = Path("build/demo")
STAGES = {
    "interfaces": "turtlesim's messages, built once",
    "build": "colcon build",
    "trial": "simulator and node",
    "checks": "checks",
}
"""Maps the name of a stage in the report to the text that is printed."""


def main(arguments: list[str] | None = None) -> int:
    """Grade the solution of step 03, or the starting point if there is no solution. Return the exit code."""
    parser = argparse.ArgumentParser(description="Grade the solution of a step and print what to type next.")
    parser.add_argument("--since", type=float, default=uptime_s(), help="the uptime (s) when `make` began")
    since = parser.parse_args(arguments).since

    image, report = FOLDER / f"{STEP}.png", FOLDER / f"{STEP}.json"
    (ROOT / FOLDER).mkdir(parents=True, exist_ok=True)
    (ROOT / report).unlink(missing_ok=True)
    # In the students' repository, which has no solutions, grade the starting point instead.
    side = "solutions" if (ROOT / "solutions" / STEP).is_dir() else "exercises"
    command = ["grader", "check", f"{side}/{STEP}", "--image", str(image), "--json", str(report)]
    say("$ " + " ".join(command))
    checking = interpreter("-m", "grader.cli", *command[1:])
    done = subprocess.run(checking.argv, env=checking.env, cwd=ROOT, check=False)
    if done.returncode != (0 if side == "solutions" else 1):
        terminal_text.say(closing_words(done.returncode), sys.stdout)
        return done.returncode
    print()
    say("Duration of each stage")
    for name, seconds in [*set_up_seconds(uptime_s() - since), *grading_seconds(ROOT / report)]:
        print(f"  {name:<40} {seconds:6.1f} s")
    print(f"  {'in all':<40} {uptime_s() - since:6.1f} s")
    print(f"\nImage of the turtle's path: {image}")
    print(next_words())
    return 0


def next_words() -> str:
    """Return the next commands to print: those of a new learner, or of one who has started a step before."""
    try:
        begun = progress.load(progress.workspace_of(None)).current is not None
    except (GraderError, OSError, RuntimeError):  # the next command reports it
        begun = False
    what, command = ("see how far you are", "grader status") if begun else ("start the first step", "grader start 01")
    bash = "    bash\n" if needs_bash() else ""
    words = f"\nNext, in this folder: source the setup file, and {what}."
    return f"{words}\n\n{bash}    source .venv/setup.bash\n    {command}"


def closing_words(exit_code: int) -> str:
    """Return the message to print if step 03 could not be graded, or if its result is not the expected one."""
    if exit_code == MACHINE_BROKEN:
        return "\nStep 03 could not be graded on this machine. To see what is missing, type: .venv/bin/grader doctor"
    return "\nThe result of step 03 is not the expected one. This is not your mistake. Please report the lines above."


def uptime_s() -> float:
    """Return the time since the machine was started (s)."""
    return float(Path("/proc/uptime").read_text(encoding="ascii").split()[0])


def set_up_seconds(elapsed_s: float) -> list[tuple[str, float]]:
    """Return the duration of each stage of the set-up (s), or an empty list if an earlier command did the set-up.

    `elapsed_s` is the time since `make` began.
    """
    stamp = read_stamp()
    if stamp is None or not 0 <= time.time() - STAMP.stat().st_mtime <= elapsed_s:
        return []
    return [(f"set-up, once: {name}", seconds) for name, seconds in stamp.seconds.items()]


def grading_seconds(report: Path) -> list[tuple[str, float]]:
    """Return the duration of each stage of the grading (s)."""
    seconds = json.loads(report.read_text(encoding="utf-8"))["seconds"]
    return [(words, float(seconds[name])) for name, words in STAGES.items() if name in seconds]


if __name__ == "__main__":
    run_and_exit(main)
