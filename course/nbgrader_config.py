"""nbgrader, run in this folder: solutions/ is what it calls source, exercises/ release; a class is in class/."""

from pathlib import Path

from grader.gradebook.config import configure

configure(get_config(), Path(__file__).resolve().parent.parent)  # noqa: F821 - traitlets puts it there
