import rclpy
from rclpy.node import Node



class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.cb)

    def cb(self):
        t = Twist()
        t.linear.x = 2.0
        t.angular.z = 1.0
        self.pub.publish(t)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    rclpy.spin(node)
    rclpy.shutdown()
