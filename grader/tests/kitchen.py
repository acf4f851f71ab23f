"""A thermometer and a heater in one process: the example of step 05, which shows their graph.

The program runs until it receives SIGINT or SIGTERM. It waits for these signals itself, because a signal that arrives
while an rclpy executor is running may be lost.
"""

from __future__ import annotations

import signal

import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool, Float64


def main() -> None:
    """Start both nodes, print one line when they run, and wait."""
    signals = {signal.SIGINT, signal.SIGTERM}
    signal.pthread_sigmask(signal.SIG_BLOCK, signals)
    rclpy.init()
    thermometer, heater = Node("thermometer"), Node("heater")
    thermometer.create_publisher(Float64, "/kitchen/temperature", 5)
    heater.create_subscription(Float64, "/kitchen/temperature", lambda _: None, 5)
    heater.create_subscription(Bool, "/heater/switch", lambda _: None, 5)
    heater.create_publisher(Bool, "/heater/is_on", 5)
    print("running", flush=True)
    signal.sigwait(signals)
    for node in (thermometer, heater):
        node.destroy_node()  # the nodes leave the graph now, and not when their lease ends
    rclpy.shutdown()


if __name__ == "__main__":
    main()
