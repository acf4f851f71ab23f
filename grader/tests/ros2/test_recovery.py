"""The messages of a bag file are recovered wherever the file ends, for example because the disk was full."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from mcap.writer import CompressionType, Writer

from grader.ros2.bag.recovery import saved_messages

if TYPE_CHECKING:
    from pathlib import Path

MESSAGES = 20


def recorded(file: Path, compression: CompressionType) -> bytes:
    """Write a bag file with several chunks, and return its content."""
    with file.open("wb") as stream:
        writer = Writer(stream, chunk_size=150, compression=compression)
        writer.start(profile="ros2")
        schema = writer.register_schema("std_msgs/msg/Int32", "ros2msg", b"int32 data")
        channel = writer.register_channel("/count", "cdr", schema)
        for number in range(MESSAGES):
            writer.add_message(channel, number, b"\0\1\0\0" + number.to_bytes(4, "little"), number)
        writer.finish()  # type: ignore[no-untyped-call]
    return file.read_bytes()


@pytest.mark.parametrize("compression", CompressionType)
def test_a_file_that_is_cut_off_anywhere_gives_the_messages_before_the_end(
    tmp_path: Path, compression: CompressionType
) -> None:
    file = tmp_path / "bag_0.mcap"
    whole = recorded(file, compression)
    stamps = []
    for size in range(len(whole) + 1):
        file.write_bytes(whole[:size])
        found = list(saved_messages(file))
        assert [int.from_bytes(saved.data[4:], "little") for saved in found] == list(range(len(found)))
        stamps.append(len(found))
    assert stamps == sorted(stamps)
    assert (stamps[0], stamps[-1]) == (0, MESSAGES)


def test_a_file_with_a_wrong_length_gives_the_messages_before_it(tmp_path: Path) -> None:
    file = tmp_path / "bag_0.mcap"
    whole = recorded(file, CompressionType.NONE)
    middle = len(whole) // 2
    for offset in range(middle, middle + 60):
        file.write_bytes(whole[:offset] + b"\xff" * 8 + whole[offset + 8 :])
        assert len(list(saved_messages(file))) <= MESSAGES
