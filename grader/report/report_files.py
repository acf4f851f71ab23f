"""Write the files that the options `--json`, `--image` and `--html` request."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from grader.evidence.evidence import Evidence
    from grader.report.report import Report


def save_files(evidence: Evidence, report: Report, json: Path | None, image: Path | None, html: Path | None) -> None:
    """Write the report to the files `json` and `html`, and a picture of the turtle's path to the file `image`.

    A file that is None is not written.

    Raises:
        UsageError: a path is not valid or not writable.
        MachineError: the disk is full, or the machine failed in another way.
    """
    if json:
        from grader.report.json import to_json
        from grader.report.output_file import write

        write(json, to_json(report).encode())
    if image:
        from grader.report.picture import save_picture

        save_picture(evidence, report, image)
    if html:
        from grader.report.html import save_html

        save_html(evidence, report, html)
