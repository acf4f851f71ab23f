import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist

class CircleNode(Node):
    def __init__(self):
        super().__init__('draw_circle')
        self.pub = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.timer = self.create_timer(self.drive, 0.5)   # call drive every half second

    def drive(self):
        t = Twist()
        t.linear.x = 2.0
        t.angular.z = 1.0
        self.pub.publish(t)

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(CircleNode())
    rclpy.shutdown()
