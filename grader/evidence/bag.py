"""Store the messages of a recording as a rosbag2 folder (MCAP), for `ros2 bag` and other readers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from rosbags.rosbag2 import Reader, StoragePlugin, Writer

from grader.ros.typestore import jazzy_types, register

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from rosbags.interfaces import Connection

    from grader.trial.recording import Message

_VERSION: Literal[9] = 9
"""The version of the rosbag2 metadata that Jazzy reads and writes."""


def write_bag(folder: Path, messages: Sequence[Message], prefixes: Iterable[Path]) -> None:
    """Write the messages to a new folder, in the given order.

    The folders in `prefixes` contain the .msg files of the types that rosbags does not include.

    The timestamp is the arrival time on the trial's clock (ns), or 0 for messages from before the scenario. The
    timestamps of messages that arrived at the same instant are one nanosecond apart, because readers sort by timestamp.
    """
    store = jazzy_types()
    known = list(prefixes)
    with Writer(folder, version=_VERSION, storage_plugin=StoragePlugin.MCAP) as writer:
        connections: dict[tuple[str, str], Connection] = {}
        stamp = -1
        for message in messages:
            key = (message.topic, message.type)
            if key not in connections:
                register(store, message.type, known)
                connections[key] = writer.add_connection(message.topic, message.type, typestore=store)
            stamp = max(stamp + 1, round(message.t_s * 1e9))
            writer.write(connections[key], stamp, message.data)


def read_payloads(folder: Path) -> Iterator[bytes]:
    """Yield the CDR data of the messages in the order in which they were passed to `write_bag`.

    Raises:
        ValueError: the bag is damaged.
    """
    try:
        with Reader(folder) as reader:
            for _connection, _stamp, data in reader.messages():
                yield bytes(data)
    except GeneratorExit:
        raise
    except Exception as error:  # a damaged file has wrong offsets, strings and checksums, so any exception is possible
        message = f"the bag is damaged: {error}"
        raise ValueError(message) from error
