"""The parameters of the node turtlesim, with the descriptions of the real turtlesim."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rcl_interfaces.msg import IntegerRange, ParameterDescriptor, SetParametersResult

from grader.turtlesim.canvas import BACKGROUND

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rclpy.node import Node
    from rclpy.parameter import Parameter

CHANNELS = ("background_r", "background_g", "background_b")
HOLONOMIC = "holonomic"

# rclcpp declares these parameters for the publisher of /parameter_events, but rclpy does not. Both use these values.
_EVENTS_QOS = {"depth": 1000, "durability": "volatile", "history": "keep_last", "reliability": "reliable"}


def declare(node: Node) -> None:
    """Declare the parameters. rclpy raises an error for an initial value that is out of range."""
    for name, color, value in zip(CHANNELS, ("Red", "Green", "Blue"), BACKGROUND, strict=True):
        descriptor = ParameterDescriptor(
            description=f"{color} channel of the background color",
            integer_range=[IntegerRange(from_value=0, to_value=255, step=1)],
        )
        node.declare_parameter(name, value, descriptor)
    node.declare_parameter(
        HOLONOMIC, value=False, descriptor=ParameterDescriptor(description="If true, then turtles will be holonomic")
    )
    for policy, setting in _EVENTS_QOS.items():
        descriptor = ParameterDescriptor(
            description=f"qos policy {{{policy}}} for publisher {{/parameter_events}}", read_only=True
        )
        node.declare_parameter(
            f"qos_overrides./parameter_events.publisher.{policy}", setting, descriptor, ignore_override=True
        )
    # Every node has this parameter. This is the description that rclcpp uses. rclpy uses a different one.
    every_nodes = node.describe_parameter("start_type_description_service")
    every_nodes.description = "Start the ~/get_type_description service for this node."


def refusal(parameters: Iterable[Parameter]) -> SetParametersResult | None:
    """Reject a colour that is out of range, using rclcpp's message like turtlesim. rclpy's message is different."""
    for parameter in parameters:
        if parameter.name in CHANNELS and isinstance(parameter.value, int) and not 0 <= parameter.value <= 255:
            reason = f"Parameter {{{parameter.name}}} doesn't comply with integer range."
            return SetParametersResult(successful=False, reason=reason)
    return None
