"""The parameters of another node: asked for by its services, and told as text."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import yaml
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.parameter import get_parameter_value, parameter_value_to_python

from grader.graph.discovery import cli_node, settle, spin_until
from grader.graph.names import nodes
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.node import require_node

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rclpy.node import Node

ANSWER_S = 5.0
"""A node that is busy does not answer; this long it may be."""
_TYPES = {
    ParameterType.PARAMETER_BOOL: ("boolean", "Boolean value is:"),
    ParameterType.PARAMETER_INTEGER: ("integer", "Integer value is:"),
    ParameterType.PARAMETER_DOUBLE: ("double", "Double value is:"),
    ParameterType.PARAMETER_STRING: ("string", "String value is:"),
    ParameterType.PARAMETER_BYTE_ARRAY: ("byte array", "Byte values are:"),
    ParameterType.PARAMETER_BOOL_ARRAY: ("boolean array", "Boolean values are:"),
    ParameterType.PARAMETER_INTEGER_ARRAY: ("integer array", "Integer values are:"),
    ParameterType.PARAMETER_DOUBLE_ARRAY: ("double array", "Double values are:"),
    ParameterType.PARAMETER_STRING_ARRAY: ("string array", "String values are:"),
}


class Parameters:
    """The parameters of one node. Every method may raise Ros2Error: no answer, or no such parameter."""

    def __init__(self, node: Node, node_name: str) -> None:
        """`node_name` is the full name of the node that has them."""
        self._node = node
        self.node_name = node_name

    def _call(self, kind: Any, service: str, request: Any) -> Any:  # noqa: ANN401
        client = self._node.create_client(kind, f"{self.node_name}/{service}")
        try:
            if not spin_until(self._node, client.service_is_ready, ANSWER_S):
                message = f"The node {self.node_name} offers no parameters"
                raise Ros2Error(message)
            future = client.call_async(request)
            if not spin_until(self._node, future.done, ANSWER_S):
                message = f"The node {self.node_name} did not answer within {ANSWER_S:.0f} s: is it busy?"
                raise Ros2Error(message)
            return future.result()
        finally:
            self._node.destroy_client(client)

    def names(self) -> list[str]:
        """All names, sorted."""
        answer = self._call(ListParameters, "list_parameters", ListParameters.Request())
        return sorted(answer.result.names)

    def get(self, name: str) -> ParameterValue:
        """One value."""
        found = self._call(GetParameters, "get_parameters", GetParameters.Request(names=[name])).values
        if not found or found[0].type == ParameterType.PARAMETER_NOT_SET:
            raise Ros2Error(did_you_mean(name, self.names(), "Parameter not set"))
        return found[0]

    def all_values(self) -> dict[str, Any]:
        """All values by name."""
        names = self.names()
        found = self._call(GetParameters, "get_parameters", GetParameters.Request(names=names)).values
        pairs = zip(names, found, strict=False)
        return {name: parameter_value_to_python(value) for name, value in pairs if value.type in _TYPES}

    def set(self, name: str, text: str) -> Any:  # noqa: ANN401
        """Set it to what the text says as YAML; returns SetParametersResult."""
        parameter = Parameter(name=name, value=_value(text))
        result = self._call(SetParameters, "set_parameters", SetParameters.Request(parameters=[parameter])).results[0]
        known = [] if result.successful else self.names()
        if known and name not in known:
            result.reason = did_you_mean(name, known, result.reason)
        return result

    def describe(self, names: list[str]) -> list[Any]:
        """The descriptor of each."""
        known = self.names()
        for name in names:
            if name not in known:
                raise Ros2Error(did_you_mean(name, known, f"Parameter '{name}' is not declared by {self.node_name}"))
        found = self._call(DescribeParameters, "describe_parameters", DescribeParameters.Request(names=names))
        return list(found.descriptors)


@contextmanager
def parameters_of(name: str, spin_time_s: float | None) -> Iterator[Parameters]:
    """The parameters of a node by its name, while this process has a node to ask with.

    Raises:
        Ros2Error: there is no such node.
    """
    with cli_node() as node:
        settle(node, deadline_s=spin_time_s)
        yield Parameters(node, require_node(node, name, "Node not found"))


def names_of_all(name: str | None, spin_time_s: float | None, *, types: bool) -> dict[str, list[str]]:
    """The parameters of one node, or of all that offer some: node -> its lines, both sorted."""
    found: dict[str, list[str]] = {}
    with cli_node() as node:
        settle(node, deadline_s=spin_time_s)
        asked = nodes(node) if name is None else [require_node(node, name, "Node not found")]
        offered = {service for service, _ in node.get_service_names_and_types()}
        for full in dict.fromkeys(asked):
            if name is None and f"{full}/list_parameters" not in offered:
                continue
            client = Parameters(node, full)
            lines = client.names()
            if types:
                kinds = [_TYPES.get(item.type, ("not set",))[0] for item in client.describe(lines)]
                lines = [f"{line} (type: {kind})" for line, kind in zip(lines, kinds, strict=True)]
            found[full] = lines
    return found


def told(value: ParameterValue, *, hide_type: bool) -> str:
    """A value as `param get` tells it."""
    text = str(parameter_value_to_python(value))
    return text if hide_type else f"{_TYPES[value.type][1]} {text}"


def described(descriptor: Any) -> str:  # noqa: ANN401
    """A descriptor as `param describe` tells it."""
    lines = [f"Parameter name: {descriptor.name}", f"  Type: {_TYPES.get(descriptor.type, ('not set',))[0]}"]
    if descriptor.description:
        lines.append(f"  Description: {descriptor.description}")
    lines.append("  Constraints:")
    if descriptor.read_only:
        lines.append("    Read only: true")
    for limits in (*descriptor.floating_point_range, *descriptor.integer_range):
        lines += [f"    Min value: {limits.from_value}", f"    Max value: {limits.to_value}"]
        if limits.step:
            lines.append(f"    Step: {limits.step}")
    if descriptor.additional_constraints:
        lines.append(f"    Additional constraints: {descriptor.additional_constraints}")
    return "\n".join(lines)


def dumped(node_name: str, values: dict[str, Any]) -> str:
    """The values as a parameter file: a dot in a name opens a level."""
    tree: dict[str, Any] = {}
    for name, value in values.items():
        *path, last = name.split(".")
        level = tree
        for part in path:
            level = level.setdefault(part, {})
        level[last] = list(value) if hasattr(value, "tolist") else value
    text: str = yaml.safe_dump({node_name: {"ros__parameters": tree}}, default_flow_style=False, sort_keys=True)
    return text


def _value(text: str) -> ParameterValue:
    try:
        value: ParameterValue = get_parameter_value(text)
    except (yaml.YAMLError, TypeError, ValueError) as error:
        message = f"The value is not YAML: {text}"
        raise Ros2Error(message) from error
    return value
