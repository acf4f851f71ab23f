"""Look to the left and to the right. The plan is a plain loop in a thread of its own."""

import itertools
import math
import queue
import threading

import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_srvs.srv import Trigger
from turtlesim.action import RotateAbsolute

LEFT = math.radians(85)  # rad
RIGHT = math.radians(-80)  # rad


class Worker(threading.Thread):
    """Turns to one heading after the other, until a turn ends in another way than by success."""

    def __init__(self, client):
        super().__init__(daemon=True)
        self.client = client
        self.answers = queue.Queue()
        self.lock = threading.Lock()
        self.ticket = None
        self.remaining = None

    def run(self):
        self.client.wait_for_server()
        for heading in itertools.cycle((LEFT, RIGHT)):
            goal = RotateAbsolute.Goal(theta=heading)
            self.client.send_goal_async(goal, feedback_callback=self.progress).add_done_callback(self.answers.put)
            ticket = self.answers.get().result()
            with self.lock:
                self.ticket = ticket
            ticket.get_result_async().add_done_callback(self.answers.put)
            status = self.answers.get().result().status
            with self.lock:
                self.ticket = self.remaining = None
            if status != GoalStatus.STATUS_SUCCEEDED:
                return

    def progress(self, message):
        with self.lock:
            self.remaining = message.feedback.remaining

    def cancel(self):
        with self.lock:
            if self.ticket is None:
                return False
            self.ticket.cancel_goal_async()
            return True


class LookoutNode(Node):
    def __init__(self):
        super().__init__("lookout")
        self.worker = Worker(ActionClient(self, RotateAbsolute, "/turtle1/rotate_absolute"))
        self.create_service(Trigger, "/stop", self.stop)
        self.create_timer(0.5, self.report)
        self.worker.start()

    def report(self):
        with self.worker.lock:
            remaining = self.worker.remaining if self.worker.ticket is not None else None
        if remaining is not None:
            self.get_logger().info(f"{remaining:.2f} rad to go")

    def stop(self, request, response):
        response.success = self.worker.cancel()
        return response


def main(args=None):
    rclpy.init(args=args)
    node = LookoutNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
