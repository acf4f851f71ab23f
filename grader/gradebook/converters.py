"""nbgrader's converters and its collect step, on what the reader returns: its own follow links and have no limits."""

from __future__ import annotations

import io
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import nbformat
from nbconvert.exporters import HTMLExporter, NotebookExporter
from nbgrader.converters import Autograde
from nbgrader.converters.base import BaseConverter
from nbgrader.exchange.default import ExchangeCollect

from grader.errors import GraderError
from grader.gradebook import readable
from grader.gradebook.copies import copy_of
from grader.submission import tree
from grader.submission.reader import read

if TYPE_CHECKING:
    from nbformat import NotebookNode

    Resources = dict[str, Any]
    Converted = tuple[Any, Resources]

_USERS = ("nbgrader.converters", "nbgrader.apps.autogradeapp", "nbgrader.apps.api")
"""The modules that use Autograde by its name. nbgrader has no setting for it."""


def install() -> None:
    """Let nbgrader use `BoundedAutograde`."""
    for name in _USERS:
        module = sys.modules.get(name)
        if module is not None:
            module.Autograde = BoundedAutograde  # type: ignore[attr-defined]


class _Copying(BaseConverter):  # type: ignore[misc, unused-ignore]
    """Copies the files of a submission that are safe to copy."""

    notebooks: list[str]

    def init_assignment(self, assignment_id: str, student_id: str) -> None:
        """Copy the files next to the notebooks."""
        source = Path(self._format_source(assignment_id, student_id))
        for each in copy_of(source, Path(self._format_dest(assignment_id, student_id)), notebooks=False):
            self.log.warning("Not copied from %s: %s", source, each)
        # nbgrader writes the names of unknown notebooks to the terminal as they are.
        self.notebooks: list[str] = [notebook for notebook in self.notebooks if notebook.isprintable()]


class BoundedAutograde(Autograde, _Copying):  # type: ignore[misc, unused-ignore]
    """Autograde, with `_Copying` as the base class that copies."""

    def init_destination(self, assignment_id: str, student_id: str) -> bool:
        """Do as Autograde, but fail only this submission if its time is invalid."""
        read(readable.time_of, Path(self._format_source(assignment_id, student_id)))
        return bool(super().init_destination(assignment_id, student_id))


class BoundedNotebook(NotebookExporter):
    """Reads a notebook in the process for that. nbconvert then gets a small and valid one."""

    def from_filename(self, filename: str, resources: Resources | None = None, **kw: Any) -> Converted:  # noqa: ANN401
        """Do as the base class."""
        text, named = _read(filename, resources)
        return self.from_file(io.StringIO(text), resources=named, **kw)  # type: ignore[no-any-return, unused-ignore]


class BoundedPage(HTMLExporter):
    """Renders feedback in the process that reads, because Markdown of a student is parsed for it."""

    def from_filename(self, filename: str, resources: Resources | None = None, **kw: Any) -> Converted:  # noqa: ANN401
        """Do as the base class."""
        text, named = _read(filename, resources)
        notebook = nbformat.reads(text, as_version=4)  # type: ignore[no-untyped-call]
        page, extension = read(self._page, notebook, named, kw)
        return page, {**named, "output_extension": extension}

    def _page(self, notebook: NotebookNode, resources: Resources, more: dict[str, Any]) -> tuple[str, str]:
        page, done = self.from_notebook_node(notebook, resources=resources, **more)
        return str(page), str(done["output_extension"])


def _read(filename: str, resources: Resources | None) -> tuple[str, Resources]:
    file = Path(filename)
    about = {"name": file.stem, "path": str(file.parent)}
    return read(readable.notebook, file), {**(resources or {}), "metadata": about}


class BoundedCollect(ExchangeCollect):  # type: ignore[misc, unused-ignore]
    """Collects submissions from the exchange, where students can write anything into their folders."""

    def _path_to_record(self, path: str) -> dict[str, Any]:
        try:
            return super()._path_to_record(path)  # type: ignore[no-any-return, unused-ignore]
        except Exception:
            self.log.warning("Not collected, because its name has no valid time: %s", tree.shown(path))
            return {"username": "", "filename": "", "timestamp": 0}

    def copy_files(self) -> None:
        """Do as the base class, without the folders that nobody can have handed in with nbgrader."""
        self.src_records: list[dict[str, Any]] = [record for record in self.src_records if record["username"]]
        super().copy_files()

    def do_copy(self, src: str, dest: str, log: Any = None) -> None:  # noqa: ANN401 - as the base class
        """Copy one submission. If it cannot be copied, the others still are."""
        with tempfile.TemporaryDirectory(prefix="collect-") as folder:
            safe = Path(folder, "submission")
            try:
                left_out = copy_of(Path(src), safe)
                read(readable.time_of, safe)
                super().do_copy(str(safe), dest, log)
            except (GraderError, OSError, RuntimeError) as error:
                self.log.warning("%s could not be collected: %s", tree.shown(src), error)
                return
        for each in left_out:
            self.log.warning("Not collected from %s: %s", tree.shown(src), each)
