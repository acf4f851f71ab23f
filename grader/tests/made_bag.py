"""Create bags like those of learners, without a recorder."""

from __future__ import annotations

import math
import shutil
import struct
from typing import TYPE_CHECKING

from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from grader.evidence.bag import write_bag
from grader.ros.installation import find_ros
from grader.ros.typestore import jazzy_types
from grader.ros.underlay import with_turtlesim
from grader.trial.recording import Message

if TYPE_CHECKING:
    from pathlib import Path

FRAME_S = 0.016
POSE, TWIST = struct.Struct("<xBxx5f"), struct.Struct("<xBxx6d")


def poses(
    radius_m: float = 1.1, *, speed: float = 0.8, begin_s: float = 1.0, drive_s: float = 9.5, end_s: float = 0.5
) -> list[Message]:
    """Return poses of a turtle that stands still, drives a circle to the left, and stands still again."""
    found, angle = [], 0.0
    for frame in range(round((begin_s + drive_s + end_s) / FRAME_S)):
        t_s = frame * FRAME_S
        drives = begin_s <= t_s < begin_s + drive_s
        angle += FRAME_S * speed / radius_m if drives else 0.0
        x, y = 5.544445 + radius_m * math.sin(angle), 5.544445 + radius_m * (1.0 - math.cos(angle))
        data = POSE.pack(1, x, y, math.remainder(angle, 2.0 * math.pi), speed * drives, speed / radius_m * drives)
        found.append(Message("/turtle1/pose", "turtlesim/msg/Pose", data, t_s, t_s))
    return found


def commands(duration_s: float = 10.0) -> list[Message]:
    """Return velocity commands with a rate of 10 Hz."""
    data = TWIST.pack(1, 0.8, 0.0, 0.0, 0.0, 0.0, 0.727)
    times = [0.1 * number for number in range(round(10 * duration_s))]
    return [Message("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", data, t_s, t_s) for t_s in times]


def record(folder: Path, messages: list[Message]) -> None:
    """Replace the bag in `folder` with a bag that contains these messages."""
    shutil.rmtree(folder, ignore_errors=True)
    ros = with_turtlesim(find_ros(), lambda _: None)
    write_bag(folder, sorted(messages, key=lambda message: message.t_s), ros.all_prefixes)


def record_sqlite(folder: Path) -> None:
    """Write a bag with one message in the SQLite format."""
    shutil.rmtree(folder, ignore_errors=True)
    store = jazzy_types()
    with Writer(folder, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        connection = writer.add_connection("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", typestore=store)
        writer.write(connection, 0, commands(0.1)[0].data)


def record_compressed(folder: Path) -> None:
    """Write a bag with commands, each of which is compressed."""
    shutil.rmtree(folder, ignore_errors=True)
    store = jazzy_types()
    writer = Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(CompressionMode.MESSAGE, CompressionFormat.ZSTD)
    with writer:
        connection = writer.add_connection("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", typestore=store)
        for message in commands(1.0):
            writer.write(connection, round(message.t_s * 1e9), message.data)
