from __future__ import annotations

import io
import subprocess
import tarfile
import time
from pathlib import Path, PurePosixPath

from grader.sandbox.tar_stream import read_tar


def header(name: bytes, size: bytes, kind: bytes = b"0") -> bytes:
    fields = name.ljust(100, b"\0") + b"0000644\0" + b"0000000\0" * 2 + size + b"0" * 11 + b"\0"
    block = (fields + b" " * 8 + kind).ljust(512, b"\0")
    return block[:148] + b"%06o\0 " % sum(block) + block[156:]


def test_it_reads_what_gnu_tar_writes(tmp_path: Path) -> None:
    long = "a" * 60 + "/" + "b" * 120
    for name in ("pkg/__init__.py", long):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text(name)
    (tmp_path / "link").symlink_to("c" * 200)
    stream = subprocess.run(
        ["tar", "-c", "--format=gnu", "-C", str(tmp_path), "."], capture_output=True, check=True
    ).stdout
    found = read_tar(stream, 100)
    assert set(found) == {PurePosixPath("pkg/__init__.py"), PurePosixPath(long), PurePosixPath("link")}
    member = found[PurePosixPath(long)]
    assert stream[member.start : member.start + member.size].decode() == long


def test_it_agrees_with_tarfile() -> None:
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w", format=tarfile.GNU_FORMAT) as tar:
        for count in range(1, 51):
            member = tarfile.TarInfo(f"{'x' * count * 4}/{count}")
            member.size = count * 100
            tar.addfile(member, io.BytesIO(bytes(member.size)))
    assert len(read_tar(stream.getvalue(), 100)) == 50
    assert len(read_tar(stream.getvalue(), 7)) == 7


def test_nested_long_names_do_not_recurse() -> None:
    nested = (header(b"x", b"00000000002\0", b"L") + b"a\0".ljust(512, b"\0")) * 5000
    assert set(read_tar(nested + header(b"b", b"00000000000\0"), 10)) == {PurePosixPath("a")}


def test_negative_sizes_do_not_move_backwards() -> None:
    begun_s = time.process_time()
    below = b"\xff" * 10 + b"\xfc\x00"
    assert read_tar(header(b"a", b"00000000000\0") + header(b"b", below) * 2 + bytes(1024), 10).keys() == {
        PurePosixPath("a")
    }
    assert time.process_time() - begun_s < 5.0


def test_paths_that_leave_the_folder_are_left_out() -> None:
    size = b"00000000000\0"
    stream = b"".join(header(name, size) for name in (b"/etc/passwd", b"../a", b"a/../../b", b".", b"good"))
    assert set(read_tar(stream, 10)) == {PurePosixPath("good")}


def test_other_data_has_no_files() -> None:
    assert read_tar(b"", 10) == {}
    assert read_tar(b"\0" * 10240, 10) == {}
    assert read_tar(b"PK\3\4" * 1000, 10) == {}
