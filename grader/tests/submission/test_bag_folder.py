"""Bags that students hand in: damaged and hostile bags are read without harm."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType, Writer

from grader.submission.bag_folder import MOST_CHUNK_BYTES, MOST_MESSAGES, BagFolder, read_bag
from grader.submission.reader import read
from grader.tests.case import ROOT

SOLUTION = ROOT / "solutions/11-bags/my_robot_controller/circle_bag"
FILES = {f"circle_bag/{file.name}": file.read_bytes() for file in SOLUTION.iterdir()}
STORED = next(path for path in FILES if path.endswith(".mcap"))


def with_data(data: bytes) -> BagFolder:
    return read(read_bag, {**FILES, STORED: data}, "circle_bag")


def written(messages: int, size: int, chunk: int = 1024 * 1024) -> bytes:
    """Return a file whose messages consist of zeros, which compress well."""
    stream = BytesIO()
    writer = Writer(stream, chunk_size=chunk, compression=CompressionType.ZSTD)
    writer.start()
    schema = writer.register_schema("turtlesim/msg/Pose", "ros2msg", b"")
    channel = writer.register_channel("/turtle1/pose", "cdr", schema)
    for number in range(messages):
        writer.add_message(channel, number, b"\0\1" + bytes(size), number)
    writer.finish()  # type: ignore[no-untyped-call]
    return stream.getvalue()


def test_a_bag_is_read_as_it_was_recorded() -> None:
    bag = read_bag(FILES, "circle_bag")
    poses = bag.poses["/turtle1/pose"]
    assert (bag.problem, bag.types) == ("", {"/turtle1/pose": "turtlesim/msg/Pose"})
    assert bag.counts["/turtle1/pose"] == len(poses.x) == len(poses.y) == len(poses.t_s)
    assert (poses.x[0], poses.y[0]) == pytest.approx((5.544445, 5.544445), abs=1e-5)
    assert list(poses.t_s) == sorted(poses.t_s)


@given(st.integers(0, len(FILES[STORED]) - 1), st.binary(min_size=1, max_size=40))
def test_a_damaged_bag_is_told_and_never_raises(at: int, other: bytes) -> None:
    data = FILES[STORED]
    bag = read_bag({**FILES, STORED: data[:at] + other + data[at + len(other) :]}, "circle_bag")
    assert bag.problem in ("", "damaged")


@settings(max_examples=30)
@given(st.binary(max_size=200))
def test_any_bytes_are_read(data: bytes) -> None:
    assert read_bag({**FILES, STORED: data}, "circle_bag").problem == "damaged"


def test_a_small_file_with_huge_chunks_is_not_unpacked() -> None:
    data = written(1, 2 * MOST_CHUNK_BYTES, chunk=4 * MOST_CHUNK_BYTES)
    assert len(data) < 100_000
    bag = with_data(data)
    assert (bag.problem, "MiB" in bag.detail) == ("damaged", True)


def test_too_many_messages_are_not_read() -> None:
    bag = with_data(written(MOST_MESSAGES + 1, 10))
    assert (bag.problem, str(MOST_MESSAGES) in bag.detail) == ("damaged", True)


@pytest.mark.parametrize(
    ("files", "problem"),
    [
        ({}, "missing"),
        ({"setup.py": b""}, "missing"),
        ({"other/x_0.mcap": b""}, "elsewhere"),
        ({STORED: FILES[STORED]}, "unfinished"),
        ({"circle_bag/circle_bag_0.db3": b"", "circle_bag/metadata.yaml": b""}, "storage"),
        ({STORED: FILES[STORED], "circle_bag/metadata.yaml": b"  compression_mode: MESSAGE\n"}, "storage"),
        ({STORED: FILES[STORED], "circle_bag/metadata.yaml": b"  compression_mode: ''\n"}, ""),
        ({"circle_bag/metadata.yaml": b""}, "damaged"),
    ],
)
def test_what_is_missing_is_named(files: dict[str, bytes], problem: str) -> None:
    assert read_bag(files, "circle_bag").problem == problem


def test_the_bag_is_a_folder_and_not_a_prefix() -> None:
    assert read_bag({"circle_bag_0.mcap": FILES[STORED]}, "circle_bag").problem == "elsewhere"
    assert Path(STORED).parent.name == "circle_bag"
