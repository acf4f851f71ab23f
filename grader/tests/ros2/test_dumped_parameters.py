"""`ros2 param dump` of names with dots: what it prints gives the same parameters when it is loaded."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
import yaml

from grader.ros2.param.dump import dumped
from grader.tests.ros2.world import world

if TYPE_CHECKING:
    from pathlib import Path

NESTED: dict[str, Any] = {"a": 1, "a.b": 2, "x.a": [1, 2], "x.a.b.c": "text", "q.r": True, "q.s.t": 1.5}


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ({"a.b": 1, "a.c": 2, "d": 3}, {"a": {"b": 1, "c": 2}, "d": 3}),
        ({"a": 1, "a.b": 2}, {"a": 1, "a.b": 2}),
        ({"a.b": 2, "a": 1}, {"a": 1, "a.b": 2}),
        ({"a": "text", "a.b.c": 2, "ab.c": 3}, {"a": "text", "a.b.c": 2, "ab": {"c": 3}}),
        ({"x.a": [1], "x.a.b": 2, "x.c": 3}, {"x": {"a": [1], "a.b": 2, "c": 3}}),
    ],
)
def test_a_dot_starts_a_level_unless_the_level_is_a_parameter(values: dict[str, Any], expected: Any) -> None:  # noqa: ANN401
    assert yaml.safe_load(dumped("/node", values)) == {"/node": {"ros__parameters": expected}}


NODE = """
import rclpy
rclpy.init()
node = rclpy.create_node("node", automatically_declare_parameters_from_overrides=True)
rclpy.spin(node)
"""


def test_a_node_starts_with_the_dumped_parameters_and_dumps_them_again(tmp_path: Path) -> None:
    for here in world(tmp_path):
        (here.home / "node.py").write_text(NODE)
        written = dumped("/node", NESTED)
        (here.home / "params.yaml").write_text(written)
        node = here.start("python3 node.py --ros-args --params-file params.yaml")
        done = here.run("ros2 param dump /node --timeout 60")
        found = yaml.safe_load(done.stdout)["/node"]["ros__parameters"]
        assert yaml.safe_load(written)["/node"]["ros__parameters"].items() <= found.items(), done
        loaded = here.run("ros2 param load /node params.yaml")
        assert [f"Set parameter {name} successful" in loaded.stdout for name in NESTED] == [True] * len(NESTED)
        node.stop()
