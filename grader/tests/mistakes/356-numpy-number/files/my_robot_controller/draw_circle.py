import numpy as np
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist

class NumpyCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher_ = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.cb)
    def cb(self):
        vel = Twist()
        # v = w * r
        w = 1.0
        r = 2.0
        vel.linear.x = np.float32(w * r)
        vel.angular.z = w
        self.publisher_.publish(vel)

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(NumpyCircle())
