"""Archives that students hand in, and archives that attackers create."""

from __future__ import annotations

import errno
import os
import platform
import stat
import tarfile
import tempfile
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

import pytest

from grader.classroom import archives, unpack
from grader.classroom.archives import copied, sha256_of, stem, unpacked
from grader.classroom.unpack import Member, NotUnpackedError
from grader.errors import DiskError
from grader.submission import reader
from grader.tests.classroom.made_archives import files, member, tar, zipped

MANY = b"0" * 1024 * 1024


def why_not(archive: Path) -> str:
    with pytest.raises(NotUnpackedError) as error, unpacked(archive):
        pass
    return str(error.value)


@pytest.mark.parametrize(
    ("name", "how"), [("a.tar.gz", "w:gz"), ("a.tgz", "w:gz"), ("a.tar", "w"), ("A.TAR.GZ", "w:gz")]
)
def test_tar_archives_are_unpacked(tmp_path: Path, name: str, how: str) -> None:
    archive = tar(tmp_path / name, (member("p/package.xml"), b"<package/>"), (member("p/é.py"), b"1"), how=how)
    assert files(archive) == {"p/package.xml": b"<package/>", "p/é.py": b"1"}


def test_zip_archives_are_unpacked_also_from_windows(tmp_path: Path) -> None:
    archive = zipped(tmp_path / "a.zip", ("p/", b""), ("p/package.xml", b"<package/>"), ("p\\p\\node.py", b"1"))
    assert files(archive) == {"p/package.xml": b"<package/>", "p/p/node.py": b"1"}


def test_only_the_executable_bit_is_kept(tmp_path: Path) -> None:
    info = zipfile.ZipInfo("run.py")
    info.external_attr = (stat.S_IFREG | 0o6777) << 16
    for archive in (
        zipped(tmp_path / "a.zip", (info, b"1")),
        tar(tmp_path / "a.tar.gz", (member("run.py", mode=0o6777), b"1")),
    ):
        with unpacked(archive) as folder:
            assert stat.S_IMODE((folder / "run.py").stat().st_mode) == 0o755


def test_unpacked_files_are_removed_afterwards(tmp_path: Path) -> None:
    with unpacked(zipped(tmp_path / "a.zip", ("a", b"1"))) as folder:
        assert folder.is_dir()
    assert not folder.exists()


@pytest.mark.parametrize("name", ["../out", "a/../../out", "/tmp/out", "..\\out"])
def test_a_path_that_leads_out_is_refused(tmp_path: Path, name: str) -> None:
    assert 'path with ".."' in why_not(zipped(tmp_path / "a.zip", (name, b"1")))
    if "\\" not in name:
        assert 'path with ".."' in why_not(tar(tmp_path / "a.tar.gz", (member(name), b"1")))
    assert not (tmp_path / "out").exists()


def test_a_zip_bomb_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    archive = zipped(tmp_path / "a.zip", *((f"f{number}", MANY) for number in range(100)))
    assert archive.stat().st_size < 1024 * 1024
    assert "is larger than the allowed 96 MiB after unpacking" in why_not(archive)


@pytest.mark.parametrize("kind", ["files", "header"])
def test_a_tar_bomb_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str) -> None:
    monkeypatch.setattr(unpack, "MOST_BYTES", 2 * len(MANY))
    monkeypatch.setattr(unpack, "MOST_ENTRIES", 100)
    archive = tmp_path / "a.tar.gz"
    if kind == "files":
        tar(archive, *((member(f"f{number}"), MANY) for number in range(4)))
    else:  # tarfile reads a name of any length completely
        info = member("long")
        info.pax_headers = {"path": "a" * 4 * len(MANY)}
        with tarfile.open(archive, "w:gz", format=tarfile.PAX_FORMAT) as packed:
            packed.addfile(info)
    assert "is larger than the allowed 2 MiB after unpacking" in why_not(archive)


def test_a_zip_that_understates_its_sizes_is_refused(tmp_path: Path) -> None:
    archive = zipped(tmp_path / "a.zip", ("f", MANY * 120))
    data = archive.read_bytes()
    size = (120 * 1024 * 1024).to_bytes(4, "little")
    archive.write_bytes(data.replace(size, (100).to_bytes(4, "little")))
    assert why_not(archive)


def test_too_many_files_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unpack, "MOST_ENTRIES", 10)
    archive = zipped(tmp_path / "a.zip", *((f"f{number}", b"") for number in range(11)))
    assert "contains more than 10 entries" in why_not(archive)


def test_a_file_and_a_folder_of_one_name_are_refused(tmp_path: Path) -> None:
    assert "both as a file and as a folder" in why_not(zipped(tmp_path / "a.zip", ("a", b"1"), ("a/b", b"2")))
    assert "both as a file and as a folder" in why_not(zipped(tmp_path / "b.zip", ("a/b", b"1"), ("a", b"2")))


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.zip", b"PK\x03\x04 and no more", "is not a .zip or .tar.gz"),
        ("a.tar.gz", b"\x1f\x8b\x08\x00 broken", "is not a .zip or .tar.gz"),
        ("a.zip", b"", "is not a .zip or .tar.gz"),
        ("a.rar", b"Rar!", "hand in a .zip or a .tar.gz"),
        ("a.7z", b"7z", "hand in a .zip or a .tar.gz"),
    ],
)
def test_a_file_that_is_not_an_archive_is_refused_with_the_reason(
    tmp_path: Path, name: str, content: bytes, said: str
) -> None:
    (tmp_path / name).write_bytes(content)
    assert said in why_not(tmp_path / name)


def test_a_zip_with_a_password_is_refused(tmp_path: Path) -> None:
    archive = zipped(tmp_path / "a.zip", ("a", b"1"))
    data = bytearray(archive.read_bytes())
    for head, flags in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        data[data.index(head) + flags] |= 1
    archive.write_bytes(data)
    assert "password" in why_not(archive)


def test_unpacking_that_takes_too_long_ends_only_its_own_process(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def endless(_: str) -> NoReturn:
        while True:
            pass

    monkeypatch.setattr(unpack, "_parts", endless)
    monkeypatch.setattr(reader, "CPU_S", 1)
    assert "could not be unpacked within" in why_not(zipped(tmp_path / "a.zip", ("a", b"1")))


@pytest.mark.skipif(platform.machine() != "x86_64", reason="the filter is for x86-64")
def test_a_hole_in_unpacking_reaches_no_other_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Archives are read in a confined process, in which code can neither write files nor start a program."""

    def attack(_: str) -> tuple[str]:
        for attempt in (lambda: (tmp_path / "owned").touch(), lambda: os.execv("/bin/true", ["true"]), os.fork):
            with suppress(OSError):
                attempt()
                return ("succeeded",)
        return ("failed",)

    monkeypatch.setattr(unpack, "_parts", attack)
    assert files(zipped(tmp_path / "a.zip", ("a", b"1"))) == {"failed": b"1"}
    assert not (tmp_path / "owned").exists()


def test_nothing_is_written_through_a_link_on_a_disk_that_ignores_capital_letters(tmp_path: Path) -> None:
    """On such a disk, the file a/owned of an archive would be below its link A."""
    (tmp_path / "theirs").mkdir()
    (tmp_path / "folder").mkdir()
    link = Member(("a",), link=str(tmp_path / "theirs"))
    with pytest.raises(NotUnpackedError, match="contains a/owned below a link"):
        archives._write_all([link, Member(("a", "owned"), content=b"1")], tmp_path / "folder")
    with pytest.raises(NotUnpackedError, match="contains a/owned/x below a link"):
        archives._write_all([link, Member(("a", "owned", "x"), content=b"1")], tmp_path / "folder")
    archives._write_all([link, Member(("a",), content=b"1")], tmp_path / "folder")
    assert (tmp_path / "folder/a").read_bytes() == b"1"
    assert list((tmp_path / "theirs").iterdir()) == []


@pytest.mark.parametrize("fails", ["folder", "file"])
def test_a_full_disk_is_not_the_fault_of_the_archive(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fails: str
) -> None:
    archive = zipped(tmp_path / "a.zip", ("a", b"1"))

    def full(*_: object, **__: object) -> NoReturn:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    if fails == "folder":
        monkeypatch.setattr(tempfile, "TemporaryDirectory", full)
    else:
        monkeypatch.setattr(archives, "_file_of_ours", lambda _: Path("/dev/full").open("wb", buffering=0))  # noqa: SIM115
    with pytest.raises(DiskError, match="No space left on device"), copied(archive):
        pass


def test_the_copy_of_an_archive_is_unpacked_and_has_the_hash_of_the_archive(tmp_path: Path) -> None:
    for name in ("a.zip", "b.TAR.GZ", "c.rar", "\udcff.zip"):
        archive = zipped(tmp_path / name, ("a", b"1"))
        with copied(archive) as copy:
            assert copy.sha256 == sha256_of(archive)
            archive.unlink()
            if name.endswith(".rar"):
                with pytest.raises(NotUnpackedError, match=r"hand in a \.zip"), copy.unpacked():
                    pass
            else:
                with copy.unpacked() as folder:
                    assert [path.name for path in folder.iterdir()] == ["a"]


@pytest.mark.parametrize(
    ("name", "expected"),
    [("ann.zip", "ann"), ("ann.b.TAR.GZ", "ann.b"), ("ann.rar", "ann"), ("ann.txt", None), (".zip", None)],
)
def test_the_name_of_an_archive_is_the_student(name: str, expected: str | None) -> None:
    assert stem(name) == expected
