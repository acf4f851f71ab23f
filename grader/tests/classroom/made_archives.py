"""Archives for tests, and what is in them after they have been unpacked."""

from __future__ import annotations

import io
import stat
import tarfile
import zipfile
from typing import TYPE_CHECKING

from grader.classroom.archives import unpacked

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path


def tar(file: Path, *members: tuple[tarfile.TarInfo, bytes], how: str = "w:gz") -> Path:
    with tarfile.open(file, how) as archive:  # type: ignore[call-overload]
        for info, content in members:
            info.size = len(content)
            archive.addfile(info, io.BytesIO(content))
    return file


def member(name: str, kind: bytes = tarfile.REGTYPE, link: str = "", mode: int = 0o644) -> tarfile.TarInfo:
    info = tarfile.TarInfo(name)
    info.type, info.linkname, info.mode = kind, link, mode
    return info


def zipped(file: Path, *members: tuple[str | zipfile.ZipInfo, bytes]) -> Path:
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members:
            archive.writestr(name, content)
    return file


def link(name: str) -> zipfile.ZipInfo:
    """Return the entry of a symbolic link in a zip archive, whose content is the target."""
    info = zipfile.ZipInfo(name)
    info.external_attr = (stat.S_IFLNK | 0o777) << 16
    return info


def files(archive: Path, links: Mapping[str, str] = {}) -> dict[str, bytes]:
    """Return the files in the archive, which must contain exactly these symbolic links."""
    with unpacked(archive) as folder:
        every = {str(path.relative_to(folder)): path for path in folder.rglob("*")}
        found = {name: path for name, path in every.items() if not stat.S_ISDIR(path.lstat().st_mode)}
        assert {name: str(path.readlink()) for name, path in found.items() if path.is_symlink()} == links
        plain = {name: path for name, path in found.items() if name not in links}
        assert all(stat.S_ISREG(path.lstat().st_mode) for path in plain.values())
        return {name: path.read_bytes() for name, path in plain.items()}
