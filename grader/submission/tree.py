"""Read a folder that somebody else made, without trusting it.

Nothing is reached by following a link: every step down is an open relative to the folder's own descriptor, with
O_NOFOLLOW, so that swapping a folder for a link while it is being read leads nowhere.
"""

from __future__ import annotations

import errno
import os
import posixpath
import stat
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from grader.errors import MachineError

if TYPE_CHECKING:
    from collections.abc import Iterator

MAX_FILE_BYTES = 8 * 1024 * 1024
MAX_TOTAL_BYTES = 64 * 1024 * 1024
MAX_FILES = 4000
MAX_ENTRIES = 20_000
"""In one folder, and in all. A larger folder is left out whole: which of its entries come first is chance."""
MAX_DEPTH = 24
MAX_PATH_BYTES = 1000

LEFT_OUT = frozenset({"build", "install", "log"})
"""What colcon makes beside src/; often handed in with the rest."""

OF_THE_MACHINE = frozenset({errno.EIO, errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.ESTALE})
"""Faults while reading that say nothing about who made the folder."""


def shown(path: str) -> str:
    """The path in printable characters: undecodable bytes and control characters as escapes."""
    text = os.fsencode(path).decode("utf-8", "backslashreplace")
    return "".join(char if char.isprintable() else char.encode("unicode_escape").decode() for char in text)


def sort_key(path: str) -> bytes:
    """Order by the bytes of the name, the same on every machine and in every language."""
    return os.fsencode(path)


@dataclass(frozen=True)
class Entry:
    """One name in a folder, as lstat sees it; `target` is where a link points."""

    name: str
    mode: int
    size: int
    target: str | None = None

    @property
    def is_folder(self) -> bool:
        """A real folder, no link to one."""
        return stat.S_ISDIR(self.mode)

    @property
    def is_file(self) -> bool:
        """A regular file, no link to one."""
        return stat.S_ISREG(self.mode)


@dataclass
class Tree:
    """The files below a folder, by POSIX path; `executable` those with the owner's executable bit."""

    files: dict[str, bytes] = field(default_factory=dict)
    executable: set[str] = field(default_factory=set)
    rejected: dict[str, str] = field(default_factory=dict)
    """Path -> why it is not among the files, where that is a fault of the folder."""
    links: dict[str, str] = field(default_factory=dict)
    """Path -> where it points, as it is written in the link."""
    total: int = 0
    """Bytes in all files, those behind links counted once a link."""
    entries: int = 0


@contextmanager
def open_folder(name: str, parent: int | None = None) -> Iterator[int]:
    """A descriptor of a folder. With `parent` the name is looked up there and must not be a link."""
    flags = os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC | (0 if parent is None else os.O_NOFOLLOW)
    descriptor = os.open(name, flags, dir_fd=parent)
    try:
        yield descriptor
    finally:
        os.close(descriptor)


@contextmanager
def open_below(folder: int, path: str) -> Iterator[int]:
    """A descriptor of the folder at the POSIX path `path` below `folder`, "." for itself. No link on the way."""
    with ExitStack() as stack:
        for name in path.split("/"):
            folder = stack.enter_context(open_folder(name, folder))
        yield folder


def entries(folder: int) -> list[Entry] | None:
    """What a folder holds, in the order of `sort_key`; None where it is more than MAX_ENTRIES."""
    found: list[Entry] = []
    with os.scandir(folder) as scan:
        for entry in scan:
            if len(found) == MAX_ENTRIES:
                return None
            try:
                status = entry.stat(follow_symlinks=False)
                target = os.readlink(entry.name, dir_fd=folder) if stat.S_ISLNK(status.st_mode) else None
            except FileNotFoundError:  # gone since the listing
                continue
            found.append(Entry(entry.name, status.st_mode, status.st_size, target))
    return sorted(found, key=lambda entry: sort_key(entry.name))


def is_left_out(name: str, folder: int) -> bool:
    """Whether a folder called `name` in `folder` is no work of a learner's: built, hidden, cached, an environment."""
    if name.startswith(".") or name == "__pycache__" or name.endswith(".egg-info"):
        return True
    if name in LEFT_OUT:
        # A Python package may well be called log; colcon's folder of that name has no __init__.py.
        return not _exists(f"{name}/__init__.py", folder)
    return _exists(f"{name}/pyvenv.cfg", folder)


def _exists(path: str, folder: int) -> bool:
    try:
        os.stat(path, dir_fd=folder, follow_symlinks=False)
    except OSError:
        return False
    return True


def read_folder(folder: str | os.PathLike[str]) -> Tree:
    """As `read_tree`, of the folder at this path. Raises OSError where it cannot be opened."""
    with open_folder(os.fspath(folder)) as opened:
        return read_tree(opened)


def read_tree(folder: int) -> Tree:
    """All regular files below the folder, and links to them."""
    tree = Tree()
    _read_folder(tree, folder, "", 0)
    for path in tree.links:
        _resolve(tree, path)
    return tree


def _read_folder(tree: Tree, folder: int, prefix: str, depth: int) -> None:
    listing = entries(folder)
    if listing is None or tree.entries + len(listing) > MAX_ENTRIES:
        tree.rejected[prefix.rstrip("/") or "."] = f"holds more than the {MAX_ENTRIES} entries that are read"
        return
    tree.entries += len(listing)
    for entry in listing:
        path = prefix + entry.name
        if not entry.name.isprintable():
            # Python's own tools fail on such names, each in its way; nobody can import or type them.
            tree.rejected[path] = "has a name with control characters, or one that is not UTF-8"
        elif len(os.fsencode(path)) > MAX_PATH_BYTES:
            tree.rejected[path] = f"has a path of more than {MAX_PATH_BYTES} bytes"
        elif entry.target is not None:
            tree.links[path] = entry.target
        elif entry.is_file:
            if _has_room(tree, path, entry.size):
                _read_file(tree, folder, entry, path)
        elif not entry.is_folder:
            tree.rejected[path] = "is neither a file nor a folder (a pipe, a socket or a device)"
        elif not is_left_out(entry.name, folder):
            _read_below(tree, folder, entry, path, depth + 1)


def _read_below(tree: Tree, folder: int, entry: Entry, path: str, depth: int) -> None:
    if depth > MAX_DEPTH:
        tree.rejected[path] = f"lies more than {MAX_DEPTH} folders deep"
        return
    try:
        with open_folder(entry.name, folder) as below:
            _read_folder(tree, below, path + "/", depth)
    except OSError as error:
        tree.rejected[path] = reason(error, path)


def _has_room(tree: Tree, path: str, size: int) -> bool:
    if len(tree.files) >= MAX_FILES:
        tree.rejected[path] = f"is beyond the {MAX_FILES} files that are read"
    elif size > MAX_FILE_BYTES:
        tree.rejected[path] = f"has {size} bytes, more than the {MAX_FILE_BYTES} that a file may have"
    elif tree.total + size > MAX_TOTAL_BYTES:
        tree.rejected[path] = f"is beyond the {MAX_TOTAL_BYTES} bytes that are read in all"
    else:
        return True
    return False


def _read_file(tree: Tree, folder: int, entry: Entry, path: str) -> None:
    # O_NONBLOCK: a pipe that took the file's place since the listing must not hold us up.
    flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
    try:
        descriptor = os.open(entry.name, flags, dir_fd=folder)
        with os.fdopen(descriptor, "rb") as file:
            status = os.fstat(descriptor)
            data = file.read(entry.size + 1) if stat.S_ISREG(status.st_mode) else None
    except OSError as error:
        tree.rejected[path] = reason(error, path)
        return
    if data is None or len(data) != entry.size:
        tree.rejected[path] = "changed while it was read"
        return
    _add(tree, path, data, executable=bool(status.st_mode & stat.S_IXUSR))


def _add(tree: Tree, path: str, data: bytes, *, executable: bool) -> None:
    tree.files[path] = data
    tree.total += len(data)
    if executable:
        tree.executable.add(path)


def _resolve(tree: Tree, path: str) -> None:
    """Give a link the content of the file it means, if that is one of ours: looked up by name, never on the disk."""
    at = path
    for _ in range(len(tree.links)):
        target = tree.links[at]
        if target.startswith("/"):
            tree.rejected[path] = f"is a link to {shown(target)}, a place on one machine only"
            return
        at = posixpath.normpath(posixpath.join(posixpath.dirname(at), target))
        if at == ".." or at.startswith("../"):
            tree.rejected[path] = f"is a link to {shown(target)}, which lies outside the package"
            return
        if at not in tree.links:
            break
    if at not in tree.files:
        tree.rejected[path] = f"is a link to {shown(tree.links[path])}, which is no file of the package"
    elif _has_room(tree, path, len(tree.files[at])):
        _add(tree, path, tree.files[at], executable=at in tree.executable)


def reason(error: OSError, path: str) -> str:
    """Why something could not be read, for `rejected`; a fault of the machine is raised instead."""
    if error.errno in OF_THE_MACHINE:
        message = f"{shown(path)} could not be read: {error.strerror}. This is a fault of the machine; try again."
        raise MachineError(message) from error
    if error.errno in (errno.EACCES, errno.EPERM):
        return "may not be read (its permissions forbid it)"
    if error.errno in (errno.ELOOP, errno.ENOTDIR, errno.ENOENT):
        return "changed while it was read"
    return f"cannot be read ({error.strerror})"
