"""Functions that test_node.py runs in processes with ROS 2.

The functions advance turtlesim frame by frame, and use a client.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import asdict
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, ListParameters, SetParametersAtomically
from rclpy.action import get_action_server_names_and_types_by_node
from rclpy.serialization import deserialize_message, serialize_message
from std_srvs.srv import Empty
from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative

from grader.tests.turtlesim.rig import Rig, names_of, twist
from grader.trial.goals import GoalLog
from grader.turtlesim.interface import QOS
from grader.turtlesim.turtle import FRAME_S, Start


def graph() -> dict[str, Any]:
    with Rig() as rig:
        rig.until(lambda: "turtlesim" in rig.client.get_node_names())
        found: dict[str, Any] = {}
        for section, request in {
            "Subscribers": rig.client.get_subscriber_names_and_types_by_node,
            "Publishers": rig.client.get_publisher_names_and_types_by_node,
            "Service Servers": rig.client.get_service_names_and_types_by_node,
            "Action Servers": lambda *of: get_action_server_names_and_types_by_node(rig.client, *of),
        }.items():
            entries = [
                f"{name}: {', '.join(types)}" for name, types in request("turtlesim", "/") if "/_action/" not in name
            ]
            found[section] = sorted(entries)
        profiles = [
            *rig.client.get_subscriptions_info_by_topic("/turtle1/cmd_vel"),
            *rig.client.get_publishers_info_by_topic("/turtle1/pose"),
            *rig.client.get_publishers_info_by_topic("/turtle1/color_sensor"),
        ]
        found["QoS"] = [(p.qos_profile.reliability.name, p.qos_profile.durability.name) for p in profiles]
        found["depth"] = QOS.depth
        found["timers"] = len(list(rig.turtlesim.timers))
        return found


def parameters() -> dict[str, Any]:
    with Rig() as rig:

        def change(name: str, value: ParameterValue) -> tuple[bool, str]:
            answer = rig.call(
                SetParametersAtomically,
                "/turtlesim/set_parameters_atomically",
                parameters=[Parameter(name=name, value=value)],
            )
            return answer.result.successful, answer.result.reason

        def integer(value: int) -> ParameterValue:
            return ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=value)

        names = rig.call(ListParameters, "/turtlesim/list_parameters").result.names
        described = rig.call(DescribeParameters, "/turtlesim/describe_parameters", names=names).descriptors
        found: dict[str, Any] = {
            "names": sorted(names),
            "described": {
                d.name: [
                    d.type,
                    d.description,
                    [[r.from_value, r.to_value, r.step] for r in d.integer_range],
                    d.read_only,
                ]
                for d in described
            },
            "refused": change("background_r", integer(999)),
            "wrong type": change("background_r", ParameterValue(type=ParameterType.PARAMETER_STRING)),
            "undeclared": change("nope", integer(1)),
            "read-only": change("qos_overrides./parameter_events.publisher.depth", integer(1)),
            "deleted": change("background_r", ParameterValue(type=ParameterType.PARAMETER_NOT_SET)),
            "kept": rig.turtlesim.world.canvas.background,
            "accepted": change("background_r", integer(150)),
        }
        found["background"] = rig.turtlesim.world.canvas.background
        change("holonomic", ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=True))
        found["holonomic"] = rig.turtlesim.world.holonomic
        return found


def as_recorded() -> dict[str, Any]:
    """Send the same requests as during the recording of the real turtlesim's log."""
    with Rig() as rig:
        found = {
            "spawn": rig.call(Spawn, "/spawn", x=2.0, y=2.0, theta=0.2, name="t2").name,
            "again": rig.call(Spawn, "/spawn", x=2.0, y=2.0, theta=0.2, name="t2").name,
            "unnamed": rig.call(Spawn, "/spawn", x=3.0, y=3.0).name,
        }
        rig.call(Kill, "/kill", name="nope")
        rig.call(Empty, "/clear")
        rig.call(Empty, "/reset")
        rig.result(rig.goal(1.57, []))
        rig.result(rig.goal(0.0, []))
        return found


def services() -> dict[str, Any]:
    with Rig(start=Start(4.0, 5.0, 0.25)) as rig:
        found: dict[str, Any] = {"start": rig.state()[:3]}
        rig.call(TeleportAbsolute, "/turtle1/teleport_absolute", x=1.0, y=2.0, theta=0.5)
        rig.frame()
        found["absolute"] = rig.state()[:3]
        rig.call(TeleportRelative, "/turtle1/teleport_relative", linear=1.0, angular=-0.5)
        rig.frame()
        found["relative"] = rig.state()[:3]
        pen = {"r": 1, "g": 2, "b": 3, "width": 0, "off": 0}
        turtle = rig.turtlesim.world.turtles["turtle1"]
        rig.call(SetPen, "/turtle1/set_pen", **pen)
        found["pen"] = [turtle.pen.color, turtle.pen.width, turtle.pen.down]
        rig.call(SetPen, "/turtle1/set_pen", r=9, g=9, b=9, width=9, off=1)
        found["pen up"] = [turtle.pen.color, turtle.pen.width, turtle.pen.down]

        rig.call(Spawn, "/spawn", x=20.0, y=-3.0, theta=7.0, name="far")
        rig.frame()
        found["outside"] = rig.state("far")[:3]
        rig.call(Spawn, "/spawn", x=8.0, y=8.0, name="near")
        colors: list[Color] = []
        poses: list[Pose] = []
        rig.client.create_subscription(Pose, "/near/pose", poses.append, 7)
        rig.client.create_subscription(Color, "/near/color_sensor", colors.append, 7)
        rig.until(lambda: bool(poses and colors))
        found["seen"] = [colors[-1].r, colors[-1].g, colors[-1].b]
        rig.call(Kill, "/kill", name="far")
        rig.until(lambda: not any(name.startswith("/far/") for name, _ in names_of(rig, "topic")))
        found["left by far"] = [name for name, _ in names_of(rig, "service") if name.startswith("/far/")]
        rig.call(Empty, "/reset")
        found["reset"] = rig.state()[:3]
        return found


def rotations() -> dict[str, Any]:
    log = GoalLog(lambda: rig.frames * FRAME_S)
    with Rig(on_goal=log.add) as rig:
        feedback: list[float] = []
        status, delta = rig.result(rig.goal(0.5, feedback))
        found: dict[str, Any] = {"status": status, "delta": delta}
        # The last feedback may arrive after the result, when the client no longer receives it.
        found["feedback"] = len(feedback) > 5 and all(a > b for a, b in itertools.pairwise(feedback))
        # The goals below turn for several seconds, so that they are active when the next event happens.
        goal = rig.goal(3.0, [])
        cancelled = goal.cancel_goal_async()
        rig.until(cancelled.done)
        found["cancel"] = rig.result(goal)[0]
        first, second = rig.goal(-3.0, []), rig.goal(-2.9, [])
        found["second goal"] = rig.result(first)[0]
        publisher = rig.publisher()
        publisher.publish(twist(x=1.0))
        found["command"] = rig.result(second)[0]
        goal = rig.goal(3.0, [])
        rig.call(Empty, "/reset")
        found["reset"] = rig.result(goal)[0]
        goal = rig.goal(3.0, [])
        rig.call(Kill, "/kill", name="turtle1")
        rig.frame(20)
        found["after kill"] = rig.call(Spawn, "/spawn", x=1.0, y=1.0, name="turtle1").name
        found["log"] = [asdict(each) for each in log.goals]
        return found


def hostile() -> dict[str, Any]:
    with Rig() as rig:

        def spawn(name: str, x: float = 1.0, theta: float = 0.0) -> str:
            answer: str = rig.call(Spawn, "/spawn", x=x, y=1.0, theta=theta, name=name).name
            return answer

        found: dict[str, Any] = {
            "names": [spawn(name) for name in ("two words", "9lives", "a//b", "ä", "x" * 300, "{", "/", "a-b")],
            "turtles": list(rig.turtlesim.world.turtles),
            "no number": spawn("nan", x=math.nan, theta=math.inf),
        }
        publisher = rig.publisher()
        for value in (math.nan, math.inf, -math.inf, 1e300):
            publisher.publish(twist(x=value, z=value))
        before = rig.frames
        rig.until(lambda: rig.frames > before + 50)
        rig.call(TeleportAbsolute, "/turtle1/teleport_absolute", x=math.nan, y=math.inf, theta=math.nan)
        rig.call(TeleportRelative, "/turtle1/teleport_relative", linear=math.inf, angular=-math.inf)
        rig.frame(3)
        rig.goal(math.nan, [])
        rig.call(SetPen, "/turtle1/set_pen", width=255)
        rig.call(Empty, "/reset")
        publisher.publish(twist())
        rig.frame(3)
        found["recovers"] = all(math.isfinite(value) for value in rig.state()[:3])
        while spawn(""):
            pass
        found["most"] = len(rig.turtlesim.world.turtles)
        for _ in range(3):
            rig.call(Empty, "/reset")
        rig.frame(20)
        found["after"] = list(rig.turtlesim.world.turtles)
        return found


def hooks() -> dict[str, Any]:
    commands: list[tuple[str, bytes, Any]] = []
    published: list[tuple[str, str, bytes]] = []
    interventions: list[str] = []
    with Rig(
        on_command=lambda *of: commands.append(of),
        on_publish=lambda *of: published.append(of),
        on_intervention=interventions.append,
    ) as rig:
        publisher = rig.publisher()
        message = twist(x=2.0, z=1.0)
        publisher.publish(message)
        rig.until(lambda: bool(commands))
        published.clear()
        rig.frame()
        state = rig.state()
        pose = deserialize_message(published[0][2], Pose)
        rig.call(Empty, "/clear")
        rig.call(Spawn, "/spawn", name="t")
        rig.call(SetPen, "/turtle1/set_pen")
        rig.call(TeleportAbsolute, "/turtle1/teleport_absolute")
        rig.call(TeleportRelative, "/turtle1/teleport_relative")
        rig.call(Kill, "/kill", name="t")
        rig.goal(0.0, [])
        red = ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=200)
        holonomic = ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=True)
        for name, value in (("background_r", red), ("holonomic", holonomic)):
            rig.call(
                SetParametersAtomically,
                "/turtlesim/set_parameters_atomically",
                parameters=[Parameter(name=name, value=value)],
            )
        rig.call(Empty, "/reset")
        topic, data, heard = commands[0]
        return {
            "topic": topic,
            "as sent": data == serialize_message(message) and heard == message,
            "published": [entry[:2] for entry in published[:2]],
            "pose as state": max(abs(a - b) for a, b in zip((pose.x, pose.y, pose.theta), state[:3], strict=True))
            < 1e-6,
            "interventions": interventions,
        }


def every_fourth_frame() -> list[str]:
    """Return the topics on which a turtle publishes in eight frames, if it publishes in every fourth frame."""
    published: list[str] = []
    with Rig(pose_every=4, on_publish=lambda topic, *_: published.append(topic)) as rig:
        rig.frame(8)
    return published


def first_poses() -> dict[str, float]:
    """Return the time of the first pose of each of two turtles (s), if the first pose of turtle1 is late."""
    found: dict[str, float] = {}
    now_s = 0.0
    with Rig(pose_from_s=0.8, on_publish=lambda topic, *_: found.setdefault(topic, now_s)) as rig:
        rig.turtlesim.add_turtle("berta", Start(2.0, 2.0, 0.0))
        for frame in range(100):
            now_s = frame * FRAME_S
            rig.frame()
    return {topic: first_s for topic, first_s in found.items() if topic.endswith("/pose")}
