"""Variants of nbgrader's converters and collect step. They use only files that the reading process accepts."""

from __future__ import annotations

import io
import shutil
import sys
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import nbformat
from nbconvert.exporters import HTMLExporter, NotebookExporter
from nbgrader.api import Gradebook
from nbgrader.converters import Autograde, GenerateFeedback
from nbgrader.converters.base import BaseConverter, NbGraderException
from nbgrader.exchange.default import ExchangeCollect

from grader.common.temporary_folder import temporary_folder
from grader.errors import GraderError
from grader.gradebook import inbound, readable
from grader.gradebook.class_folders import CLASS, GRADEBOOK, RESULTS
from grader.gradebook.copies import copy_of
from grader.gradebook.failed_disk import failed_disk
from grader.gradebook.student_names import unclear
from grader.submission import tree
from grader.submission.reader import read

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from nbformat import NotebookNode

    Resources = dict[str, Any]
    Converted = tuple[Any, Resources]

_USERS = ("nbgrader.converters", "nbgrader.apps.autogradeapp", "nbgrader.apps.generatefeedbackapp", "nbgrader.apps.api")
"""The modules that import Autograde or GenerateFeedback by name. nbgrader has no setting that replaces a class."""
_NEVER = datetime(1, 1, 1)  # noqa: DTZ001 - nbgrader compares times without a zone


def install() -> None:
    """Replace Autograde and GenerateFeedback with `BoundedAutograde` and `BoundedFeedback` in nbgrader."""
    for name in _USERS:
        module = sys.modules.get(name)
        if module is not None:
            module.Autograde = BoundedAutograde  # type: ignore[attr-defined]
            module.GenerateFeedback = BoundedFeedback  # type: ignore[attr-defined]


class _Copying(BaseConverter):  # type: ignore[misc, unused-ignore]
    """Copies only the files of a submission that are safe to copy."""

    notebooks: list[str]

    def init_notebooks(self) -> None:
        """Find the submissions, but skip each student folder whose name cannot be printed.

        If the name contains a line break, for example, nbgrader would stop.
        """
        super().init_notebooks()
        for each in [each for each in self.assignments if not Path(each).parent.name.isprintable()]:
            self.log.error("Not autograded, because the name of the folder cannot be printed: %s", tree.shown(each))
            del self.assignments[each]

    def init_assignment(self, assignment_id: str, student_id: str) -> None:
        """Copy the files next to the notebooks."""
        source = Path(self._format_source(assignment_id, student_id))
        for each in copy_of(source, Path(self._format_dest(assignment_id, student_id)), notebooks=False):
            self.log.warning("Not copied from %s: %s", source, each)
        self.notebooks: list[str] = _in(source, self.notebooks)


class _DiskError(BaseException):
    """The disk has failed. After an `Exception`, nbgrader would continue with the next submission."""


class _StopsWithTheDisk(BaseConverter):  # type: ignore[misc, unused-ignore]
    """Stops at the first submission for which the disk fails, because all other submissions would fail, too."""

    def convert_notebooks(self) -> None:
        """Convert all submissions as the base class does.

        Raises:
            NbGraderException: the disk failed, or some of the submissions could not be converted.
        """
        try:
            super().convert_notebooks()
        except _DiskError as error:
            message = f"{error} Then run the same command again."
            self.log.critical(message)
            raise NbGraderException(message) from error

    def init_destination(self, assignment_id: str, student_id: str) -> bool:
        """Initialize the destination as the base class does."""
        with self._stopping(assignment_id, student_id):
            return bool(super().init_destination(assignment_id, student_id))

    def init_assignment(self, assignment_id: str, student_id: str) -> None:
        """Copy the files as the base class does."""
        with self._stopping(assignment_id, student_id):
            super().init_assignment(assignment_id, student_id)

    def convert_single_notebook(self, notebook_filename: str) -> None:
        """Convert a notebook as the base class does."""
        submission = Path(notebook_filename).parent
        with self._stopping(submission.name, submission.parent.name):
            super().convert_single_notebook(notebook_filename)

    @contextmanager
    def _stopping(self, assignment_id: str, student_id: str) -> Iterator[None]:
        dest = Path(self._format_dest(assignment_id, student_id))
        try:
            yield
        except Exception as error:
            failure = failed_disk(error, dest)
            if not failure:
                raise
            if self.coursedir.notebook_id == "*":
                shutil.rmtree(dest, ignore_errors=True)  # as nbgrader does for every failed submission
            raise _DiskError(failure) from error


class _Resumed(BaseConverter):  # type: ignore[misc, unused-ignore]
    """If an earlier run was killed and left an unfinished destination, removes it, since nbgrader would skip it."""

    def init_destination(self, assignment_id: str, student_id: str) -> bool:
        """Remove an unfinished destination, and initialize it as the base class does."""
        dest = Path(self._format_dest(assignment_id, student_id))
        self._mark = dest.with_name(f".{dest.name}.unfinished")
        if self._mark.exists() and dest.exists():
            self.log.warning("Removing the unfinished assignment of an earlier run: %s", tree.shown(str(dest)))
            shutil.rmtree(dest)
        begins = bool(super().init_destination(assignment_id, student_id))
        if begins:
            self._mark.parent.mkdir(parents=True, exist_ok=True)
            self._mark.touch()
        return begins

    def run_post_convert_hook(self) -> None:
        """Run nbgrader's hook, and record that this submission is finished."""
        super().run_post_convert_hook()
        self._mark.unlink()


class _Autograde(_Resumed, Autograde, _Copying):  # type: ignore[misc, unused-ignore]
    """nbgrader's Autograde, in which the base class `_Copying` copies the files."""

    def init_destination(self, assignment_id: str, student_id: str) -> bool:
        """Initialize the destination as nbgrader's method does, and return its result.

        If the submission time is invalid, only this submission fails. A submission is skipped if the name of the
        student's folder is another spelling of an id in the gradebook, because nbgrader would add a second student.
        """
        with Gradebook(self.coursedir.db_url, self.coursedir.course_id) as gradebook:
            enrolled = {student.id for student in gradebook.students}
        if student_id not in enrolled and (why := unclear([student_id], enrolled)):
            self.log.error("Not autograded: %s", why[student_id].reason)
            return False
        read(readable.time_of, Path(self._format_source(assignment_id, student_id)))
        return super().init_destination(assignment_id, student_id)


def _in(folder: Path, notebooks: Sequence[str]) -> list[str]:
    """Return the notebooks in this folder whose names can be printed.

    If the name of a student is a pattern such as "*", nbgrader also finds the notebooks of other students.
    """
    found = [each for each in map(Path, notebooks) if each.parent == folder and each.name.isprintable()]
    return list(map(str, found))


class BoundedAutograde(_StopsWithTheDisk, _Autograde):
    """nbgrader's Autograde with limits on what it reads."""


class _Feedback(_Resumed, GenerateFeedback):  # type: ignore[misc, unused-ignore]
    """nbgrader's GenerateFeedback, but it copies only the time stamp and the secret of a submission.

    If it copied all files, nbgrader would also release the student's own .html files.
    """

    notebooks: list[str]

    def init_assignment(self, assignment_id: str, student_id: str) -> None:
        """Copy the files that releasing the feedback needs."""
        source, dest = (Path(make(assignment_id, student_id)) for make in (self._format_source, self._format_dest))
        dest.mkdir(parents=True, exist_ok=True)
        for name in (readable.TIMESTAMP, readable.SECRET):
            if (source / name).is_file():
                shutil.copyfile(source / name, dest / name)
        self.notebooks: list[str] = _in(source, self.notebooks)


class BoundedFeedback(_StopsWithTheDisk, _Feedback):
    """nbgrader's GenerateFeedback with limits on what it reads."""


class BoundedNotebook(NotebookExporter):
    """Reads a notebook in the reading process, so that nbconvert gets only small and valid notebooks."""

    def from_filename(self, filename: str, resources: Resources | None = None, **kw: Any) -> Converted:  # noqa: ANN401
        """Convert a file as the base class does."""
        text, named = _read(filename, resources)
        return self.from_file(io.StringIO(text), resources=named, **kw)  # type: ignore[no-any-return, unused-ignore]


class BoundedPage(HTMLExporter):
    """Renders feedback in the reading process, because rendering parses a student's Markdown."""

    def from_filename(self, filename: str, resources: Resources | None = None, **kw: Any) -> Converted:  # noqa: ANN401
        """Convert a file as the base class does."""
        text, named = _read(filename, resources)
        notebook = nbformat.reads(text, as_version=4)  # type: ignore[no-untyped-call]
        page, extension = read(self._page, notebook, named, kw, self._files())
        return page, {**named, "output_extension": extension}

    def _files(self) -> list[Path]:
        """Return the files that `_page` opens: the gradebook, the grader's results, and the templates."""
        converter: Any = self.parent
        kept = Path(converter.coursedir.root) / CLASS
        return [kept / GRADEBOOK, kept / RESULTS, *map(Path, self.template_paths)]

    def _page(
        self, notebook: NotebookNode, resources: Resources, more: dict[str, Any], _: list[Path]
    ) -> tuple[str, str]:
        page, done = self.from_notebook_node(notebook, resources=resources, **more)
        return str(page), str(done["output_extension"])


def _read(filename: str, resources: Resources | None) -> tuple[str, Resources]:
    file = Path(filename)
    about = {"name": file.stem, "path": str(file.parent)}
    return read(readable.notebook, file), {**(resources or {}), "metadata": about}


class BoundedCollect(ExchangeCollect):  # type: ignore[misc, unused-ignore]
    """Collects submissions from the exchange, in which students can write any files."""

    def _path_to_record(self, path: str) -> dict[str, Any]:
        try:
            record: dict[str, Any] = super()._path_to_record(path)
            why = inbound.why_not(Path(path), record["username"], owned=self.check_owner)
        except Exception:
            record, why = {}, "the name does not contain a valid time"
        if why:
            self.log.warning("Not collected, because %s: %s", why, tree.shown(path))
            return {"username": "", "filename": "", "timestamp": _NEVER}
        owner = inbound.owner(Path(path)) if self.check_owner else record["username"]
        if owner != record["username"]:
            text = "The name of %s contains the student %s, but the folder belongs to %s"
            self.log.warning(text, tree.shown(path), record["username"], owner)
        return record

    def copy_files(self) -> None:
        """Copy the submissions as the base class does, but skip folders that nbgrader cannot have created."""
        self.src_records: list[dict[str, Any]] = [record for record in self.src_records if record["username"]]
        self.check_owner = False  # nbgrader would stop if a student removed a folder now
        super().copy_files()

    def do_copy(self, src: str, dest: str, log: Any = None) -> None:  # noqa: ANN401 - as the base class
        """Copy one submission. If the copy fails, log a warning and continue with the other submissions.

        If the disk has failed, stop, because nbgrader removes a student's earlier submission before each copy. Other
        students would lose their earlier submissions. An incomplete copy has another name, because nbgrader would not
        collect a submission again for which there is a folder.
        """
        copy = Path(dest).with_name(f".{Path(dest).name}.unfinished")
        with temporary_folder() as folder:
            safe = folder / "submission"
            try:
                left_out = copy_of(Path(src), safe)
                read(readable.time_of, safe)
                shutil.rmtree(copy, ignore_errors=True)
                super().do_copy(str(safe), str(copy), log)
                copy.rename(dest)
            except (GraderError, OSError, RuntimeError) as error:
                shutil.rmtree(copy, ignore_errors=True)
                if failure := failed_disk(error, dest):
                    self.fail(f"{failure} Then run the same command again.")
                self.log.warning("%s could not be collected: %s", tree.shown(src), error)
                return
        for each in left_out:
            self.log.warning("Not collected from %s: %s", tree.shown(src), each)
