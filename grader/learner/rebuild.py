"""Rebuild: what `colcon build --symlink-install` gives a learner: a changed module needs no new build.

Where since the last build only the text of installed modules changed, the new text takes the old one's place in the
install tree, and colcon is not run; any other change builds anew.
"""

from __future__ import annotations

import io
import tarfile
from dataclasses import replace
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from grader.colcon import runner
from grader.submission.reader import read

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.ros.installation import Ros
    from grader.submission.package import Submission


class Rebuild:
    """Stands in for `workspace.build`; `runs` counts how often colcon was run."""

    def __init__(self) -> None:
        self.runs = 0
        self._last: tuple[Submission, runner.Built] | None = None

    def __call__(
        self,
        submission: Submission,
        ros: Ros,
        *,
        in_cell: bool,
        tell: Callable[[str], None],
    ) -> runner.Built:
        """Build the submission, with colcon or without; `tell` hears which."""
        built = read(renewed, submission, *self._last) if self._last else None
        if built is not None:
            tell("Taking the last build, with the modules as they are now")
        else:
            self.runs += 1
            built = runner.build(submission, ros, in_cell=in_cell, tell=tell)
        self._last = (submission, built)
        return built


def renewed(submission: Submission, before: Submission, built: runner.Built) -> runner.Built | None:
    """What was `built` of a submission `before`, with the modules of this one; None where more than those differ."""
    if submission.files.keys() != before.files.keys() or submission.executable != before.executable:
        return None
    changed = {path: data for path, data in submission.files.items() if data != before.files[path]}
    installed = {path: _installed(path, built) for path in changed}
    if built.build.exit_code != 0 or not all(installed.values()):
        return None
    texts = {f"{built.build.package}/{place}": changed[path] for path, place in installed.items() if place}
    return runner.Built(replace(built.build, seconds=0.0), _with_texts(built.tree, texts))


def _installed(path: str, built: runner.Built) -> str | None:
    """Where a module of the submission was installed; None for what is no module, or was not."""
    if not path.endswith(".py") or "/" not in path:
        return None
    places = [place for place in built.build.installed if place.endswith(f"/site-packages/{path}")]
    return places[0] if len(places) == 1 else None


def _with_texts(tree: bytes, texts: dict[str, bytes]) -> bytes:
    """The tree with these members' contents, and without what Python compiled of the old ones."""
    stale = {str(PurePosixPath(path).parent / "__pycache__" / f"{PurePosixPath(path).stem}.") for path in texts}
    renewed = io.BytesIO()
    with tarfile.open(fileobj=io.BytesIO(tree)) as old, tarfile.open(fileobj=renewed, mode="w") as new:
        for member in old:
            path = str(PurePosixPath(member.name))
            if any(path.startswith(prefix) for prefix in stale):
                continue
            content = texts.get(path)
            if content is not None:
                member.size = len(content)
                new.addfile(member, io.BytesIO(content))
            else:
                new.addfile(member, old.extractfile(member) if member.isreg() else None)
    return renewed.getvalue()
