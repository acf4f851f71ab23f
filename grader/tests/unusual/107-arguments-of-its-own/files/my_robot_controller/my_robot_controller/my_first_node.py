import rclpy
from rclpy.node import Node


class MyFirstNode(Node):
    def __init__(self):
        super().__init__("node")
        self.__counter = 0
        self.__timer = self.create_timer(1.0, self.__callback)

    def __callback(self):
        self.get_logger().info("Hello " + repr(self.__counter))
        self.__counter += 1


def main():
    rclpy.init(args=["--ros-args", "-r", "__node:=first_node"])
    node = MyFirstNode()
    try:
        rclpy.spin(node)
    finally:
        node.destroy_node()
