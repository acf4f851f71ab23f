from rclpy.node import Node


class FirstNode(Node):
    def __init__(self):
        super().__init__("first_node")
        self.counter = 0
        self.timer = self.create_timer(1.0, self.count)

    def count(self):
        self.get_logger().info(f"Hello {self.counter}")
        self.counter += 1
