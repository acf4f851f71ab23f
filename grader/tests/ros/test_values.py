from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

from grader.ros import values
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2 import show
from grader.ros2.topic_hz import rate

if TYPE_CHECKING:
    from pathlib import Path


class Point:
    """As a message of rclpy looks from outside."""

    def __init__(self) -> None:
        self.x = 0.0
        self.label = ""

    def get_fields_and_field_types(self) -> dict[str, str]:
        return {"x": "double", "label": "string"}


class Path_:  # noqa: N801
    def __init__(self) -> None:
        self.start = Point()
        self.counts: list[int] = []
        self.raw = b"\x07"
        self.closed = False

    def get_fields_and_field_types(self) -> dict[str, str]:
        return {"start": "a/Point", "counts": "sequence<int32, 5>", "raw": "octet", "closed": "boolean"}


def test_fills_what_is_named_and_leaves_the_rest() -> None:
    made = values.fill(Path_(), {"start": {"x": 2, "label": 5}, "counts": [1, 2], "raw": 9, "closed": True})
    assert (made.start.x, made.start.label, made.counts, made.raw, made.closed) == (2.0, "5", [1, 2], b"\x09", True)
    assert isinstance(made.start.x, float)
    assert values.fill(Path_(), {}).counts == []


def test_a_number_that_yaml_takes_for_text_is_a_number() -> None:
    assert values.fill(Point(), values.parse("{x: 1e-3}")).x == 0.001


@pytest.mark.parametrize(
    "wrong",
    [{"y": 1}, {"start": 1}, {"start": {"x": "a"}}, {"counts": 1}, {"counts": ["a"]}, {"closed": 1}, {"raw": 300}],
)
def test_refuses_what_does_not_fit(wrong: dict[str, object]) -> None:
    with pytest.raises(Ros2Error, match="Failed to populate field"):
        values.fill(Path_(), wrong)


def test_as_yaml_and_csv() -> None:
    made = values.fill(Path_(), {"start": {"x": 0.1}, "counts": [1, 2, 3]})
    assert values.to_yaml(made) == "start:\n  x: 0.1\n  label: ''\ncounts:\n- 1\n- 2\n- 3\nraw: 7\nclosed: false\n"
    assert values.to_yaml(made, 2).count("'...'") == 1
    assert values.to_csv(made) == "0.1,,1,2,3,7,False"
    assert values.to_yaml(0.1) == "0.1\n"
    assert values.to_yaml(math.nan) == ".nan\n"


def test_a_part_of_a_message() -> None:
    made = values.fill(Path_(), {"start": {"x": 0.1}, "counts": [4, 5]})
    assert values.field(made, "start.x") == 0.1
    assert values.field(made, "counts[1]") == 5
    for wrong in ("begin", "start.z", "counts[2]", "start.x.y"):
        with pytest.raises(Ros2Error, match="Invalid field"):
            values.field(made, wrong)


@pytest.mark.parametrize(
    ("arrivals", "window", "hertz", "deviation"),
    [([0.0, 0.5, 1.0], 3, 2.0, 0.0), ([0.0, 0.4, 1.0], 3, 2.0, 0.1), ([1.0, 1.0], 2, math.inf, 0.0)],
)
def test_the_rate_of_arrivals(arrivals: list[float], window: int, hertz: float, deviation: float) -> None:
    measured = rate(arrivals)
    assert measured is not None
    assert measured.window == window
    assert measured.mean_hz == pytest.approx(hertz)
    assert measured.std_dev_s == pytest.approx(deviation)


def test_one_message_has_no_rate() -> None:
    assert rate([1.0]) is None


def test_the_nearest_name() -> None:
    assert did_you_mean("/turtle1/cmd_vl", ["/turtle1/cmd_vel", "/rosout"]) == "Did you mean '/turtle1/cmd_vel'?"
    assert did_you_mean("linear", ["linear_velocity", "x"], "No.") == "No.\nDid you mean 'linear_velocity'?"
    assert did_you_mean("/nope", ["/turtlesim"], "Unable") == "Unable"


@pytest.fixture
def interfaces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    index = tmp_path / "share/ament_index/resource_index/rosidl_interfaces/things"
    index.parent.mkdir(parents=True)
    index.write_text("msg/Box.msg\nmsg/Box.idl\nmsg/Side.msg\nsrv/Open.srv\n")
    for name, text in {
        "msg/Side.msg": "# a side\nfloat64 length 1.5 # in m\n\nstring<=5 name '#1' # its name\n",
        "msg/Box.msg": "int32 MOST=3\n# four of them\nSide[4] sides\nthings/Side[] more # too\nbool[<=3] flags\n",
        "srv/Open.srv": "Box box\n---\nbool done\n",
    }.items():
        file = tmp_path / "share/things" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))


@pytest.mark.usefixtures("interfaces")
def test_shows_what_a_field_consists_of() -> None:
    side = ["\tfloat64 length 1.5", "\tstring<=5 name '#1'"]
    top = ["int32 MOST=3", "# four of them", "Side[4] sides", "things/Side[] more # too", "bool[<=3] flags"]
    box = [*top[:3], *side, top[3], *side, top[4]]
    assert list(show.lines("things/msg/Box")) == box
    plain = [line.replace(" # too", "") for line in box if not line.startswith("#")]
    assert list(show.lines("things/msg/Box", comments=False)) == plain
    whole = ["\t# a side", "\tfloat64 length 1.5 # in m", "", "\tstring<=5 name '#1' # its name"]
    assert list(show.lines("things/msg/Box", nested_comments=True))[3:7] == whole
    opened = list(show.lines("things/srv/Open"))
    assert opened[0] == "Box box"
    assert "\t\tfloat64 length 1.5" in opened
    assert opened[-2:] == ["---", "bool done"]
