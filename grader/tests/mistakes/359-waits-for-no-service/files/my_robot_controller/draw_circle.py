import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from turtlesim.srv import SetPen

class ColorCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pen = self.create_client(SetPen, "/turtle1/setpen")
        while not self.pen.wait_for_service(1.0):
            self.get_logger().info("waiting for pen service...")
        req = SetPen.Request()
        req.r = 255
        self.pen.call_async(req)
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.go)
    def go(self):
        m = Twist()
        m.linear.x = 2.0
        m.angular.z = 1.0
        self.pub.publish(m)

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(ColorCircle())
    rclpy.shutdown()
