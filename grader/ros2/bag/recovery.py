"""Recover a bag whose recorder was killed: write all readable messages to a complete bag."""

from __future__ import annotations

import glob
import heapq
import sqlite3
import tempfile
from contextlib import closing, suppress
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader

from grader.ros.failure import Ros2Error
from grader.ros2.bag.bag_writer import BagWriter
from grader.ros2.bag.logger import Logger
from grader.ros2.given_file import why_not

if TYPE_CHECKING:
    from collections.abc import Iterator


class Saved(NamedTuple):
    """A message that was read without the index of the bag file."""

    stamp_ns: int
    topic: str
    type: str
    data: bytes
    definition: str
    """The definition of the type, or an empty string if the file has no definition."""


def recover(folder: Path) -> None:
    """Replace the files of a bag with a complete bag that contains all readable messages in order.

    The old files are kept until the new files are complete.

    Raises:
        Ros2Error: the folder contains no bag files, or the files cannot be read.
    """
    # The last file of a split bag is in a separate folder until it is complete (split_writer.py).
    part = f"{glob.escape(folder.resolve().name)}_[0-9]*"
    found = (*folder.iterdir(), *folder.glob(f"{part}/{part}"))
    files = sorted(file for file in found if file.suffix in (".mcap", ".db3"))
    if not files:
        message = f"[ERROR] [ros2bag]: No .mcap or .db3 file in '{folder}'"
        raise Ros2Error(message)
    for file in files:
        if why := why_not(file, most=None):
            message = f"[ERROR] [ros2bag]: '{file}' cannot be read: {why}"
            raise Ros2Error(message)
    storage = "mcap" if files[0].suffix == ".mcap" else "sqlite3"
    log = Logger("rosbag2_cpp")
    log.info(f"Beginning reindexing bag in directory: {folder}")
    with tempfile.TemporaryDirectory(prefix=".reindex-", dir=folder) as temporary:
        made = Path(temporary, folder.resolve().name)
        with BagWriter(made, storage) as writer:
            known: set[tuple[str, str]] = set()
            for saved in heapq.merge(*map(saved_messages, files), key=lambda saved: saved.stamp_ns):
                if (saved.topic, saved.type) not in known:
                    writer.add_topic(saved.topic, saved.type, definition=saved.definition)
                    known.add((saved.topic, saved.type))
                writer.write(saved.topic, saved.type, saved.stamp_ns, saved.data)
        # Move the new data first, so that nothing is lost if this process is killed. Move the metadata last: a bag
        # without metadata can be reindexed again.
        data = [path for path in made.iterdir() if path.name != "metadata.yaml"]
        for path in data:
            path.replace(folder / path.name)
        kept = {path.name for path in data}
        for old in (*files, *folder.glob("*.db3-journal"), *folder.glob(f"{part}/{part}.db3-journal")):
            if old.name not in kept or old.parent != folder:
                old.unlink()
                with suppress(OSError):  # the folder of the bag is never empty
                    old.parent.rmdir()
        (made / "metadata.yaml").replace(folder / "metadata.yaml")
    log.info("Reindexing complete.")


def saved_messages(file: Path) -> Iterator[Saved]:
    """Yield all readable messages of a file in order, without using its index.

    Raises:
        Ros2Error: the file is an SQLite file that cannot be read.
    """
    return iter(sorted(_mcap(file) if file.suffix == ".mcap" else _sqlite(file), key=lambda saved: saved.stamp_ns))


def _mcap(file: Path) -> Iterator[Saved]:
    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    with file.open("rb") as stream:
        try:
            for record in StreamReader(stream).records:
                match record:
                    case Schema():
                        schemas[record.id] = record
                    case Channel():
                        channels[record.id] = record
                    case Message():
                        channel = channels[record.channel_id]
                        schema = schemas[channel.schema_id]
                        text = schema.data.decode("utf-8", "replace")
                        yield Saved(record.log_time, channel.topic, schema.name, record.data, text)
        except OSError:
            raise
        except (
            Exception
        ):  # a damaged or incomplete file has wrong lengths, offsets and strings, so any error is possible
            return


def _sqlite(file: Path) -> Iterator[Saved]:
    query = "SELECT timestamp, name, type, data FROM messages JOIN topics ON topics.id = topic_id ORDER BY timestamp"
    try:
        # Opening the database rolls back an incomplete write.
        with closing(sqlite3.connect(file)) as database:
            definitions = _sqlite_definitions(database)
            for stamp, topic, kind, data in database.execute(query):
                yield Saved(stamp, topic, kind, data, definitions.get(kind, ""))
    except sqlite3.Error as error:
        message = f"[ERROR] [ros2bag]: '{file}' cannot be read: {error}"
        raise Ros2Error(message) from error


def _sqlite_definitions(database: sqlite3.Connection) -> dict[str, str]:
    """Return the definitions of the types. Before ROS 2 Iron, rosbag2 did not store definitions."""
    tables = {name for (name,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
    if "message_definitions" not in tables:
        return {}
    return dict(database.execute("SELECT topic_type, encoded_message_definition FROM message_definitions"))
