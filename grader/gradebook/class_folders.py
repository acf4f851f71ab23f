"""The folders of a class, as configured in the course's nbgrader_config.py."""

from __future__ import annotations

import json
import shlex
import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.checks.exercises import find_exercise
from grader.classroom.find_submissions import left_out
from grader.classroom.found import UNKNOWN
from grader.common import xdg
from grader.errors import MachineError, UsageError
from grader.exercise.model import catalogue, course_folder

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence
    from logging import Logger

CONFIG = "nbgrader_config.py"
CLASS = "class"
"""The folder with the data of the class, such as submitted/, autograded/, feedback/ and gradebook.db. git ignores
it."""
RESULTS = "results"
"""The folder of the grader's results, inside the folder of the class. See grader/classroom/results.py."""
GRADEBOOK = "gradebook.db"
"""nbgrader's database, inside the folder of the class."""
ID = "course_id"
"""The file in the folder of the class that contains the course's name in nbgrader's exchange. Two classes that share an
exchange need different names, or `collect` takes the submissions of both."""


@dataclass(frozen=True)
class ClassFolders:
    """The folders of a class: nbgrader's course directory, and the grader's folders inside that directory."""

    course: Any
    config: Any

    @property
    def results(self) -> Path:
        """The folder of the grader's results."""
        return Path(self.course.root) / CLASS / RESULTS

    @contextmanager
    def gradebook(self) -> Iterator[Any]:
        """Open nbgrader's gradebook, and create it if necessary.

        SQLAlchemy's warnings about nbgrader's code are not shown, because they mean nothing to an instructor.
        nbgrader's log messages about errors of the database are not shown either, because they repeat the error with a
        traceback.

        Raises MachineError if the database cannot be read or written.
        """
        from nbgrader.api import Gradebook
        from sqlalchemy.exc import DatabaseError, SAWarning
        from tornado.log import app_log

        with warnings.catch_warnings(), _silent(app_log):
            warnings.simplefilter("ignore", SAWarning)
            try:
                with Gradebook(self.course.db_url, self.course.course_id) as opened:
                    yield opened
            except DatabaseError as error:
                message = f"The gradebook of {self.course.root} could not be read or written: {error.orig}."
                if "locked" in str(error.orig):
                    message += " Another program is using this database. When it has finished, run this command again."
                raise MachineError(message) from error

    def submitted(self, student: str, step: str) -> Path:
        """Return the folder of a student's submission for a step."""
        return Path(self.course.format_path(self.course.submitted_directory, student, step))

    def autograded(self, student: str, step: str) -> Path:
        """Return the path of the notebook that autograde writes. The file may not exist yet."""
        return Path(self.course.format_path(self.course.autograded_directory, student, step)) / f"{step}.ipynb"

    def submissions(self, steps: Sequence[str]) -> list[tuple[str, str]]:
        """Return (student, step) for every collected submission. Raises UsageError for an unknown step."""
        wanted = [find_exercise(step).id for step in steps] or list(catalogue())
        root = Path(self.course.root) / self.course.submitted_directory
        students = sorted(
            folder.name for folder in root.glob("*") if folder.is_dir() and not folder.name.startswith(".")
        )
        return [(student, step) for step in wanted for student in students if _is_folder(root / student / step)]

    def left_out(self, steps: Sequence[str], assignments: Collection[str]) -> tuple[str, ...]:
        """Return the reasons why entries in the folder of the submissions are not graded.

        `steps` selects the exercises; if it is empty, all are used. `assignments` are the
        names of the assignments in the gradebook.
        """
        root = Path(self.course.root) / self.course.submitted_directory
        found = left_out(root, [name for name in assignments if name not in catalogue()])
        chosen = (each for each in found if not steps or each.exercise in (UNKNOWN, *steps))
        return tuple(each.refused.reason for each in chosen if each.refused)


@contextmanager
def _silent(log: Logger) -> Iterator[None]:
    """Discard all messages of this logger inside the `with` block."""
    log.disabled = True
    try:
        yield
    finally:
        log.disabled = False


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except OSError:
        return True  # the error is reported when the folder is read


def remember(folder: Path) -> None:
    """Record that this user created the class in `folder`.

    Raises MachineError if the file that lists the classes cannot be written.
    """
    file = _made()
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with file.open("a", encoding="utf-8") as opened:
            opened.write(json.dumps(str(folder.resolve() / "course")) + "\n")
    except OSError as error:
        message = f"{error.filename or file} could not be written: {error.strerror}."
        raise MachineError(message) from error


def _is_known(course: Path) -> bool:
    """Return whether the folder is this copy of the course, or was created by `grader class new`."""
    try:
        made = _made().read_text("utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        made = []
    return course == course_folder().resolve() or json.dumps(str(course)) in made


def _made() -> Path:
    """Return the file that lists the classes created by this user, one per line."""
    return xdg.state() / "classes"


def open_class(folder: Path | None) -> ClassFolders:
    """Open the class whose nbgrader_config.py is in `folder` or in its subfolder course/.

    The default is the current folder.

    nbgrader_config.py is a program that this function executes. The current folder may belong to a student, so it is
    used only if it belongs to this copy of the course or to a class that this user created.

    Raises:
        UsageError: nbgrader_config.py does not exist, or nothing shows that this user created the class.
        MachineError: nbgrader is not installed.
    """
    tried = [folder or Path(), (folder or Path()) / "course"]
    found = next((each for each in tried if (each / CONFIG).is_file()), None)
    if found is None:
        message = (
            f"{folder or Path.cwd()} has no {CONFIG}. Go to the course's folder, or name that folder with --course. "
            "`grader class new DIR` creates a class."
        )
        raise UsageError(message)
    if folder is None and not _is_known(found.resolve()):
        message = (
            f"{found.resolve() / CONFIG} is a program, and nothing shows that `grader class new` created this folder "
            f"for you. If you trust this program, name the folder: --course {shlex.quote(str(found.resolve()))}"
        )
        raise UsageError(message)
    try:
        from nbgrader.coursedir import CourseDirectory
        from traitlets.config.loader import PyFileConfigLoader
    except ImportError as error:
        message = "nbgrader is not installed. Run `make notebooks` to install nbgrader."
        raise MachineError(message) from error
    config = PyFileConfigLoader(CONFIG, path=str(found.resolve())).load_config()
    return ClassFolders(CourseDirectory(config=config), config)
