"""Variants of nbgrader's steps for releasing feedback and listing submissions. One submission cannot stop these steps.

nbgrader reads the time, the notebooks and the secret of a submission. The secret determines the name of the page with
the feedback. A student can remove these files, replace them with named pipes, or fill them with any bytes.
"""

from __future__ import annotations

import glob
from pathlib import Path
from typing import Any

from nbgrader.exchange.default import ExchangeList, ExchangeReleaseFeedback

from grader.errors import GraderError
from grader.gradebook import inbound, readable
from grader.gradebook.failed_disk import failed_disk
from grader.submission.reader import read
from grader.submission.tree import shown


class BoundedReleaseFeedback(ExchangeReleaseFeedback):  # type: ignore[misc, unused-ignore]
    """Releases the feedback of each submission separately."""

    src_path: str
    dest_path: str

    def copy_files(self) -> None:
        """Copy the pages as the base class does. If a page cannot be released, log a warning and continue.

        If the disk has failed, stop: the cause is not the submission, and the next page could not be written either.
        """
        for folder in sorted(glob.glob(self.src_path)):  # noqa: PTH207 - the path is a pattern, as in the base class
            self.src_path = glob.escape(folder)
            try:
                super().copy_files()
            except (OSError, ValueError) as error:  # ValueError: bytes that are not UTF-8
                if failure := failed_disk(error, self.dest_path):
                    self.fail(f"{failure} Then run the same command again.")
                self.log.warning("The feedback in %s was not released: %s", shown(folder), error)


class BoundedList(ExchangeList):  # type: ignore[misc, unused-ignore]
    """Lists the submissions of the exchange, except those that `inbound.why_not` or `require_listable` rejects."""

    assignments: list[str]

    def parse_assignments(self) -> list[dict[str, Any]]:
        """Return the submissions as the base class does. Log a warning about each submission that is left out."""
        if self.inbound:
            self.assignments = [path for path in self.assignments if self._can_be_listed(path)]
        return super().parse_assignments()  # type: ignore[no-any-return, unused-ignore]

    def _can_be_listed(self, path: str) -> bool:
        try:
            why = inbound.why_not(Path(path), self.parse_assignment(path)["student_id"], owned=False)
            if not why:
                read(readable.require_listable, Path(path))
        except (GraderError, OSError, RuntimeError) as error:  # RuntimeError: the name is not that of a submission
            why = str(error)
        if why:
            self.log.warning("Not listed, because %s: %s", why, shown(path))
        return not why
