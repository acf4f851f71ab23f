"""Read and set the parameters of another node through its services. This module needs rclpy."""

from __future__ import annotations

import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.parameter import parameter_value_to_python

from grader.graph.discovery import cli_node, settle, spin_until
from grader.graph.names import absolute, hidden, nodes
from grader.ros.failure import Ros2Error, did_you_mean

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator, Sequence

    from rclpy.node import Node

ANSWER_S = 10.0
"""The maximum time to wait for a response from a busy node (s)."""
_POLL_S = 0.02
_TYPES = {
    ParameterType.PARAMETER_NOT_SET: ("not set", "Parameter not set."),
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
    """The parameters of one node. Every method raises Ros2Error if the node does not respond."""

    def __init__(self, node: Node, node_name: str) -> None:
        """Access the parameters of the node with the full name `node_name`, through clients of `node`."""
        self._node = node
        self.node_name = node_name

    def _call(self, kind: Any, service: str, request: Any) -> Any:  # noqa: ANN401
        client = self._node.create_client(kind, f"{self.node_name}/{service}")
        try:
            if not spin_until(self._node, client.service_is_ready, ANSWER_S):
                message = f"Wait for service timed out waiting for parameter services for node {self.node_name}"
                raise Ros2Error(message)
            future = client.call_async(request)
            if not spin_until(self._node, future.done, ANSWER_S):
                message = f"The node {self.node_name} did not respond within {ANSWER_S:.0f} s. It may be busy."
                raise Ros2Error(message)
            return future.result()
        finally:
            self._node.destroy_client(client)

    def names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """Return the sorted names of the parameters.

        If `prefixes` are given, only these names and names that begin with a prefix and a dot are returned.
        """
        answer = self._call(ListParameters, "list_parameters", ListParameters.Request(prefixes=list(prefixes)))
        return sorted(answer.result.names)

    def get(self, name: str) -> ParameterValue | None:
        """Return the value of a parameter, or None if the parameter is not declared or has no value."""
        found = self._call(GetParameters, "get_parameters", GetParameters.Request(names=[name])).values
        return found[0] if found else None

    def all_values(self) -> dict[str, Any]:
        """Return a dictionary that maps names of parameters to their values. Parameters without a value are omitted."""
        names = self.names()
        found = self._call(GetParameters, "get_parameters", GetParameters.Request(names=names)).values
        if len(found) < len(names):  # if a parameter has no value, the response contains no values
            found = [self.get(name) for name in names]
        pairs = zip(names, found, strict=True)
        return {name: parameter_value_to_python(value) for name, value in pairs if value and value.type}

    def set(self, parameters: Sequence[Parameter]) -> list[Any]:
        """Set parameters. Return a SetParametersResult for each parameter."""
        request = SetParameters.Request(parameters=list(parameters))
        return list(self._call(SetParameters, "set_parameters", request).results)

    def describe(self, names: Sequence[str]) -> list[Any]:
        """Return the descriptor of each parameter, or an empty list if any of them is not declared."""
        request = DescribeParameters.Request(names=list(names))
        return list(self._call(DescribeParameters, "describe_parameters", request).descriptors)


@contextmanager
def parameters_of(args: argparse.Namespace) -> Iterator[Parameters]:
    """Create a node, and yield the parameters of the node `args.node_name`.

    Raises:
        Ros2Error: the node does not appear within `args.timeout` (s) after the discovery.
    """
    with cli_node(use_sim_time=getattr(args, "use_sim_time", False)) as node:
        yield Parameters(node, _found(node, args))


def _found(node: Node, args: argparse.Namespace) -> str:
    name = absolute(args.node_name)
    all_of_them = getattr(args, "include_hidden_nodes", False)

    def there() -> bool:
        return name in nodes(node, all_of_them=all_of_them)

    settle(node, there, getattr(args, "spin_time", None))
    end = time.monotonic() + getattr(args, "timeout", 0)
    while not there():
        if time.monotonic() >= end:
            running = nodes(node, all_of_them=all_of_them)
            raise Ros2Error(did_you_mean(name, running, "Node not found", running))
        time.sleep(_POLL_S)
    return name


def with_parameters(node: Node, *, all_of_them: bool) -> list[str]:
    """Return the sorted names of the nodes that have parameters, without hidden nodes unless `all_of_them` is true."""
    offered = {service for service, _ in node.get_service_names_and_types()}
    found = nodes(node, all_of_them=True)
    shown = [name for name in found if all_of_them or not hidden(name.rpartition("/")[2])]
    return [name for name in dict.fromkeys(shown) if f"{name}/list_parameters" in offered]


def type_name(kind: int) -> str:
    """Return the name of a parameter type, such as "integer" or "string array"."""
    return _TYPES.get(kind, ("unknown", ""))[0]


def value_text(value: ParameterValue, *, hide_type: bool) -> str:
    """Return a value in the format of `param get`."""
    python = parameter_value_to_python(value)
    text = str(python.tolist() if hasattr(python, "tolist") else python)
    if hide_type:
        return text
    return _TYPES[value.type][1] + (f" {text}" if python is not None else "")


def not_set(name: str) -> Parameter:
    """Return a Parameter without a value. Setting it deletes the parameter of this name."""
    return Parameter(name=name, value=ParameterValue(type=ParameterType.PARAMETER_NOT_SET))
