"""Configuration of nbgrader for this course: source in solutions/, release in exercises/, a class in class/."""

from pathlib import Path

from grader.gradebook.config import configure

configure(get_config(), Path(__file__).resolve().parent.parent)  # noqa: F821 - traitlets puts it there
