# node de test
import rclpy
from rclpy.node import Node

class TestNode(Node):
    def __init__(self):
        super().__init__('first_node')
        self.i = 0
        self.timer = self.create_timer(1, self.cb)

    def cb(self):
        print "Hello %d" % self.i
        self.i = self.i + 1

def main():
    rclpy.init()
    rclpy.spin(TestNode())
