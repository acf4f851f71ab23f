"""Graphs to draw: the tutorial's graph, and a graph with ten nodes."""

from __future__ import annotations

from grader.trial.recording import Endpoint, Graph

_TYPES = {"cmd_vel": "geometry_msgs/msg/Twist", "pose": "turtlesim/msg/Pose", "rosout": "rcl_interfaces/msg/Log"}


def publisher(node: str, topic: str) -> Endpoint:
    return Endpoint("publisher", node, topic, _TYPES.get(topic.rpartition("/")[2], "std_msgs/msg/String"))


def subscription(node: str, topic: str) -> Endpoint:
    return Endpoint("subscription", node, topic, _TYPES.get(topic.rpartition("/")[2], "std_msgs/msg/String"))


def tutorial() -> Graph:
    """Return the graph in which draw_circle drives turtlesim, with the data that `ros2 node info` shows."""
    return Graph(
        t_s=1.0,
        nodes=("/turtlesim", "/draw_circle"),
        endpoints=(
            publisher("/draw_circle", "/turtle1/cmd_vel"),
            publisher("/draw_circle", "/rosout"),
            publisher("/draw_circle", "/parameter_events"),
            subscription("/turtlesim", "/turtle1/cmd_vel"),
            subscription("/turtlesim", "/parameter_events"),
            publisher("/turtlesim", "/rosout"),
            publisher("/turtlesim", "/parameter_events"),
            publisher("/turtlesim", "/turtle1/pose"),
            publisher("/turtlesim", "/turtle1/color_sensor"),
            publisher("/turtlesim", "/turtle1/rotate_absolute/_action/feedback"),
            publisher("/turtlesim", "/turtle1/rotate_absolute/_action/status"),
        ),
    )


def ten_nodes() -> Graph:
    """Return a graph with a loop, two nodes with the same name, an unconnected node, long names, and a topic named like
    a node.
    """
    return Graph(
        t_s=1.0,
        nodes=(
            *tutorial().nodes,
            "/turtlesim",
            "/mimic",
            "/logger",
            "/teleop_turtle",
            "/go_to_goal_controller",
            "/alone",
            "/talker",
            "/echo",
            "/a_namespace/with_a_node_of_a_long_name",
        ),
        endpoints=(
            *tutorial().endpoints,
            publisher("/teleop_turtle", "/turtle1/cmd_vel"),
            publisher("/go_to_goal_controller", "/turtle1/cmd_vel"),
            subscription("/go_to_goal_controller", "/turtle1/pose"),
            subscription("/logger", "/turtle1/pose"),
            subscription("/mimic", "/turtle1/pose"),
            publisher("/mimic", "/turtle2/cmd_vel"),
            subscription("/turtlesim", "/turtle2/cmd_vel"),
            publisher("/talker", "/echo"),
            subscription("/echo", "/echo"),
            publisher("/a_namespace/with_a_node_of_a_long_name", "/a_namespace/and_a_topic_of_a_long_name"),
        ),
    )
