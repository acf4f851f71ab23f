"""Write a bag in the format of rosbag2. The bag can be recovered even if the writer is killed."""

from __future__ import annotations

import os
import shlex
import sqlite3
import time
from typing import TYPE_CHECKING, Literal

import yaml
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as RosbagsWriter
from rosbags.rosbag2.storage_mcap import McapWriter
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Writer

from grader.ros import index
from grader.ros.failure import Ros2Error
from grader.ros.typestore import jazzy_types, register

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path
    from types import TracebackType
    from typing import Self

    from rosbags.interfaces import Connection, Qos

_VERSION: Literal[9] = 9
"""The version of rosbag2's metadata that Jazzy reads and writes."""
INFORMATION = "rosbag2_bagfile_information"
"""The only top-level key of metadata.yaml."""
_KEEP_S = 1.0
"""The interval at which messages are flushed to the file (s). If the recorder is killed, at most the messages of one
interval are lost."""
_NO_HASH = f"RIHS01_{64 * '0'}"
"""The hash that is stored for a type that is not installed, since the hash cannot be computed from the type's name."""


class BagWriter:
    """A new bag as a context manager. On exit, the writer writes the remaining messages and the metadata.

    `folder` is the folder of the bag, which must not exist yet. `storage` is "mcap" or "sqlite3". `compression` is
    "none", "file", "message" or "storage" (inside the MCAP file).

    Raises:
        Ros2Error: the folder cannot be created, or the bag cannot be completed on exit.
    """

    def __init__(self, folder: Path, storage: str, compression: str = "none") -> None:
        self.folder = folder.absolute()
        self._types = jazzy_types()
        self._connections: dict[tuple[str, str], Connection] = {}
        self._kept_at = time.monotonic()
        try:
            plugin = StoragePlugin[storage.upper()]
            self._writer = RosbagsWriter(self.folder, version=_VERSION, storage_plugin=plugin)
            self._writer.set_compression(CompressionMode[compression.upper()], CompressionFormat.ZSTD)
            self._writer.open()
            self._number_file()
        except Exception as error:
            reason = getattr(error, "strerror", None) or str(error)
            message = f"[ERROR] [ros2bag]: Could not create bag folder '{folder}'.\n{reason}"
            raise Ros2Error(message) from error

    def _number_file(self) -> None:
        """Give the new file a number, as in bag/bag_0.mcap, because rosbag2 can reindex only files with a number."""
        storage = self._writer.storage
        assert isinstance(storage, McapWriter | Sqlite3Writer)
        numbered = storage.path.with_stem(f"{storage.path.stem}_0")
        if isinstance(storage, Sqlite3Writer):
            # SQLite derives the name of its journal from the name under which the file was opened.
            storage.conn.close()
            storage.path.rename(numbered)
            storage.conn = sqlite3.connect(numbered)
            storage.cursor = storage.conn.cursor()
        else:
            storage.path.rename(numbered)
        storage.path = numbered

    def add_topic(self, topic: str, kind: str, offered: Sequence[Qos] = (), definition: str | None = None) -> None:
        """Add a topic, so that its messages can be written.

        `definition` is the definition of the type from another bag. `definition` is used only if the type is not
        installed, and may be an empty string.

        Raises:
            Ros2Error: the type of the topic is not installed, and `definition` is None.
        """
        register(self._types, kind, index.prefixes())
        profiles = list(offered)
        if kind in self._types.types:
            made = self._writer.add_connection(topic, kind, typestore=self._types, offered_qos_profiles=profiles)
        elif definition is not None:
            made = self._writer.add_connection(
                topic, kind, msgdef=definition, rihs01=_NO_HASH, offered_qos_profiles=profiles
            )
        else:
            message = f"The type {kind} is not installed"
            raise Ros2Error(message)
        self._connections[topic, kind] = made

    def write(self, topic: str, kind: str, stamp_ns: int, data: bytes) -> None:
        """Write a message.

        `topic` is a topic that has been added, and `kind` is the type of the topic. `stamp_ns` is the time at which the
        message arrived (ns since the epoch). `data` is the message as it was sent (CDR).

        Raises:
            OSError: the file cannot be written.
        """
        self._writer.write(self._connections[topic, kind], stamp_ns, data)

    def keep(self) -> None:
        """Flush the messages to the file, at most once per second, so that they are kept if this process is killed."""
        if time.monotonic() - self._kept_at < _KEEP_S:
            return
        self._kept_at = time.monotonic()
        match self._writer.storage:
            case McapWriter() as mcap:
                if mcap.chunk.msgs:
                    mcap.close_chunk()
                mcap.bio.flush()
            case Sqlite3Writer() as sqlite:
                sqlite.conn.commit()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            self._writer.close()
            _add_distribution(self.folder / "metadata.yaml")
        except OSError as failure:
            text = f"[ERROR] [ros2bag]: {self.folder}: {failure.strerror}."
            text += (
                f"\nThe bag contains the earlier messages. When the folder can be written again, type: "
                f"ros2 bag reindex {shlex.quote(str(self.folder))}"
            )
            raise Ros2Error(text) from failure


def _add_distribution(metadata: Path) -> None:
    """Add the name of the ROS 2 distribution to metadata.yaml, which is replaced atomically."""
    data = yaml.safe_load(metadata.read_text("utf-8"))
    data[INFORMATION]["ros_distro"] = os.environ.get("ROS_DISTRO", "jazzy")
    new = metadata.with_suffix(".yaml.tmp")
    new.write_text(yaml.safe_dump(data, sort_keys=False), "utf-8")
    new.replace(metadata)
