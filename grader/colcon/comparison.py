"""Compare the install tree of a build with the predicted install tree."""

from __future__ import annotations

import re
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from grader.sandbox.tar_stream import read_all

if TYPE_CHECKING:
    from grader.colcon.predicted import Predicted

_MOST_MEMBERS = 2000
_FILE, _FOLDER = (b"0", b"\0"), b"5"
_OF_COLCON = re.compile(r"COLCON_IGNORE|\.colcon_install_layout|(local_)?setup\.\w+|_local_setup_util_\w+\.py")
"""The files that colcon adds to the install tree outside the package. The grader does not use these files to set the
environment of a node."""
_OF_PACKAGE = r"share/{name}/package\.\w+|share/{name}/hook/\w+\.\w+|share/colcon-core/packages/{name}"
_OF_METADATA = r"PKG-INFO|SOURCES\.txt|dependency_links\.txt|requires\.txt|top_level\.txt|zip-safe|not-zip-safe"


def installs(tree: bytes, predicted: Predicted) -> bool:
    """Return whether the tree has exactly the predicted files, apart from those that colcon and setuptools may add.

    The comparison includes contents, permissions and folders. Call this through `grader.submission.reader.read`.
    """
    members = read_all(tree, _MOST_MEMBERS)
    if members is None:
        return False
    wanted = {PurePosixPath(predicted.package, path): file for path, file in predicted.files.items()}
    added = _added(predicted)
    files, folders = set(), set()
    for path, member in members:
        if member.kind == _FOLDER and member.mode == 0o755:
            folders.add(path)
            continue
        if member.kind not in _FILE:
            return False
        if path in wanted:
            if (member.content(tree), member.mode) != wanted[path]:
                return False
        elif not added.fullmatch(str(path)):
            return False
        files.add(path)
    return files >= wanted.keys() and folders == {folder for path in files for folder in path.parents}


def _added(predicted: Predicted) -> re.Pattern[str]:
    """Return a pattern for the files that colcon and setuptools add."""
    name = re.escape(predicted.package)
    package = _OF_PACKAGE.format(name=name)
    return re.compile(rf"{_OF_COLCON.pattern}|{name}/({package}|{re.escape(predicted.metadata)}/({_OF_METADATA}))")
