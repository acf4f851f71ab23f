"""Write a bag that consists of several files.

A new file begins when another message would exceed the maximum size or duration of the current file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import yaml

from grader.ros.failure import Ros2Error
from grader.ros2.bag.bag_writer import INFORMATION, BagWriter

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path
    from types import TracebackType
    from typing import Self

    from rosbags.interfaces import Qos

_RECORD_BYTES = 31
"""The size of a message in an MCAP file, not counting its data (bytes)."""
_METADATA = "metadata.yaml"


class SplitWriter:
    """A new bag with several files, as a context manager with the methods of BagWriter.

    The metadata is written after each file, so that all complete files can be read even if the recorder is killed. The
    current file is in a separate folder until it is complete. `ros2 bag reindex` also finds files in that folder.

    `folder`, `storage` and `compression` have the same meaning as for BagWriter. `most_bytes` is the maximum total size
    of the messages in a file (bytes), and `most_s` is the maximum duration of a file (s). The value 0 means no limit.

    Raises:
        Ros2Error: the folder cannot be created, or a file cannot be completed.
    """

    def __init__(self, folder: Path, storage: str, compression: str, *, most_bytes: int, most_s: int) -> None:
        self.folder = folder.absolute()
        self._kind = (storage, compression)
        self._most_bytes, self._most_ns = most_bytes, most_s * 10**9
        self._topics: list[tuple[str, str, Sequence[Qos]]] = []
        self._information: dict[str, Any] = {}
        self._number = 0
        try:
            self.folder.mkdir(parents=True)
        except OSError as error:
            message = f"[ERROR] [ros2bag]: Could not create bag folder '{folder}'.\n{error.strerror}"
            raise Ros2Error(message) from error
        self._part = self._new_part()
        self._bytes = 0
        self._begun_ns: int | None = None

    def add_topic(self, topic: str, kind: str, offered: Sequence[Qos] = ()) -> None:
        """Add a topic to this file and the following files, as `BagWriter.add_topic` does."""
        self._part.add_topic(topic, kind, offered)
        self._topics.append((topic, kind, offered))

    def write(self, topic: str, kind: str, stamp_ns: int, data: bytes) -> None:
        """Write a message to this file, or to a new file if this file is full. See `BagWriter.write`."""
        size = len(data) + _RECORD_BYTES
        begun_ns = stamp_ns if self._begun_ns is None else self._begun_ns
        large = self._most_bytes and self._bytes and self._bytes + size > self._most_bytes
        if large or (self._most_ns and stamp_ns - begun_ns >= self._most_ns):
            self._end()
            self._number += 1
            self._part = self._new_part()
            self._bytes, begun_ns = 0, stamp_ns
        self._bytes, self._begun_ns = self._bytes + size, begun_ns
        self._part.write(topic, kind, stamp_ns, data)

    def keep(self) -> None:
        """Flush the messages to the file. See `BagWriter.keep`."""
        self._part.keep()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._end()

    def _new_part(self) -> BagWriter:
        part = BagWriter(self.folder / f"{self.folder.name}_{self._number}", *self._kind)
        for topic in self._topics:
            part.add_topic(*topic)
        return part

    def _end(self) -> None:
        """Complete the file, and move it and its metadata to the folder with the earlier files."""
        self._part.__exit__(None, None, None)
        part = self._part.folder
        try:
            metadata = part / _METADATA
            new = yaml.safe_load(metadata.read_text("utf-8"))[INFORMATION]
            (file,) = (path for path in part.iterdir() if path != metadata)
            name = part.name + file.name.removeprefix(f"{part.name}_0")
            new["relative_file_paths"] = [name]
            new["files"][0]["path"] = name
            self._information = joined(self._information, new)
            file.rename(self.folder / name)
            metadata.write_text(yaml.safe_dump({INFORMATION: self._information}, sort_keys=False), "utf-8")
            metadata.replace(self.folder / _METADATA)
            part.rmdir()
        except OSError as failure:
            text = f"[ERROR] [ros2bag]: {self.folder}: {failure.strerror}."
            raise Ros2Error(text) from failure


def joined(earlier: dict[str, Any], later: dict[str, Any]) -> dict[str, Any]:
    """Return the metadata of a bag with the files of two bags, from the metadata of both. `earlier` may be empty."""
    if not earlier:
        return later
    both = [one for one in (earlier, later) if one["message_count"]] or [later]
    start = min(_start(one) for one in both)
    end = max(_start(one) + one["duration"]["nanoseconds"] for one in both)
    counts = {_topic(each): each["message_count"] for each in earlier["topics_with_message_count"]}
    topics = [
        {**each, "message_count": each["message_count"] + counts.get(_topic(each), 0)}
        for each in later["topics_with_message_count"]
    ]
    return {
        **later,
        "starting_time": {"nanoseconds_since_epoch": start},
        "duration": {"nanoseconds": end - start},
        "message_count": earlier["message_count"] + later["message_count"],
        "topics_with_message_count": topics,
        "relative_file_paths": [*earlier["relative_file_paths"], *later["relative_file_paths"]],
        "files": [*earlier["files"], *later["files"]],
    }


def _start(information: dict[str, Any]) -> int:
    start: int = information["starting_time"]["nanoseconds_since_epoch"]
    return start


def _topic(entry: dict[str, Any]) -> tuple[str, str]:
    return entry["topic_metadata"]["name"], entry["topic_metadata"]["type"]
