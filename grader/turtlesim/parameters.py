"""The parameters of the node turtlesim, with the descriptions of the real turtlesim."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rcl_interfaces.msg import IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.parameter import Parameter

from grader.turtlesim.canvas import BACKGROUND

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rclpy.node import Node

CHANNELS = ("background_r", "background_g", "background_b")
HOLONOMIC = "holonomic"

# rclcpp declares these parameters for the publisher of /parameter_events, but rclpy does not. Both use these values.
_EVENTS_QOS = {"depth": 1000, "durability": "volatile", "history": "keep_last", "reliability": "reliable"}


def declare(node: Node) -> None:
    """Declare the parameters. rclpy raises an error for an initial value of the wrong type or out of range."""
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


def refusal(node: Node, parameters: Iterable[Parameter]) -> SetParametersResult | None:
    """Return a result with the reason why these parameters cannot be set, as rclcpp words it, or None if they can.

    rclpy's own messages are worded differently.

    The order of the checks is that of rclcpp/src/rclcpp/node_interfaces/node_parameters.cpp.
    """
    given = list(parameters)
    rules = (_undeclared_or_read_only, _undeclares, _does_not_fit)
    reasons = (rule(node, parameter) for rule in rules for parameter in given)
    reason = next(filter(None, reasons), None)
    return SetParametersResult(successful=False, reason=reason) if reason is not None else None


def _undeclared_or_read_only(node: Node, parameter: Parameter) -> str | None:
    if not node.has_parameter(parameter.name):
        return f"parameter '{parameter.name}' cannot be set because it was not declared"
    if node.describe_parameter(parameter.name).read_only:
        return f"parameter '{parameter.name}' cannot be set because it is read-only"
    return None


def _undeclares(_: Node, parameter: Parameter) -> str | None:
    return "cannot undeclare a statically typed parameter" if parameter.type_ == Parameter.Type.NOT_SET else None


def _does_not_fit(node: Node, parameter: Parameter) -> str | None:
    name, old, new = parameter.name, node.get_parameter(parameter.name).type_, parameter.type_
    if old != new:
        return (
            f"Wrong parameter type, parameter {{{name}}} is of type {{{old.name.lower()}}}, setting it to "
            f"{{{new.name.lower()}}} is not allowed."
        )
    if name in CHANNELS and not 0 <= parameter.value <= 255:
        return f"Parameter {{{name}}} doesn't comply with integer range."
    return None
