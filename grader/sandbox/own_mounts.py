"""Own mounts: in a separate mount namespace, a process can access only the files and folders in a list.

This module is the second choice, for kernels without Landlock (landlock.py). The process needs the rights of root, or
user namespaces for ordinary users, as bubblewrap does. The process must have only one thread.
"""

from __future__ import annotations

import ctypes
import os
import platform
import stat
from contextlib import suppress
from ctypes import c_ulong
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_PIVOT_ROOT = {"x86_64": 155, "aarch64": 41}
"""The number of the system call pivot_root on each processor architecture. The C library has no function for this
call."""
_NEW_MOUNTS, _NEW_USER = 0x20000, 0x10000000
_READ_ONLY, _REMOUNT, _BIND, _RECURSIVE, _PRIVATE = 1, 32, 4096, 16384, 1 << 18
_KEPT = {
    os.ST_NOSUID: 2, os.ST_NODEV: 4, os.ST_NOEXEC: 8, os.ST_NOATIME: 1 << 10, os.ST_NODIRATIME: 1 << 11,
    os.ST_RELATIME: 1 << 21,
}  # fmt: skip
"""Mount flags that an ordinary user is not allowed to change, from statvfs(3), with their values for mount(2)."""
_DETACH = 2
_MOST_NAMES = 400
"""The maximum number of names in a path, after its links have been replaced by their targets."""
_STAGE = Path("/tmp")
_OF_THE_PROCESS = tuple(Path("/proc") / name for name in ("self", "cpuinfo", "meminfo", "stat"))


def keep_only(paths: Iterable[Path]) -> bool:
    """Permanently remove all files from this process's view, except these files and folders, which become read-only.

    A few files of /proc stay, too. Paths that do not exist are ignored. Return False if the system does not permit the
    removal.

    Raises:
        OSError: the removal has begun, and one of its steps failed.
    """
    c = ctypes.CDLL(None, use_errno=True)
    if platform.machine() not in _PIVOT_ROOT or not _unshared(c):
        return False
    if c.mount(b"none", b"/", None, c_ulong(_RECURSIVE | _PRIVATE), None) != 0:
        return False
    here = _here()
    kept = [Path(os.path.abspath(path)) for path in (*paths, *_OF_THE_PROCESS)]  # noqa: PTH100 - keeps links
    links, opened = dict(_links(kept)), dict(_opened(kept))
    if c.mount(b"tmpfs", os.fsencode(_STAGE), b"tmpfs", c_ulong(os.ST_NOSUID | os.ST_NODEV), b"mode=755") != 0:
        return False
    for path, descriptor in sorted(opened.items()):
        if not any(parent in opened for parent in path.parents):
            with suppress(OSError):
                _bind(c, descriptor, _STAGE / path.relative_to("/"))
        os.close(descriptor)
    for link, target in links.items():
        with suppress(OSError):  # the link is inside a folder that is kept
            (_STAGE / link.relative_to("/")).parent.mkdir(parents=True, exist_ok=True)
            (_STAGE / link.relative_to("/")).symlink_to(target)
    with suppress(OSError):
        (_STAGE / here.relative_to("/")).mkdir(parents=True, exist_ok=True)
    os.chdir(_STAGE)
    _require(c.syscall(_PIVOT_ROOT[platform.machine()], b".", b"."))
    _require(c.umount2(b".", _DETACH))
    _require(c.mount(None, b"/", None, c_ulong(_REMOUNT | _BIND | _READ_ONLY | os.ST_NOSUID | os.ST_NODEV), None))
    os.chdir(here)
    return True


def _unshared(c: ctypes.CDLL) -> bool:
    """Create the mount namespace (for an ordinary user, in a new user namespace). Return False if this fails."""
    user, group = os.geteuid(), os.getegid()
    if c.unshare(_NEW_MOUNTS) == 0:
        return True
    if c.unshare(_NEW_USER | _NEW_MOUNTS) != 0:
        return False
    try:
        Path("/proc/self/setgroups").write_text("deny", "ascii")
        Path("/proc/self/uid_map").write_text(f"{user} {user} 1", "ascii")
        Path("/proc/self/gid_map").write_text(f"{group} {group} 1", "ascii")
    except OSError:
        return False
    return True


def _here() -> Path:
    try:
        return Path.cwd()
    except OSError:
        return Path("/")  # the current folder was removed


def _opened(paths: Iterable[Path]) -> Iterator[tuple[Path, int]]:
    """Yield the real path and a descriptor of each existing file or folder, each only once."""
    for path in dict.fromkeys(Path(os.path.realpath(path)) for path in paths):
        with suppress(OSError):
            yield path, os.open(path, os.O_PATH | os.O_CLOEXEC | os.O_NOFOLLOW)


def _links(paths: Iterable[Path]) -> Iterator[tuple[Path, Path]]:
    """Yield the links in these paths, with their targets. The path of a link contains no other link."""
    for path in paths:
        place, rest = Path("/"), list(path.parts[1:])
        for _ in range(_MOST_NAMES):
            if not rest:
                break
            place /= rest.pop(0)
            if place.is_symlink():
                target = place.readlink()
                yield place, target
                rest = [*Path(os.path.normpath(place.parent / target)).parts[1:], *rest]
                place = Path("/")


def _bind(c: ctypes.CDLL, descriptor: int, target: Path) -> None:
    if stat.S_ISDIR(os.fstat(descriptor).st_mode):
        target.mkdir(parents=True, exist_ok=True)
    else:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.touch()
    source, to = f"/proc/self/fd/{descriptor}".encode(), os.fsencode(target)
    _require(c.mount(source, to, None, c_ulong(_BIND | _RECURSIVE), None))
    flags = os.statvfs(target).f_flag
    kept = sum(value for flag, value in _KEPT.items() if flags & flag)
    _require(c.mount(None, to, None, c_ulong(_REMOUNT | _BIND | _READ_ONLY | kept), None))


def _require(result: int) -> None:
    if result != 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))
