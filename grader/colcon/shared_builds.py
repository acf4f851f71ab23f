"""Shared builds: colcon runs once for all packages that differ only in the text of their modules.

In a class, submissions share builds in this way. For a learner, the next `grader check` reuses an earlier build.

If setup.py and setup.cfg have the usual form, colcon copies the modules and does not read them. So the grader builds
the package once with empty modules, and then writes the modules of each submission into a copy of the install tree. The
build with empty modules contains nothing that a student could have hidden in a module. Any other package gets a
separate build.
"""

from __future__ import annotations

import re
import warnings
from collections import OrderedDict
from dataclasses import dataclass, replace
from threading import Lock
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from grader.colcon import runner
from grader.colcon.build_store import build_store, key_of
from grader.colcon.comparison import installs
from grader.colcon.predicted import SITE, predict
from grader.colcon.rebuild import renewed
from grader.errors import UnreadableError
from grader.submission.package import digest
from grader.submission.reader import read

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.colcon.build_store import BuildStore
    from grader.colcon.predicted import Predicted
    from grader.ros.installation import Ros
    from grader.submission.package import Submission

P = ParamSpec("P")
T = TypeVar("T")

MOST_BUILDS = 50
"""The maximum number of builds that are kept. The build that has not been used for the longest time is removed
first."""
MOST_TREE = 1024 * 1024
"""The maximum size of an install tree that is kept (bytes)."""
_USUAL_FOLDER = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*")
"""Matches the usual names of package folders. A package in another folder is built separately: colcon may ignore it."""


class SharedBuilds:
    """A replacement for `runner.build`. It reuses a build if two packages differ only in the text of their modules.

    `runs` counts the builds with colcon. With a `store`, builds in cells are also reused by later commands.
    """

    def __init__(self, build: Callable[..., runner.Built] = runner.build, store: BuildStore | None = None) -> None:
        self.runs = 0
        self._build = build
        self._store = store
        self._kept: OrderedDict[object, runner.Built | None] = OrderedDict()
        self._lock = Lock()  # a Dask worker has several threads

    def __call__(
        self,
        submission: Submission,
        ros: Ros,
        *,
        in_cell: bool,
        tell: Callable[[str], None],
    ) -> runner.Built:
        """Build the submission, with or without colcon. `tell` is called with a message that says whether colcon runs.

        Raises:
            MachineError: the sandbox or colcon itself does not work.
            UnreadableError: the result of the build cannot be read.
        """

        def build(package: Submission) -> runner.Built:
            self.runs += 1
            return self._build(package, ros, in_cell=in_cell, tell=tell)

        usual = _read(without_modules, submission, ros)
        if usual is None:
            return build(submission)
        reference, is_earlier = self._reference(usual, ros, build, in_cell=in_cell)
        built = _read(with_modules, submission, usual, reference) if reference is not None else None
        if reference is None or built is None:
            return build(submission)
        if is_earlier:
            tell("Using an earlier build: at most the modules differ")
        elif self._store and in_cell:
            self._store.put(key_of(usual.empty, ros), reference)
        # The time for testing causes depends on the time that a build with colcon takes.
        return replace(built, build=replace(built.build, seconds=reference.build.seconds))

    def _reference(
        self, usual: Usual, ros: Ros, build: Callable[[Submission], runner.Built], *, in_cell: bool
    ) -> tuple[runner.Built | None, bool]:
        """Return the build with empty modules, and whether it is an earlier build that is used again.

        The build is None if it failed, or if the install tree is too large to keep.
        """
        key = (usual.empty.digest, usual.empty.executable, ros, in_cell)
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
                return self._kept[key], True
        stored = self._store.get(key_of(usual.empty, ros)) if self._store and in_cell else None
        built = stored or build(usual.empty)
        reference = built if built.build.exit_code == 0 and len(built.tree) <= MOST_TREE else None
        with self._lock:
            self._kept[key] = reference
            if len(self._kept) > MOST_BUILDS:
                self._kept.popitem(last=False)
        return reference, stored is not None


def build_for(*, marks: bool) -> Callable[..., runner.Built]:
    """Return the function that builds a single submission.

    With `marks`, a build never depends on a build of an earlier command.
    """
    return runner.build if marks else SharedBuilds(store=build_store())


@dataclass(frozen=True)
class Usual:
    """A package of the usual form with empty modules, and the files that colcon is expected to install from it.

    The folder of `empty` has the name of the package. The name of the folder does not affect what colcon installs.
    """

    empty: Submission
    predicted: Predicted


def without_modules(submission: Submission, ros: Ros) -> Usual | None:
    """Return the package with empty modules, or None if the package is unusual or a module does not compile cleanly.

    If Python reports an error or a warning when it compiles a module, the package is built separately, because
    setuptools writes the same error or warning to the log of the build.

    Call this through `grader.submission.reader.read`.
    """
    predicted = predict(submission, ros, ())
    if predicted is None or not _USUAL_FOLDER.fullmatch(submission.package_dir.name):
        return None
    modules = {path for path in submission.files if f"{SITE}/{path}" in predicted.files}
    if not all(_compiles(path, submission.files[path]) for path in modules):
        return None
    files = {path: b"" if path in modules else data for path, data in submission.files.items()}
    folder = submission.package_dir.with_name(predicted.package)
    empty = replace(submission, package_dir=folder, files=files, digest=digest(files))
    predicted_of_empty = predict(empty, ros, ())
    if predicted_of_empty is None or not _differ_only_in(modules, submission, predicted, predicted_of_empty):
        return None
    return Usual(empty, predicted_of_empty)


def _differ_only_in(modules: set[str], submission: Submission, predicted: Predicted, of_empty: Predicted) -> bool:
    """Return whether the two install trees are equal except for the modules.

    They are not equal if a data file has the path of a module, or if a module is also installed as a data file.
    """
    texts = {f"{SITE}/{path}": submission.files[path] for path in modules}
    expected = {path: (texts.get(path, content), mode) for path, (content, mode) in of_empty.files.items()}
    return expected == predicted.files


def _compiles(path: str, data: bytes) -> bool:
    """Return whether Python compiles the module without a warning."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            compile(data, path, "exec", dont_inherit=True)
    except (SyntaxError, ValueError, Warning, RecursionError, MemoryError):
        return False
    return True


def with_modules(submission: Submission, usual: Usual, reference: runner.Built) -> runner.Built | None:
    """Return the build of the usual package with the modules of the submission.

    Return None if colcon did not install the predicted files. In this case, nothing can be shared.

    Call this through `grader.submission.reader.read`.
    """
    return renewed(submission, usual.empty, reference) if installs(reference.tree, usual.predicted) else None


def _read(function: Callable[P, T | None], *arguments: P.args, **keywords: P.kwargs) -> T | None:
    """Call the function in a child process. Return None if the function could not read its arguments."""
    try:
        return read(function, *arguments, **keywords)
    except UnreadableError:
        return None
