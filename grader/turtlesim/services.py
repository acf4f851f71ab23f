"""The names of the simulator's services. This module does not import rclpy, so that the grader's process can use it."""

OF_NODE = (
    "describe_parameters",
    "get_parameter_types",
    "get_parameters",
    "get_type_description",
    "list_parameters",
    "set_parameters",
    "set_parameters_atomically",
)
"""The services that rclpy adds to a node, under the name of the node."""
OF_TURTLE = ("set_pen", "teleport_absolute", "teleport_relative")
OF_TURTLESIM = ("/spawn", "/kill", "/reset", "/clear", *(f"/turtle1/{name}" for name in OF_TURTLE))
"""The services that turtlesim itself offers while turtle1 is its only turtle."""
SERVICES = (*OF_TURTLESIM, *(f"/turtlesim/{name}" for name in OF_NODE))
"""All services of the simulator while turtle1 is its only turtle. Those of actions are left out."""
