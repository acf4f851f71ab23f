"""Configuration of nbgrader for this folder. Source: solutions/; release: exercises/; the files of a class: class/."""

from pathlib import Path

from grader.gradebook.config import configure

configure(get_config(), Path(__file__).resolve().parent.parent)  # noqa: F821 - traitlets puts it there
