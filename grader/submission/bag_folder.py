"""BagFolder: a bag that a student recorded, read from the files of the submission.

The bag is not trusted. The bag is read in a process with limits (reader.py), and nothing is written.
"""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from io import BytesIO
from typing import TYPE_CHECKING, Literal

from grader.common.words import shorten

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from mcap.records import McapRecord

METADATA = "metadata.yaml"
POSE_TYPE = "turtlesim/msg/Pose"
MOST_MESSAGES = 200_000
MOST_CHUNK_BYTES = 16 * 1024 * 1024
"""The maximum size of one record of a bag, and of a chunk after decompression (bytes). rosbag2 writes chunks of 0.8
MB."""
_POSE = {0: struct.Struct(">4x2f"), 1: struct.Struct("<4x2f")}
"""Maps the second byte of the header, which states the byte order, to the struct format of x and y in a serialized
pose."""
_COMPRESSED = re.compile(rb"^ *compression_mode: *[\"']?message\b", re.IGNORECASE | re.MULTILINE)
"""Matches the line of metadata.yaml that states that each message is compressed."""

Problem = Literal["", "missing", "elsewhere", "unfinished", "storage", "damaged"]


@dataclass(frozen=True)
class Poses:
    """The poses on one topic, sorted by time: the time of arrival (s), x and y (m)."""

    t_s: tuple[float, ...] = ()
    x: tuple[float, ...] = ()
    y: tuple[float, ...] = ()


@dataclass(frozen=True)
class BagFolder:
    """A bag. `problem` is the reason why the bag cannot be read, and `detail` the file or error that shows it, if any.

    `types` contains the type of each topic, `counts` the number of messages on each topic, and `poses` the messages of
    type Pose.
    """

    problem: Problem
    detail: str
    types: Mapping[str, str]
    counts: Mapping[str, int]
    poses: Mapping[str, Poses]


def read_bag(files: Mapping[str, bytes], folder: str) -> BagFolder:
    """Read the bag in this folder of a submission. Errors are stored in `problem` and never raised."""
    inside = {path.removeprefix(f"{folder}/"): data for path, data in files.items() if path.startswith(f"{folder}/")}
    stored = sorted(path for path in inside if path.endswith(".mcap"))
    if not inside:
        others = sorted(path for path in files if path.endswith((".mcap", ".db3", ".mcap.active")))
        return _unread("elsewhere" if others else "missing", others[0] if others else "")
    if not stored:
        other = sorted(path for path in inside if path.endswith((".db3", ".zstd", ".lz4")))
        return _unread("storage", other[0]) if other else _unread("damaged", "it has no .mcap file")
    if METADATA not in inside:
        return _unread("unfinished", "")
    if _COMPRESSED.search(inside[METADATA]):
        return _unread("storage", stored[0])
    from mcap.exceptions import EndOfFile  # this import is slow, and most exercises have no bag

    try:
        return _read([inside[path] for path in stored])
    except EndOfFile:
        return _unread("damaged", "a file is truncated")
    except Exception as error:  # any exception is possible: a damaged file has wrong offsets, strings and checksums
        return _unread("damaged", shorten(str(error) or type(error).__name__, 80))


def _unread(problem: Problem, detail: str) -> BagFolder:
    return BagFolder(problem, detail, {}, {}, {})


def _read(stored: list[bytes]) -> BagFolder:
    from mcap.records import Channel, Message, Schema

    types: dict[str, str] = {}
    counts: dict[str, int] = {}
    rows: dict[str, list[tuple[float, float, float]]] = {}
    for data in stored:
        schemas: dict[int, str] = {}
        channels: dict[int, str] = {}
        for record in _records(data):
            if isinstance(record, Schema):
                schemas[record.id] = record.name
            elif isinstance(record, Channel):
                channels[record.id] = record.topic
                types[record.topic] = schemas[record.schema_id]
                counts.setdefault(record.topic, 0)
            elif isinstance(record, Message):
                topic = channels[record.channel_id]
                counts[topic] += 1
                if types[topic] == POSE_TYPE:
                    x, y = _POSE[record.data[1]].unpack_from(record.data)
                    rows.setdefault(topic, []).append((record.log_time / 1e9, x, y))
            if sum(counts.values()) > MOST_MESSAGES:
                return _unread("damaged", f"it has more than {MOST_MESSAGES} messages")
    poses = {
        topic: Poses(*(tuple(column) for column in zip(*sorted(each), strict=True))) for topic, each in rows.items()
    }
    return BagFolder("", "", types, counts, poses)


def _records(data: bytes) -> Iterator[McapRecord]:
    """Yield the records of a file up to its summary. Raises ValueError if a chunk is too large."""
    from mcap.records import Chunk, DataEnd
    from mcap.stream_reader import StreamReader, breakup_chunk

    for record in StreamReader(BytesIO(data), emit_chunks=True, record_size_limit=MOST_CHUNK_BYTES).records:
        if isinstance(record, Chunk):
            if record.uncompressed_size > MOST_CHUNK_BYTES:
                message = f"a chunk has more than {MOST_CHUNK_BYTES // 1024**2} MiB"
                raise ValueError(message)
            yield from breakup_chunk(record)
        elif isinstance(record, DataEnd):
            return
        else:
            yield record
