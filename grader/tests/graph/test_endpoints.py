"""The graph that is shown contains every node that exists, and no other."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pytest

from grader.tests.ros2.world import World, world

if TYPE_CHECKING:
    from collections.abc import Iterator

EXISTS = """
import rclpy

rclpy.init()
rclpy.spin(rclpy.create_node("exists", start_parameter_services=False, enable_rosout=False))
"""
"""A node with as few endpoints as possible."""
LOOKS = """
import time

import rclpy
from rclpy.node import Node
from grader.graph.endpoints import observe


class Looks(Node):
    def get_node_names_and_namespaces(self):
        return [*super().get_node_names_and_namespaces(), ("has_ended", "/")]


rclpy.init()
node = Looks("looks")
while "/exists" not in (observed := observe(node)).nodes:
    time.sleep(0.05)
print(observed.nodes)
"""
"""Looks at the graph with a node that rmw_dds_common has kept by mistake. This mistake cannot be caused at will."""


@pytest.fixture
def beside(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    """Yield a world in which one node runs."""
    for made in world(tmp_path_factory.mktemp("home")):
        for name, text in (("exists.py", EXISTS), ("looks.py", LOOKS)):
            (made.home / name).write_text(text, "utf-8")
        made.start(f"{sys.executable} exists.py")
        yield made


def test_a_node_that_has_ended_is_not_shown(beside: World) -> None:
    done = beside.run(f"{sys.executable} looks.py")
    assert done.stdout == "('/exists',)\n", done.stderr
