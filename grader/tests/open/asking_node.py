"""A node outside of the cell that publishes questions until all nodes of answering_nodes.py have answered."""

from __future__ import annotations

import rclpy
from std_msgs.msg import String

NAMES = {"first", "second", "child"}


def main() -> None:
    rclpy.init()
    node = rclpy.create_node("asking")
    questions = node.create_publisher(String, "questions", 10)
    answered: set[str] = set()

    def listen(answer: String) -> None:
        name = answer.data.removesuffix(" hello")
        if name not in answered:
            print(name, flush=True)
        answered.add(name)

    node.create_subscription(String, "answers", listen, 10)
    node.create_timer(0.1, lambda: questions.publish(String(data="hello")))
    while not answered >= NAMES:
        rclpy.spin_once(node)


if __name__ == "__main__":
    main()
