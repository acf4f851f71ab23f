"""Find the package of an exercise in a folder, or explain to a beginner why there is not exactly one.

As in colcon, a folder that contains package.xml or setup.py is a package, and all folders below it belong to the
package. In a workspace with several packages, the exercise's package is the only one with the right name.
"""

from __future__ import annotations

import errno
import os
import posixpath
import re
import stat
from dataclasses import dataclass, field
from pathlib import Path

from grader.common.words import a_list
from grader.errors import UsageError
from grader.submission import tree
from grader.submission.tree import Entry, shown

PACKAGE_FILES = ("package.xml", "setup.py")
IGNORE_MARKER = "COLCON_IGNORE"
GIVE = "Give the folder of your package: the one that contains package.xml."
_PACKED = (".zip", ".tar", ".tar.gz", ".tgz", ".tar.xz", ".tar.bz2", ".7z", ".rar")
MAX_FOLDERS = 5000
_MAX_READ = 65_536
_NAME = re.compile(rb"<name>\s*([^<]*?)\s*</name>")
MAX_NAMED = 10
"""The maximum number of files, folders or packages that an error message names."""


class NoPackageError(UsageError):
    """A folder contains no package, or no answers.toml if the exercise has no package."""


class SeveralPackagesError(UsageError):
    """A folder contains more than one package, and not exactly one of them has the name of the exercise's package."""


@dataclass
class _Search:
    """The results of the search. Paths are relative to the folder in which the search started."""

    packages: list[str] = field(default_factory=list)
    nearly: list[str] = field(default_factory=list)
    """Files whose names are almost right, such as Package.xml or setup.py.txt."""
    linked: list[str] = field(default_factory=list)
    """Links to folders. Such links are not followed."""
    ignored: list[str] = field(default_factory=list)
    """Folders that colcon ignores because they contain a marker file."""
    folders: int = 0


def find_package(root: int, name: str, wanted: str = "") -> str:
    """Return the POSIX path of the only package in the folder `root`, or "." if the package is the folder itself.

    `name` is the path as the user typed it. If there are several packages, and exactly one of them has the name
    `wanted`, return that package.

    Raises NoPackageError if there is no package, SeveralPackagesError if there is more than one package, and UsageError
    if there are too many folders.
    """
    search = _Search()
    _visit(search, root, ".", 0, name)
    if len(search.packages) == 1:
        return search.packages[0]
    if not search.packages:
        message = _none(search, root, name)
        raise NoPackageError(message)
    of_that_name = [path for path in search.packages if wanted and _is_named(wanted, root, path)]
    if len(of_that_name) == 1:
        return of_that_name[0]
    message = _several(of_that_name or search.packages, name)
    raise SeveralPackagesError(message)


def why_not_opened(error: OSError, name: str, give: str = GIVE) -> str:
    """Return a message about a path that is not a folder or cannot be read. `give` says which folder is needed."""
    path = shown(name)
    if error.errno not in (errno.ENOENT, errno.ENOTDIR):
        return f"{path} cannot be opened: it {tree.reason(error, name)}."
    if Path(name).is_file():
        return f"{path} is a file. {_for_a_file(name) if give == GIVE else give}"
    if Path(name).is_symlink():
        return f"{path} is a symlink to a path that does not exist. {give}"
    return f"There is no folder {path}{_nearest_parent(name)}. {give}"


def _visit(search: _Search, folder: int, path: str, depth: int, name: str) -> None:
    search.folders += 1
    if search.folders > MAX_FOLDERS:
        message = f"{shown(name)} contains more than {MAX_FOLDERS} folders. {GIVE}"
        raise UsageError(message)
    listing = tree.entries(folder) or []
    names = {entry.name for entry in listing if not entry.is_folder}
    if path != "." and IGNORE_MARKER in names:
        search.ignored.append(path)
        return
    if not names.isdisjoint(PACKAGE_FILES):
        search.packages.append(path)
        return
    for entry in listing:
        below = posixpath.normpath(posixpath.join(path, entry.name))
        if entry.is_folder:
            if depth < tree.MAX_DEPTH and not tree.is_left_out(entry.name, folder):
                _visit_below(search, folder, entry, below, depth, name)
        elif entry.target is not None and _is_folder_behind(entry.name, folder):
            search.linked.append(below)
        elif entry.name.lower().startswith(PACKAGE_FILES):
            search.nearly.append(below)


def _visit_below(search: _Search, folder: int, entry: Entry, path: str, depth: int, name: str) -> None:
    try:
        with tree.open_folder(entry.name, folder) as descriptor:
            _visit(search, descriptor, path, depth + 1, name)
    except OSError as error:
        # This raises an exception if the machine is at fault. Otherwise, a folder that cannot be entered counts as one
        # without a package.
        tree.reason(error, path)


def _is_folder_behind(name: str, folder: int) -> bool:
    """Return whether the symbolic link points to a folder. The result is used only in an error message.

    The folder is not opened.
    """
    try:
        return stat.S_ISDIR(os.stat(name, dir_fd=folder).st_mode)
    except OSError:
        return False


def _is_named(wanted: str, root: int, path: str) -> bool:
    """Return whether package.xml has this name. Without a name in package.xml, the name of the folder counts."""
    named = None
    try:
        with tree.open_below(root, path) as folder, tree.open_file(Path(PACKAGE_FILES[0]), parent=folder) as manifest:
            named = _NAME.search(manifest.read(_MAX_READ))
    except OSError as error:
        tree.reason(error, path)  # this raises an exception if the machine is at fault
    except ValueError:  # package.xml is a pipe or the like
        pass
    return named[1] == wanted.encode() if named else posixpath.basename(path) == wanted


def _several(packages: list[str], name: str) -> str:
    paths = [shown(posixpath.join(name, package)) for package in packages]
    return (
        f"{shown(name)} contains {len(paths)} packages: {_listed(paths)}. Give the package to grade, for example "
        f"{paths[0]}."
    )


def _none(search: _Search, root: int, name: str) -> str:
    none = f"There is no package in {shown(name)}: the grader found no package.xml and no setup.py."
    if search.nearly:
        return f"{none} {shown(search.nearly[0])} is almost right: the name must be exactly package.xml or setup.py."
    if search.linked:
        return (
            f"{none} {shown(search.linked[0])} is a link, and links are not followed: give the folder that it leads to."
        )
    if search.ignored:
        return f"{none} colcon ignores {shown(search.ignored[0])}, because it contains a file {IGNORE_MARKER}."
    for above in list(Path(name).resolve().parents)[:2]:
        if any((above / file).is_file() for file in PACKAGE_FILES):
            return f"{none} The folder is inside the package {shown(above.name)}: give that folder."
    listing = tree.entries(root)
    if listing is None:
        return f"{none} The folder contains more than {tree.MAX_ENTRIES} files and folders. {GIVE}"
    packed = [shown(entry.name) for entry in listing if entry.is_file and entry.name.lower().endswith(_PACKED)]
    if packed:
        archives = "an archive" if len(packed) == 1 else "archives"
        return f"{none} {a_list(packed)} must be unpacked: the grader does not look into {archives}. {GIVE}"
    names = [shown(entry.name) + ("/" if entry.is_folder else "") for entry in listing]
    if not names:
        return f"{none} The folder is empty. Give the folder of your package."
    return f"{none} The folder contains {_listed(names)}. {GIVE}"


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - MAX_NAMED} more" if len(names) > MAX_NAMED else ""
    return ", ".join(names[:MAX_NAMED]) + more


def _for_a_file(name: str) -> str:
    folder = Path(name).resolve().parent
    for above in (folder, *list(folder.parents)[:2]):
        if any((above / file).is_file() for file in PACKAGE_FILES):
            return f"The grader grades whole packages. Give the folder of the package: {shown(str(above))}."
    if name.lower().endswith(_PACKED):
        return "Unpack the archive, and give the folder of the package."
    if name.endswith(".py"):
        return "The grader grades whole packages. Give the folder that contains package.xml."
    return GIVE


def _nearest_parent(name: str) -> str:
    """Return a remark that names the last folder of the path that exists, or "" if this is the parent folder."""
    above = Path(name).absolute().parent
    if above.is_dir():
        return ""
    while not above.is_dir():
        above = above.parent
    return f" (the path exists up to {shown(str(above))})"
