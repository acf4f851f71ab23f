"""A node with any name, also one that ROS 2 rejects: the node overwrites its valid name in its own memory.

The argument is the new name as hexadecimal digits.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import rclpy
from rclpy.node import Node
from std_msgs.msg import String

if TYPE_CHECKING:
    from collections.abc import Iterator

VALID = b"a_name_that_is_long_enough_to_be_on_the_heap"


def writable() -> Iterator[list[int]]:
    """Yield the parts of the heap."""
    with Path("/proc/self/maps").open() as maps:
        for line in maps:
            area, mode, _, _, _, *name = line.split()
            if mode.startswith("rw") and name in ([], ["[heap]"]):
                yield [int(each, 16) for each in area.split("-")]


def main() -> None:
    """Rename the node, and announce it again."""
    new = bytes.fromhex(sys.argv[1]).ljust(len(VALID), b"_")
    rclpy.init()
    nodes = [Node(VALID.decode(), enable_rosout=False)]
    with Path("/proc/self/mem").open("r+b", buffering=0) as memory:
        for first, last in writable():
            memory.seek(first)
            for found in re.finditer(VALID, memory.read(last - first)):
                memory.seek(first + found.start())
                memory.write(new)
    # Another endpoint of this participant makes it announce the names of its nodes again.
    nodes.append(Node("valid", enable_rosout=False))
    nodes[-1].create_publisher(String, "/words", 1)
    print("announced", flush=True)
    rclpy.spin(nodes[-1])


if __name__ == "__main__":
    main()
