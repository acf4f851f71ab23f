from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

from grader.ros import message_values, rendering
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros.rendering import Form
from grader.ros2.interface import definition
from grader.ros2.topic import bw, delay
from grader.ros2.topic.hz import Arrivals, rate

if TYPE_CHECKING:
    from pathlib import Path


class Point:
    """An object with the methods of an rclpy message."""

    def __init__(self) -> None:
        self.x = 0.0
        self.label = ""

    def get_fields_and_field_types(self) -> dict[str, str]:
        return {"x": "double", "label": "string"}


@pytest.mark.parametrize(
    "name",
    ["this/msg/Zen", "this/Zen", "idlelib.idle/msg/Zen", "../this/msg/Zen", "\0/msg/Zen", "this/msg/../Zen", "", "/"],
)
def test_a_type_that_is_not_installed_is_not_imported(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    imported: list[str] = []
    monkeypatch.setattr("grader.ros.message_values.importlib.import_module", imported.append)
    with pytest.raises(Ros2Error):
        message_values.load_type(name, "msg")
    assert imported == []


class Path_:  # noqa: N801
    def __init__(self) -> None:
        self.start = Point()
        self.counts: list[int] = []
        self.raw = b"\x07"
        self.closed = False

    def get_fields_and_field_types(self) -> dict[str, str]:
        return {"start": "a/Point", "counts": "sequence<int32, 5>", "raw": "octet", "closed": "boolean"}


def test_fills_what_is_named_and_leaves_the_rest() -> None:
    made = message_values.fill(Path_(), {"start": {"x": 2, "label": 5}, "counts": [1, 2], "raw": 9, "closed": True})
    assert (made.start.x, made.start.label, made.counts, made.raw, made.closed) == (2.0, "5", [1, 2], b"\x09", True)
    assert isinstance(made.start.x, float)
    assert message_values.fill(Path_(), {}).counts == []


def test_a_message_without_fields_is_not_given_an_example_with_a_field() -> None:
    class Empty:
        def get_fields_and_field_types(self) -> dict[str, str]:
            return {"structure_needs_at_least_one_member": "uint8"}

    for message, hint in [(Empty(), "This type has no fields, so its only value is {}."), (Point(), '"{x: ...}".')]:
        with pytest.raises(Ros2Error) as refused:
            message_values.fill(message, 3)
        assert str(refused.value).endswith(hint)


def test_a_number_that_yaml_takes_for_text_is_a_number() -> None:
    assert message_values.fill(Point(), message_values.parse("{x: 1e-3}")).x == 0.001


@pytest.mark.parametrize(
    "wrong",
    [{"y": 1}, {"start": 1}, {"start": {"x": "a"}}, {"counts": 1}, {"counts": ["a"]}, {"closed": 1}, {"raw": 300}],
)
def test_refuses_what_does_not_fit(wrong: dict[str, object]) -> None:
    with pytest.raises(Ros2Error, match="Failed to populate field"):
        message_values.fill(Path_(), wrong)


def test_as_yaml_and_csv() -> None:
    made = message_values.fill(Path_(), {"start": {"x": 0.1}, "counts": [1, 2, 3]})
    text = "start:\n  x: 0.1\n  label: ''\ncounts:\n- 1\n- 2\n- 3\nraw: \"\\a\"\nclosed: false\n"
    assert rendering.to_yaml(made) == text
    assert rendering.to_yaml(made, Form(2)).count("'...'") == 1
    assert rendering.to_csv(made) == "0.1,,1,2,3,b'\\x07',False"
    assert rendering.to_csv(made, Form(2)) == "0.1,,1,2,...,b'\\x07',False"
    made.start.x = math.nan
    assert rendering.to_yaml(made.start) == "x: .nan\nlabel: ''\n"
    assert rendering.to_yaml(made, Form(flow=True)).startswith("start:\n  x: .nan\n  label: ''\ncounts: [1, 2, 3]\n")
    assert rendering.on_one_line(made.start) == "{x: .nan, label: ''}"


def test_arrays_and_strings_by_their_kind() -> None:
    made = message_values.fill(Path_(), {"start": {"label": "abc"}, "counts": [1, 2]})
    short = Form(arrays=False, strings=False)
    assert rendering.plain(made, short)["counts"] == "<sequence type: int32[5], length: 2>"
    assert rendering.plain(made.start, short)["label"] == "<string length: <3>>"
    assert rendering.to_csv(made, short).startswith("0.0,<string length: <3>>,<sequence type: int32[5], length: 2>,")


@pytest.mark.parametrize(
    ("declared", "reported"),
    [
        ("double[36]", "<array type: double[36]>"),
        ("sequence<double>", "<sequence type: double, length: 2>"),
        ("sequence<geometry_msgs/Point>", "<sequence type: geometry_msgs/msg/Point, length: 2>"),
        ("sequence<string<5>, 3>", "<sequence type: string[3], length: 2>"),
    ],
)
def test_the_kind_of_an_array(declared: str, reported: str) -> None:
    assert rendering.plain([1, 2], Form(arrays=False), declared) == reported


def test_stamps_are_set_later() -> None:
    class Header(Point):
        def __init__(self) -> None:
            super().__init__()
            self.stamp = 0.0

        def get_fields_and_field_types(self) -> dict[str, str]:
            return {"stamp": "builtin_interfaces/Time", "label": "string"}

    class Stamped(Point):
        def __init__(self) -> None:
            super().__init__()
            self.header = Header()

        def get_fields_and_field_types(self) -> dict[str, str]:
            return {"header": "std_msgs/Header"}

    for given in ({"header": "auto"}, {"header": {"stamp": "now"}}):
        stamps: list[message_values.Stamper] = []
        made = message_values.fill(Stamped(), given, stamps)
        assert made.header.stamp == 0.0
        for stamp in stamps:
            stamp(7.0)
        assert made.header.stamp == 7.0
    with pytest.raises(Ros2Error, match="Failed to populate field"):
        message_values.fill(Stamped(), {"header": "auto"})


def test_a_part_of_a_message() -> None:
    made = message_values.fill(Path_(), {"start": {"x": 0.1}, "counts": [4, 5]})
    assert message_values.field(made, "start.x") == 0.1
    assert message_values.field(made, "counts[1]") == 5
    assert message_values.field(Path_(), "counts[1]", complete=False) is None
    for wrong in ("begin", "start.z", "counts[2]", "start.x.y"):
        with pytest.raises(Ros2Error, match="Invalid field"):
            message_values.field(made, wrong)


SECOND = 1_000_000_000


@pytest.mark.parametrize(
    ("gaps_s", "hertz", "deviation"), [([0.5, 0.5], 2.0, 0.0), ([0.4, 0.6], 2.0, 0.1), ([0.0, 0.0], 0.0, 0.0)]
)
def test_the_rate_of_arrivals(gaps_s: list[float], hertz: float, deviation: float) -> None:
    measured = rate([round(gap * SECOND) for gap in gaps_s])
    assert measured.window == 2
    assert measured.mean_hz == pytest.approx(hertz)
    assert measured.std_dev_s == pytest.approx(deviation)


def test_there_are_news_of_the_rate_every_second_in_which_something_came() -> None:
    arrivals = Arrivals(window=100)
    observed = []
    for tick in range(1, 31):
        arrivals.add(tick * SECOND // 4)
        if arrivals.have_news():
            observed.append((tick, arrivals.news().window))
    assert observed == [(6, 5), (10, 9), (14, 13), (18, 17), (22, 21), (26, 25), (30, 29)]
    assert not arrivals.have_news()


def test_simulated_time_that_begins_again_begins_the_measuring_again(capsys: pytest.CaptureFixture[str]) -> None:
    arrivals = Arrivals(window=100)
    for now_ns in (1 * SECOND, 3 * SECOND, 0, 4 * SECOND, 6 * SECOND):
        arrivals.add(now_ns)
    assert capsys.readouterr().out == "time has reset, resetting counters\n"
    arrivals.add(2 * SECOND)
    assert not arrivals.have_news()


def test_a_clock_that_is_set_back_does_not_silence_the_reports() -> None:
    arrivals = Arrivals(window=100)
    for now_s in (7200, 7201, 7202):
        arrivals.add(now_s * SECOND)
        arrivals.have_news()
    assert arrivals.news().window == 2
    for now_s in (10, 11):
        arrivals.add(now_s * SECOND)
        arrivals.have_news()
    assert not arrivals.have_news()
    arrivals.add(12 * SECOND)
    assert arrivals.have_news()


@pytest.mark.parametrize(
    ("size", "reported"),
    [
        (10, "20 B/s from 3 messages\n\tMessage size mean: 10 B min: 5 B max: 15 B"),
        (1000, "2.00 KB/s from 3 messages\n\tMessage size mean: 1.00 KB min: 0.99 KB max: 1.00 KB"),
        (10_000_000, "20.00 MB/s from 3 messages\n\tMessage size mean: 10.00 MB min: 10.00 MB max: 10.00 MB"),
    ],
)
def test_bandwidth_in_a_unit_that_suits(size: int, reported: str) -> None:
    arrivals = [(0, size - 5), (SECOND // 2, size), (SECOND, size + 5)]
    assert str(bw.bandwidth(arrivals, 3 * SECOND // 2)) == reported


def test_delays(capsys: pytest.CaptureFixture[str]) -> None:
    delays = delay.Delays(window=2)
    assert delays.report() is None
    for late_ms in (0, 10, 20, 30):
        delays.add(SECOND + late_ms, SECOND)
    assert delays.report() == "average delay: 0.000\n\tmin: 0.000s max: 0.000s std dev: 0.00000s window: 2"
    assert delays.report() == "no new messages"
    assert delay.summary([SECOND, 3 * SECOND]).startswith(
        "average delay: 2.000\n\tmin: 1.000s max: 3.000s std dev: 1.0"
    )
    delays.add(0, SECOND)
    assert capsys.readouterr().out == "time has reset, resetting counters\n"


def test_the_nearest_name() -> None:
    assert did_you_mean("/turtle1/cmd_vl", ["/turtle1/cmd_vel", "/rosout"]) == "Did you mean '/turtle1/cmd_vel'?"
    assert did_you_mean("linear", ["linear_velocity", "x"], "No.") == "No.\nDid you mean 'linear_velocity'?"
    assert did_you_mean("/nope", ["/turtlesim"], "Unable") == "Unable"


def test_without_a_running_node_no_name_is_suggested(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    nobody = "No node was found in ROS domain 7. Start one in another terminal, for example: grader sim"
    assert did_you_mean("/turtle1/pose", ["/rosout"], "Unknown", []) == f"Unknown\n{nobody}"
    assert did_you_mean("/a", [], nodes=["_ros2cli_1", "/_ros2cli_daemon_7"]) == nobody
    assert did_you_mean("/turtl", ["/turtle"], nodes=["/_hidden", "/turtle"]) == "Did you mean '/turtle'?"
    monkeypatch.setenv("ROS_DOMAIN_ID", "")
    assert did_you_mean("/a", [], nodes=[]) == nobody.replace("7", "0")


@pytest.fixture
def interfaces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    index = tmp_path / "share/ament_index/resource_index/rosidl_interfaces/things"
    index.parent.mkdir(parents=True)
    package = tmp_path / "share/ament_index/resource_index/packages/things"
    package.parent.mkdir(parents=True)
    package.touch()
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
    # Like the real command, keep the space between the type and the removed comment.
    side = ["\tfloat64 length 1.5 #", "\tstring<=5 name '#1' #"]
    top = ["int32 MOST=3", "# four of them", "Side[4] sides", "things/Side[] more # too", "bool[<=3] flags"]
    box = [*top[:3], *side, top[3], *side, top[4]]
    assert list(definition.lines("things/msg/Box")) == box
    plain = [line.replace(" # too", " #") for line in box if not line.startswith("#")]
    assert list(definition.lines("things/msg/Box", comments=False)) == plain
    whole = ["\t# a side", "\tfloat64 length 1.5 # in m", "", "\tstring<=5 name '#1' # its name"]
    assert list(definition.lines("things/msg/Box", nested_comments=True))[3:7] == whole
    opened = list(definition.lines("things/srv/Open"))
    assert opened[0] == "Box box"
    assert "\t\tfloat64 length 1.5 #" in opened
    assert opened[-2:] == ["---", "bool done"]
