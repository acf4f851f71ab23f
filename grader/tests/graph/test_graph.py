from __future__ import annotations

from pathlib import Path

import pytest

from grader.graph.graph import Node, Show, Topic, picture, to_dot, to_text
from grader.tests.graph.graphs import publisher, subscription, ten_nodes, tutorial

GOLDEN = Path(__file__).parents[1] / "golden" / "graph"


def drawn(name: str, show: Show | None = None) -> str:
    graph = {"tutorial": tutorial, "ten_nodes": ten_nodes}[name]()
    return to_dot(picture(graph.nodes, graph.endpoints, show))


def topics(show: Show) -> list[str]:
    graph = tutorial()
    return [topic.name for topic in picture(graph.nodes, graph.endpoints, show).topics]


@pytest.mark.parametrize("name", ["tutorial", "ten_nodes"])
def test_dot_is_as_recorded(name: str) -> None:
    assert drawn(name) == (GOLDEN / f"{name}.dot").read_text()


@pytest.mark.parametrize("name", ["tutorial", "ten_nodes"])
@pytest.mark.parametrize("strokes", ["unicode", "ascii"])
def test_text_is_as_recorded(name: str, strokes: str) -> None:
    graph = {"tutorial": tutorial, "ten_nodes": ten_nodes}[name]()
    text = to_text(picture(graph.nodes, graph.endpoints), ascii_only=strokes == "ascii")
    assert text == (GOLDEN / f"{name}.{strokes}.txt").read_text()
    assert strokes == "unicode" or text.isascii()


def test_debug_topics_and_the_inside_of_actions_are_left_out() -> None:
    assert topics(Show()) == ["/turtle1/cmd_vel", "/turtle1/color_sensor", "/turtle1/pose"]


def test_debug_topics_are_shown_when_requested() -> None:
    assert {"/rosout", "/parameter_events"} <= set(topics(Show(debug=True)))
    assert not any("_action" in topic for topic in topics(Show(debug=True)))


def test_hidden_topics_are_shown_when_requested() -> None:
    assert "/turtle1/rotate_absolute/_action/feedback" in topics(Show(hidden=True))
    assert "/rosout" not in topics(Show(hidden=True))


def test_dead_ends_can_be_left_out() -> None:
    assert topics(Show(dead_ends=False)) == ["/turtle1/cmd_vel"]


def test_a_hidden_node_takes_its_topics_along() -> None:
    ends = [publisher("/_ros2cli_123", "/chatter"), publisher("/_ros2cli_123", "/turtle1/cmd_vel")]
    observed = picture(["/_ros2cli_123", "/turtlesim"], [*ends, subscription("/turtlesim", "/turtle1/cmd_vel")])
    assert observed.nodes == (Node("/turtlesim"),)
    assert observed.topics == (Topic("/turtle1/cmd_vel", (), ("/turtlesim",)),)


def test_a_node_known_by_its_endpoint_only_is_shown() -> None:
    assert picture([], [publisher("/late", "/chatter")]).nodes == (Node("/late"),)


def test_two_nodes_of_one_name_are_reported() -> None:
    observed = picture(["/turtlesim", "/turtlesim"], [subscription("/turtlesim", "/turtle1/cmd_vel")] * 2)
    assert observed.nodes == (Node("/turtlesim", 2),)
    assert r'label="/turtlesim\n(2 nodes of this name)"' in to_dot(observed)
    assert "(/turtlesim) x2" in to_text(observed)


def test_equal_graphs_give_equal_pictures_whatever_their_order() -> None:
    graph = ten_nodes()
    backwards = picture(graph.nodes[::-1], graph.endpoints[::-1])
    assert backwards == picture(graph.nodes, graph.endpoints)


def test_an_empty_graph_is_drawn() -> None:
    nothing = picture([], [])
    assert to_dot(nothing).endswith("}\n")
    assert "[topic]" in to_text(nothing)
