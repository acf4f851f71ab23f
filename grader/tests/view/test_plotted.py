"""The fields that rqt_plot plots."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from grader.ros import message_values
from grader.view.rqt.plotted import Plotted

if TYPE_CHECKING:
    import pytest

PLACE = SimpleNamespace(ends=[SimpleNamespace(kind="publisher", topic="/place", type="geometry_msgs/msg/Point")])


class Point:
    """Stands for geometry_msgs/msg/Point, which this process cannot import."""

    def __init__(self) -> None:
        self.x = self.y = self.z = 0.0

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        return dict.fromkeys("xyz", "double")


class Node:
    """Counts its subscriptions."""

    def __init__(self) -> None:
        self.subscriptions: list[object] = []

    def create_subscription(self, *_: object) -> object:
        self.subscriptions.append(object())
        return self.subscriptions[-1]

    def destroy_subscription(self, subscription: object) -> None:
        self.subscriptions.remove(subscription)


def test_a_field_stays_when_the_message_that_contains_it_is_removed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(message_values, "load_type", lambda *_: Point)
    told: list[dict[str, str]] = []
    node: Any = Node()
    plotted = Plotted(node, lambda _, problems: told.append(problems))
    for each in ("/place/x", "/place"):
        plotted.add(each)
    observed: Any = PLACE
    plotted.look(observed)
    plotted.remove("/place")
    plotted.look(observed)
    plotted.flush()
    assert told == [{"/place/x": ""}]
    assert len(node.subscriptions) == 1
    plotted.remove("/place/x")
    assert node.subscriptions == []
