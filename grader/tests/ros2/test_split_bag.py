"""A bag that is split into several files contains all messages once, and each complete file can be read."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest
from rosbags.rosbag2 import Reader

from grader.ros2.bag.recovery import recover
from grader.ros2.bag.split_writer import SplitWriter
from grader.tests import made_bag

if TYPE_CHECKING:
    from pathlib import Path

TYPE, TOPIC = "geometry_msgs/msg/Twist", "/turtle1/cmd_vel"
SENT = [(round(message.t_s * 1e9), message.data) for message in made_bag.commands(10.0)]


def written(folder: Path, *, most_bytes: int = 0, most_s: int = 0, storage: str = "mcap", mode: str = "none") -> None:
    with SplitWriter(folder, storage, mode, most_bytes=most_bytes, most_s=most_s) as writer:
        writer.add_topic(TOPIC, TYPE)
        for stamp, data in SENT:
            writer.write(TOPIC, TYPE, stamp, data)


def read(folder: Path) -> list[tuple[int, bytes]]:
    with Reader(folder) as reader:
        return [(stamp, bytes(data)) for _, stamp, data in reader.messages()]


@pytest.mark.parametrize(("storage", "ending"), [("mcap", "mcap"), ("sqlite3", "db3")])
def test_a_bag_is_split_by_time(storage: str, ending: str, tmp_path: Path) -> None:
    written(tmp_path / "bag", most_s=3, storage=storage)
    files = [f"bag_{number}.{ending}" for number in range(4)]
    assert sorted(path.name for path in (tmp_path / "bag").iterdir()) == [*files, "metadata.yaml"]
    assert read(tmp_path / "bag") == SENT
    with Reader(tmp_path / "bag") as reader:
        assert (reader.message_count, reader.start_time, reader.end_time) == (100, 0, SENT[-1][0] + 1)


def test_a_bag_is_split_by_size(tmp_path: Path) -> None:
    written(tmp_path / "bag", most_bytes=2500)
    assert len(list((tmp_path / "bag").glob("*.mcap"))) == 4
    assert read(tmp_path / "bag") == SENT


def test_a_compressed_bag_is_split(tmp_path: Path) -> None:
    written(tmp_path / "bag", most_s=6, mode="file")
    assert read(tmp_path / "bag") == SENT


def test_the_file_of_a_killed_recorder_is_found(tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    writer = SplitWriter(folder, "mcap", "none", most_bytes=0, most_s=6)
    writer.add_topic(TOPIC, TYPE)
    for stamp, data in SENT:
        writer.write(TOPIC, TYPE, stamp, data)
    writer._part._kept_at -= 10.0
    writer.keep()  # a recorder that is killed now leaves the flushed messages
    (folder / "another").mkdir()
    shutil.copyfile(folder / "bag_0.mcap", folder / "another/own.mcap")
    assert read(folder) == SENT[:60]
    recover(folder)
    assert read(folder) == SENT
    assert sorted(path.name for path in folder.iterdir()) == ["another", "bag_0.mcap", "metadata.yaml"]
    assert (folder / "another/own.mcap").is_file()


def test_a_bag_without_messages_has_one_file(tmp_path: Path) -> None:
    with SplitWriter(tmp_path / "bag", "mcap", "none", most_bytes=0, most_s=1) as writer:
        writer.add_topic(TOPIC, TYPE)
    assert read(tmp_path / "bag") == []
