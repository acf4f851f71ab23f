"""Read bags that rosbag2 or the course's `ros2 bag` recorded, in MCAP or SQLite."""

from __future__ import annotations

import heapq
import shlex
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rosbags.rosbag2 import Reader

from grader.common.words import shorten
from grader.ros.failure import Ros2Error
from grader.ros2.given_file import MOST_BYTES, why_not

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


class BagError(Exception):
    """A bag cannot be read, for the reason in the message."""


@contextmanager
def open_bag(path: Path) -> Iterator[Reader]:
    """Open a bag, given its folder or one of its files.

    Raises:
        Ros2Error: the path is not a bag, or the bag is damaged.
    """
    if path.is_dir() and not (path / "metadata.yaml").exists():
        files = [file for ending in ("*.mcap", "*.db3") for file in path.glob(ending)]
        text = f"[ERROR] [ros2bag]: No metadata.yaml in '{path}'."
        if files:
            text += (
                "\nThe recording may still be running, or may have been interrupted. If it is not running, type: "
                f"ros2 bag reindex {shlex.quote(str(path))}"
            )
        raise Ros2Error(text)
    try:
        _require_files(path)
        reader = Reader(path)
        reader.open()
        _require_valid(reader)
    except Exception as error:  # a damaged file can cause any error, such as a bad offset, string or checksum
        raise _damaged(path, error) from error
    try:
        yield reader
    finally:
        reader.close()


def _require_files(path: Path) -> None:
    """Raise BagError if opening the bag could wait forever or never end, or if metadata.yaml is too large."""
    metadata = path / "metadata.yaml"
    if not path.is_dir():
        _require_file(path, None)
        return
    _require_file(metadata, MOST_BYTES)
    # The metadata may name any file in the folder.
    for file in path.iterdir():
        if file.exists() and not (file.is_dir() or file.is_file()):
            _require_file(file, None)


def _require_file(file: Path, most: int | None) -> None:
    why = why_not(file, most=most)
    if why:
        message = f"{file.name}: {why}"
        raise BagError(message)


def _require_valid(reader: Reader) -> None:
    """Raise BagError if the metadata has values with which the bag cannot be described or played."""
    for one in reader.connections:
        for name, value in (("name", one.topic), ("type", one.msgtype)):
            if not isinstance(value, str):
                message = f"the {name} of a topic is not a string: {shorten(str(value))}"
                raise BagError(message)
        _require_number(f"the number of messages on {shorten(one.topic)}", one.msgcount)
    _require_number("the number of messages", reader.message_count)
    if reader.message_count:
        _require_number("the start", reader.start_time)
        _require_number("the duration", reader.duration - 1)  # rosbags adds a nanosecond


def _require_number(name: str, value: object) -> None:
    if not isinstance(value, int) or not 0 <= value < 2**63:
        message = f"{name} is not a number from 0 to 2**63 - 1: {shorten(str(value))}"
        raise BagError(message)


def messages(
    reader: Reader, path: Path, topics: set[str], start: int | None = None
) -> Iterator[tuple[str, int, bytes]]:
    """Yield the topic, stamp and data of each message on `topics`, in order of the stamps (ns since the epoch).

    If `start` is given, messages with an earlier stamp are omitted.

    Raises:
        Ros2Error: the bag is damaged.
    """
    chosen = [connection for connection in reader.connections if connection.topic in topics]
    if not chosen:
        return
    found = reader.messages(chosen, start=start)
    nothing = True
    while True:
        try:
            connection, stamp, data = next(found)
        except StopIteration:
            if nothing and any(connection.msgcount for connection in chosen):
                yield from _without_index(path, topics, start)
            return
        except Exception as error:
            raise _damaged(path, error) from error
        nothing = False
        yield connection.topic, stamp, bytes(data)


def _without_index(path: Path, topics: set[str], start: int | None) -> Iterator[tuple[str, int, bytes]]:
    """Yield the messages of an MCAP bag without chunks. The library rosbags cannot read such a bag.

    rosbag2 writes such bags with `--storage-preset-profile fastwrite`.
    """
    from grader.ros2.bag.recovery import saved_messages

    files = sorted(path.glob("*.mcap")) if path.is_dir() else [path]
    for saved in heapq.merge(*map(saved_messages, files), key=lambda saved: saved.stamp_ns):
        if saved.topic in topics and (start is None or saved.stamp_ns >= start):
            yield saved.topic, saved.stamp_ns, saved.data


def _damaged(path: Path, error: Exception) -> Ros2Error:
    lines = str(error).strip().splitlines() or [type(error).__name__]
    return Ros2Error(f"[ERROR] [ros2bag]: The bag '{path}' cannot be read: {lines[0]}")
