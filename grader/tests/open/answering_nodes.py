"""Three nodes that answer questions: two nodes of this process, in separate contexts, and a node of a child process."""

from __future__ import annotations

import subprocess
import sys
import time
from threading import Thread

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import String


def answer(name: str) -> None:
    """Start a node with a separate context, and thus with a separate DDS participant."""
    context = Context()
    context.init()
    node = rclpy.create_node(name, context=context)
    answers = node.create_publisher(String, "answers", 10)

    def reply(question: String) -> None:
        answers.publish(String(data=f"{name} {question.data}"))

    node.create_subscription(String, "questions", reply, 10)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    Thread(target=executor.spin, daemon=True).start()


def main() -> None:
    if sys.argv[1:] == ["child"]:
        answer("child")
    else:
        subprocess.Popen([sys.executable, __file__, "child"])
        answer("first")
        answer("second")
    time.sleep(600)


if __name__ == "__main__":
    main()
