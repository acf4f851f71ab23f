"""A variant of nbgrader's step that releases feedback, which one submission cannot stop.

nbgrader reads the time of a submission, and its secret, from which nbgrader makes the name of the page with the
feedback. A student can remove these files, or fill them with any bytes.
"""

from __future__ import annotations

import glob

from nbgrader.exchange.default import ExchangeReleaseFeedback

from grader.submission.tree import shown


class BoundedReleaseFeedback(ExchangeReleaseFeedback):  # type: ignore[misc, unused-ignore]
    """Releases the feedback of each submission separately."""

    src_path: str

    def copy_files(self) -> None:
        """Copy the pages as the base class does. If a page cannot be released, log a warning and continue."""
        for folder in sorted(glob.glob(self.src_path)):  # noqa: PTH207 - the path is a pattern, as in the base class
            self.src_path = glob.escape(folder)
            try:
                super().copy_files()
            except (OSError, ValueError) as error:  # ValueError: bytes that are not UTF-8
                self.log.warning("The feedback in %s was not released: %s", shown(folder), error)
