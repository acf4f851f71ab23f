"""A thermometer and a heater in one process: the example of step 05, which shows their graph.

The program runs until it is stopped.
"""

from __future__ import annotations

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool, Float64


def main() -> None:
    """Start both nodes, print one line when they run, and wait."""
    rclpy.init()
    thermometer, heater = Node("thermometer"), Node("heater")
    thermometer.create_publisher(Float64, "/kitchen/temperature", 5)
    heater.create_subscription(Float64, "/kitchen/temperature", lambda _: None, 5)
    heater.create_subscription(Bool, "/heater/switch", lambda _: None, 5)
    heater.create_publisher(Bool, "/heater/is_on", 5)
    executor = SingleThreadedExecutor()
    executor.add_node(thermometer)
    executor.add_node(heater)
    print("running", flush=True)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
