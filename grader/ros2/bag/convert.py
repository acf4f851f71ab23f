"""The verb `bag convert`: rewrite bags with other topics, another storage format or another compression."""

from __future__ import annotations

import argparse
import heapq
from contextlib import ExitStack
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from grader.ros.failure import Ros2Error
from grader.ros2.bag.options import STORAGES, absolute, contains
from grader.ros2.given_file import why_not

if TYPE_CHECKING:
    from collections.abc import Iterator

_EXAMPLE = "an example:\noutput_bags:\n- uri: new_bag\n  storage_id: mcap\n  all_topics: true"


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "-i",
        "--input",
        required=True,
        action="append",
        nargs="+",
        metavar=("uri", "storage_id"),
        help="a bag to read, and its storage format; may be repeated",
    )
    parser.add_argument(
        "-o",
        "--output-options",
        required=True,
        type=_options_file,
        help="YAML file that lists the new bags under output_bags: uri, storage_id, topics and more",
    )


def _options_file(text: str) -> IO[str]:
    """Open the file with the options, or return standard input for `-`, for argparse."""
    why = why_not(Path(text), piped=True) if text != "-" else ""
    if why:
        message = f"can't open '{text}': {why}"
        raise argparse.ArgumentTypeError(message)
    opened: IO[str] = argparse.FileType("r", encoding="utf-8")(text)
    return opened


def run(args: argparse.Namespace) -> int:
    """Write the new bags.

    Raises:
        Ros2Error: a bag or the options cannot be read, or a new bag cannot be written.
    """
    wanted = _options(args.output_options)
    from grader.ros2.bag.bag_reader import messages, open_bag
    from grader.ros2.bag.bag_writer import BagWriter

    with ExitStack() as stack:
        sources = []
        for uri, *_ in args.input:
            path = Path(uri)
            if not path.exists():
                message = f"[ERROR] [ros2bag]: Bag path '{uri}' does not exist!"
                raise Ros2Error(message)
            reader = stack.enter_context(open_bag(path))
            kinds = {one.topic: one.msgtype for one in reader.connections}
            profiles = {one.topic: getattr(one.ext, "offered_qos_profiles", []) for one in reader.connections}
            definitions = {one.topic: one.msgdef.data for one in reader.connections}
            sources.append((path, reader, kinds, profiles, definitions))
        for options in wanted:
            with BagWriter(Path(options["uri"]), options["storage_id"], _compression(options)) as writer:
                known: set[tuple[str, str]] = set()
                found: list[Iterator[tuple[int, str, str, bytes]]] = []
                for path, reader, kinds, profiles, definitions in sources:
                    topics = {topic for topic in kinds if _chosen(options, topic)}
                    for topic in sorted(topics):
                        if (topic, kinds[topic]) not in known:
                            writer.add_topic(topic, kinds[topic], profiles[topic], definitions[topic])
                            known.add((topic, kinds[topic]))
                    found.append(_typed(messages(reader, path, topics), kinds))
                for stamp, topic, kind, data in heapq.merge(*found, key=lambda one: one[0]):
                    writer.write(topic, kind, stamp, data)
    return 0


def _options(file: Any) -> list[dict[str, Any]]:  # noqa: ANN401
    import yaml

    try:
        with file:
            data = yaml.safe_load(file)
        bags = data["output_bags"]
        right = all(bag.setdefault("storage_id", "mcap") in STORAGES and isinstance(bag["uri"], str) for bag in bags)
    except (yaml.YAMLError, KeyError, TypeError, AttributeError, ValueError, RecursionError) as error:
        raise _unreadable(file) from error
    if not right or not bags:
        raise _unreadable(file)
    found: list[dict[str, Any]] = bags
    return found


def _unreadable(file: Any) -> Ros2Error:  # noqa: ANN401
    return Ros2Error(f"[ERROR] [ros2bag]: {file.name} does not contain valid options for new bags; {_EXAMPLE}")


def _typed(found: Iterator[tuple[str, int, bytes]], kinds: dict[str, str]) -> Iterator[tuple[int, str, str, bytes]]:
    """Yield the stamp, topic, type and data of each message."""
    for topic, stamp, data in found:
        yield stamp, topic, kinds[topic], data


def _compression(options: dict[str, Any]) -> str:
    mode = str(options.get("compression_mode") or "none").lower()
    if mode not in ("none", "file", "message"):
        message = f"[ERROR] [ros2bag]: compression_mode must be none, file or message, not '{mode}'"
        raise Ros2Error(message)
    return mode


def _chosen(options: dict[str, Any], topic: str) -> bool:
    """Return whether a topic belongs in the new bag according to the options.

    If the options select no topics, all topics that are not excluded belong in the new bag.
    """
    topics, regex = absolute(options.get("topics") or []), options.get("regex") or ""
    if topic in absolute(options.get("exclude_topics") or []) or contains(topic, options.get("exclude_regex") or ""):
        return False
    if options.get("all") or options.get("all_topics") or not (topics or regex):
        return True
    return topic in topics or contains(topic, regex)
