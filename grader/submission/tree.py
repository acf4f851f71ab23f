"""Read a folder from an untrusted source.

No link below the folder is followed. Every folder is opened relative to the descriptor of its parent folder, with
O_NOFOLLOW. Even if a folder is replaced with a link while the folder is being read, the link is not followed.
"""

from __future__ import annotations

import errno
import os
import posixpath
import stat
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, TYPE_CHECKING

from grader.errors import MachineError

if TYPE_CHECKING:
    from collections.abc import Iterator

MAX_FILE_BYTES = 8 * 1024 * 1024
MAX_TOTAL_BYTES = 64 * 1024 * 1024
MAX_FILES = 4000
MAX_ENTRIES = 20_000
"""The maximum number of entries in one folder, and in total. A folder with more entries is left out as a whole, because
the system lists the entries of a folder in an arbitrary order."""
MAX_DEPTH = 24
MAX_PATH_BYTES = 1000

LEFT_OUT = frozenset({"build", "install", "log"})
"""Folders that colcon creates next to src/. Students often submit them."""

OF_THE_MACHINE = frozenset({errno.EIO, errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.ESTALE})
"""Errors that are caused by the machine, and have nothing to do with the student."""


def shown(path: str) -> str:
    """Return the path in printable characters. Control characters and bytes that are not UTF-8 are escaped."""
    text = os.fsencode(path).decode("utf-8", "backslashreplace")
    return "".join(char if char.isprintable() else char.encode("unicode_escape").decode() for char in text)


def sort_key(path: str) -> bytes:
    """Return the sort key of a name: its bytes, so that the order is the same on every machine and in every locale."""
    return os.fsencode(path)


@dataclass(frozen=True)
class Entry:
    """An entry in a folder, with the values that `os.lstat` returned. `target` is the target of a link."""

    name: str
    mode: int
    size: int
    target: str | None = None

    @property
    def is_folder(self) -> bool:
        """Whether the entry is a folder, and not a link to a folder."""
        return stat.S_ISDIR(self.mode)

    @property
    def is_file(self) -> bool:
        """Whether the entry is a regular file, and not a link to a file."""
        return stat.S_ISREG(self.mode)


@dataclass
class Tree:
    """The files below a folder, by POSIX path. `executable` contains the files that their owner can execute."""

    files: dict[str, bytes] = field(default_factory=dict)
    executable: set[str] = field(default_factory=set)
    rejected: dict[str, str] = field(default_factory=dict)
    """Maps a path to the reason why the file or folder is missing from `files`, if the student's folder is at fault."""
    links: dict[str, str] = field(default_factory=dict)
    """Maps the path of a link to its target, as written in the link."""
    total: int = 0
    """The total size of all files (bytes). A link to a file adds the size of the file once more."""
    entries: int = 0


@contextmanager
def open_folder(name: str, parent: int | None = None, *, follow: bool = False) -> Iterator[int]:
    """Open a folder, and yield its descriptor.

    With `parent`, the name is looked up in the folder with this descriptor. With `follow`, the name may be a link.
    """
    flags = os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC | (0 if follow else os.O_NOFOLLOW)
    descriptor = os.open(name, flags, dir_fd=parent)
    try:
        yield descriptor
    finally:
        os.close(descriptor)


def open_file(path: Path, *, at: Path | None = None, parent: int | None = None) -> IO[bytes]:
    """Open a regular file. A link to the file is never followed, and the function never waits for a pipe.

    See `require_path` for the meaning of `at`. With `parent`, the path begins at the folder with this descriptor.

    Raises:
        OSError: the file cannot be opened.
        ValueError: the entry is not a regular file.
    """
    with ExitStack() as stack:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC, dir_fd=parent)
        file = stack.enter_context(os.fdopen(descriptor, "rb"))
        if at is not None:
            require_path(descriptor, at)
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            message = f"{path.name} is not a regular file"
            raise ValueError(message)
        stack.pop_all()
        return file


def require_path(descriptor: int, path: Path) -> None:
    """Raise OSError if an opened file or folder is not at this absolute path.

    Without this check, a student could replace a folder with a link after the path was chosen.
    """
    if Path("/proc/self/fd", str(descriptor)).readlink() != path:
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))


@contextmanager
def open_below(folder: int, path: str) -> Iterator[int]:
    """Open the folder at the POSIX path `path` below `folder` ("." is `folder` itself). No link is followed."""
    with ExitStack() as stack:
        for name in path.split("/"):
            folder = stack.enter_context(open_folder(name, folder))
        yield folder


def entries(folder: int) -> list[Entry] | None:
    """Return the entries in a folder in the order of `sort_key`, or None if there are more than MAX_ENTRIES."""
    found: list[Entry] = []
    with os.scandir(folder) as scan:
        for entry in scan:
            if len(found) == MAX_ENTRIES:
                return None
            try:
                status = entry.stat(follow_symlinks=False)
                target = os.readlink(entry.name, dir_fd=folder) if stat.S_ISLNK(status.st_mode) else None
            except FileNotFoundError:  # removed after the listing
                continue
            found.append(Entry(entry.name, status.st_mode, status.st_size, target))
    return sorted(found, key=lambda entry: sort_key(entry.name))


def is_left_out(name: str, folder: int) -> bool:
    """Return whether the entry `name` in `folder` is left out of the submission.

    Build folders, hidden folders, caches and virtual environments are left out.
    """
    if name.startswith(".") or name == "__pycache__" or name.endswith(".egg-info"):
        return True
    if name in LEFT_OUT:
        # A Python package may be named log. The folder log that colcon creates has no __init__.py.
        return not _exists(f"{name}/__init__.py", folder)
    return _exists(f"{name}/pyvenv.cfg", folder)


def _exists(path: str, folder: int) -> bool:
    try:
        os.stat(path, dir_fd=folder, follow_symlinks=False)
    except OSError:
        return False
    return True


def read_folder(folder: str | os.PathLike[str], *, follow: bool = True) -> Tree:
    """Call `read_tree` for the folder at this path. With `follow`, the path may be a link to a folder.

    Raises:
        OSError: the folder cannot be opened.
    """
    with open_folder(os.fspath(folder), follow=follow) as opened:
        return read_tree(opened)


def read_tree(folder: int) -> Tree:
    """Return the regular files below the folder that are within the limits, and the links to those files."""
    tree = Tree()
    _read_folder(tree, folder, "", 0)
    for path in tree.links:
        _resolve(tree, path)
    return tree


def _read_folder(tree: Tree, folder: int, prefix: str, depth: int) -> None:
    listing = entries(folder)
    if listing is None or tree.entries + len(listing) > MAX_ENTRIES:
        tree.rejected[prefix.rstrip("/") or "."] = f"is beyond the limit of {MAX_ENTRIES} files and folders"
        return
    tree.entries += len(listing)
    for entry in listing:
        path = prefix + entry.name
        if not entry.name.isprintable():
            # Python's tools fail on these names, and nobody can import or type them.
            tree.rejected[path] = "has a name with characters that cannot be printed, or one that is not UTF-8"
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
        tree.rejected[path] = f"is nested more than {MAX_DEPTH} folders deep"
        return
    try:
        with open_folder(entry.name, folder) as below:
            _read_folder(tree, below, path + "/", depth)
    except OSError as error:
        tree.rejected[path] = reason(error, path)


def _has_room(tree: Tree, path: str, size: int) -> bool:
    if len(tree.files) >= MAX_FILES:
        tree.rejected[path] = f"is beyond the limit of {MAX_FILES} files"
    elif size > MAX_FILE_BYTES:
        tree.rejected[path] = f"has {size} bytes; a file may have at most {MAX_FILE_BYTES}"
    elif tree.total + size > MAX_TOTAL_BYTES:
        tree.rejected[path] = f"is beyond the limit of {MAX_TOTAL_BYTES} bytes in total"
    else:
        return True
    return False


def _read_file(tree: Tree, folder: int, entry: Entry, path: str) -> None:
    # With O_NONBLOCK, opening does not block if a pipe has replaced the file since the listing.
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
        tree.rejected[path] = "changed while it was being read"
        return
    _add(tree, path, data, executable=bool(status.st_mode & stat.S_IXUSR))


def _add(tree: Tree, path: str, data: bytes, *, executable: bool) -> None:
    tree.files[path] = data
    tree.total += len(data)
    if executable:
        tree.executable.add(path)


def _resolve(tree: Tree, path: str) -> None:
    """Replace a link with the content of its target, if the target is one of the files.

    No file is read from the disk to resolve a link.
    """
    at = path
    for _ in range(len(tree.links)):
        target = tree.links[at]
        if target.startswith("/"):
            tree.rejected[path] = f"is a link to {shown(target)}, an absolute path, which can differ on another machine"
            return
        at = posixpath.normpath(posixpath.join(posixpath.dirname(at), target))
        if at == ".." or at.startswith("../"):
            tree.rejected[path] = f"is a link to {shown(target)}, which is outside the package"
            return
        if at not in tree.links:
            break
    if at not in tree.files:
        tree.rejected[path] = f"is a link to {shown(tree.links[path])}, which is not a file of the package"
    elif _has_room(tree, path, len(tree.files[at])):
        _add(tree, path, tree.files[at], executable=at in tree.executable)


def reason(error: OSError, path: str) -> str:
    """Return the text for `rejected` that says why a path could not be read.

    If the machine is at fault, raise MachineError instead.
    """
    if error.errno in OF_THE_MACHINE:
        message = f"{shown(path)} could not be read: {error.strerror}. This is the machine's fault; try again."
        raise MachineError(message) from error
    if error.errno in (errno.EACCES, errno.EPERM):
        return "cannot be read because of its permissions"
    if error.errno in (errno.ELOOP, errno.ENOTDIR, errno.ENOENT):
        return "changed while it was being read"
    return f"cannot be read ({error.strerror})"
