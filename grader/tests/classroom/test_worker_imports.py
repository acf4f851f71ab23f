"""A worker imports the modules for grading once, so the child processes that read a submission do not import them."""

from __future__ import annotations

import subprocess

from grader.common.interpreter import interpreter
from grader.tests.case import ROOT

IMPORTS = """
import sys
from pathlib import Path
from grader.checks.exercises import find_exercise
from grader.classroom import task, worker
from grader.submission import reader
from grader.submission.package import open_submission

worker._import_all()
known = set(sys.modules)
reader._Child.inside = True  # all reading happens in this process, so it imports what a child process would import
given = open_submission(Path(sys.argv[1]))
task._with_page(task.grade(find_exercise("03-circle-publisher"), given, task.Options(in_cell=False), build=None))
new = {name for name in sys.modules if "." not in name} - known - set(sys.stdlib_module_names)
print(*(name for name in new if not name.startswith("_")))
"""


def test_a_worker_has_imported_what_its_children_need() -> None:
    start = interpreter("-c", IMPORTS, str(ROOT / "solutions/03-circle-publisher"))
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.split()) == (0, []), done.stdout + done.stderr
