"""Symbolic and hard links in the archives of students, and devices."""

from __future__ import annotations

import io
import tarfile
from typing import TYPE_CHECKING

import pytest

from grader.classroom import unpack
from grader.classroom.archives import unpacked
from grader.submission.package import open_submission
from grader.tests.classroom.made_archives import files, link, member, tar, zipped

if TYPE_CHECKING:
    from pathlib import Path


def test_a_link_to_a_file_of_the_archive_is_this_file(tmp_path: Path) -> None:
    """As in a folder. Students link a file to another place of their workspace."""
    assert files(zipped(tmp_path / "a.zip", (link("pkg/b"), b"../a"), ("a", b"1"))) == {"a": b"1", "pkg/b": b"1"}
    with tarfile.open(tmp_path / "a.tar", "w") as archive:
        archive.addfile(member("pkg/c", tarfile.SYMTYPE, "./b"))
        archive.addfile(member("pkg/b", tarfile.SYMTYPE, "../a"))
        archive.addfile(member("pkg/loop", tarfile.SYMTYPE, "loop"))
        archive.addfile(member("pkg/hard", tarfile.LNKTYPE, "a"))
        archive.addfile(member("pkg/twice", tarfile.SYMTYPE, "../a"))
        for name in ("a", "pkg/twice"):
            info = member(name)
            info.size = 1
            archive.addfile(info, io.BytesIO(name[-1:].encode()))
    linked = dict.fromkeys(("a", "pkg/b", "pkg/c", "pkg/hard"), b"a")
    assert files(tmp_path / "a.tar", {"pkg/loop": "loop"}) == {**linked, "pkg/twice": b"e"}


def test_links_do_not_exceed_the_size_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unpack, "MOST_BYTES", 10)
    with pytest.raises(unpack.LargeArchiveError):
        files(zipped(tmp_path / "a.zip", (link("b"), b"a"), ("a", b"123456")))


def test_links_and_devices_are_skipped_and_nothing_is_written_through_them(tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    archive = tar(
        tmp_path / "a.tar.gz",
        (member("way", tarfile.SYMTYPE, str(outside)), b""),
        (member("way/file"), b"1"),
        (member("hard", tarfile.LNKTYPE, "/etc/passwd"), b""),
        (member("null", tarfile.CHRTYPE), b""),
        (member("pipe", tarfile.FIFOTYPE), b""),
    )
    assert files(archive) == {"way/file": b"1"}
    assert list(outside.iterdir()) == []
    archive = zipped(tmp_path / "a.zip", (link("link"), b"/etc/passwd"), ("a", b"1"), ("link/below", b"2"))
    assert files(archive) == {"a": b"1", "link/below": b"2"}


def test_nothing_is_written_through_a_link_that_another_link_is_below(tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    archive = tar(
        tmp_path / "a.tar",
        (member("way", tarfile.SYMTYPE, str(outside)), b""),
        (member("way/below", tarfile.SYMTYPE, "/etc/passwd"), b""),
        (member("file", tarfile.SYMTYPE, "../x"), b""),
        (member("file"), b"1"),
    )
    assert files(archive, {"way/below": "/etc/passwd"}) == {"file": b"1"}
    assert list(outside.iterdir()) == []


@pytest.mark.parametrize("ending", ["zip", "tar.gz"])
def test_a_link_that_leads_to_no_file_is_judged_as_in_a_folder(tmp_path: Path, ending: str) -> None:
    """Otherwise, the report would say that the file of the node is missing."""
    targets = {"a.py": "../../a.py", "b.py": "/home/me/b.py", "c.py": "d.py", "e": "sub", "loop": "loop"}
    targets = {f"pkg/{name}": target for name, target in targets.items()}
    archive = tmp_path / f"ben.{ending}"
    if ending == "zip":
        linked = ((link(name), to.encode()) for name, to in targets.items())
        zipped(archive, ("package.xml", b""), ("pkg/sub/f.py", b"1"), *linked)
    else:
        symbolic = ((member(name, tarfile.SYMTYPE, to), b"") for name, to in targets.items())
        tar(archive, (member("package.xml"), b""), (member("pkg/sub/f.py"), b"1"), *symbolic)
    folder = tmp_path / "ben"
    (folder / "pkg/sub").mkdir(parents=True)
    (folder / "package.xml").touch()
    (folder / "pkg/sub/f.py").write_text("1")
    for name, to in targets.items():
        (folder / name).symlink_to(to)
    as_folder = open_submission(folder)
    with unpacked(archive) as place:
        as_archive = open_submission(place)
    assert len(as_folder.rejected) == len(targets)
    assert (as_archive.files, as_archive.rejected) == (as_folder.files, as_folder.rejected)
