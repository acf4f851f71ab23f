"""rosbag2 bags that the course's recorder does not create: with types that are not installed, and without chunks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer as McapWriter
from rosbags.rosbag2 import Reader, StoragePlugin, Writer

from grader.ros2.bag.bag_reader import messages, open_bag
from grader.ros2.bag.recovery import recover
from grader.tests import made_bag
from grader.tests.ros2.world import world

if TYPE_CHECKING:
    from pathlib import Path

DEFINITION = "int32 strange_field\n"
HASH = "RIHS01_" + 64 * "1"
SENT = [(number, bytes([0, 1, 0, 0, number, 0, 0, 0])) for number in range(1, 6)]


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_bag_of_an_unknown_type_is_reindexed(storage: StoragePlugin, tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    with Writer(folder, version=9, storage_plugin=storage) as writer:
        connection = writer.add_connection("/strange", "not_here/msg/Strange", msgdef=DEFINITION, rihs01=HASH)
        for stamp, data in SENT:
            writer.write(connection, stamp, data)
    (folder / "metadata.yaml").unlink()
    recover(folder)
    with Reader(folder) as reader:
        (connection,) = reader.connections
        assert (connection.msgtype, connection.msgdef.data) == ("not_here/msg/Strange", DEFINITION)
        assert [(stamp, bytes(data)) for _, stamp, data in reader.messages()] == SENT


def test_a_type_that_is_not_installed_is_reported_on_one_line(tmp_path: Path) -> None:
    with Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/strange", "std_msgs/msg/Int33", msgdef=DEFINITION, rihs01=HASH)
        writer.write(connection, *SENT[0])
    for here in world(tmp_path):
        done = here.run(f"ros2 bag play {tmp_path / 'bag'}")
        assert "Ignoring a topic '/strange', reason: The passed message type is invalid.\n" in done.stderr
        assert done.code == 1


def test_playing_a_bag_imports_no_module_that_only_the_bag_names(tmp_path: Path) -> None:
    with Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for topic, module in (("/zen", "this"), ("/environment", "venv.__main__")):
            connection = writer.add_connection(topic, f"{module}/msg/Zen", msgdef=DEFINITION, rihs01=HASH)
            writer.write(connection, *SENT[0])
    for here in world(tmp_path):
        done = here.run(f"cd {tmp_path} && ros2 bag play bag")
        assert done.code == 1
        assert "The Zen of Python" not in done.stdout
        assert not (tmp_path / "play").exists()


def without_chunks(folder: Path) -> None:
    """Rewrite the only file of a bag without chunks, as rosbag2 does with the profile fastwrite."""
    (file,) = folder.glob("*.mcap")
    with file.open("rb") as stream:
        found = list(make_reader(stream).iter_messages())
    with file.open("wb") as stream:
        writer = McapWriter(stream, use_chunking=False)
        writer.start(profile="ros2")
        channels: dict[str, int] = {}
        for schema, channel, message in found:
            assert schema is not None
            if channel.topic not in channels:
                id_ = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.topic] = writer.register_channel(channel.topic, "cdr", id_, channel.metadata)
            writer.add_message(channels[channel.topic], message.log_time, message.data, message.publish_time)
        writer.finish()  # type: ignore[no-untyped-call]


@pytest.mark.parametrize("start", [None, 3_000_000_000])
def test_a_bag_without_chunks_is_read(start: int | None, tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    made_bag.record(folder, [*made_bag.poses(), *made_bag.commands()])
    with open_bag(folder) as reader:
        expected = list(messages(reader, folder, {"/turtle1/pose"}, start))
    assert len(expected) > 400
    without_chunks(folder)
    with open_bag(folder) as reader:
        assert list(messages(reader, folder, {"/turtle1/pose"}, start)) == expected
