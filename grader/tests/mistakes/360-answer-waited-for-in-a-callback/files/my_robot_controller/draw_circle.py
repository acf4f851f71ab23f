import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from turtlesim.srv import SetPen

class DrawCircle(Node):
    def __init__(self):
        super().__init__('draw_circle')
        self.publisher_ = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.client_ = self.create_client(SetPen, '/turtle1/set_pen')
        self.timer_ = self.create_timer(0.5, self.timer_callback)

    def timer_callback(self):
        pen = SetPen.Request()
        pen.r = 200
        pen.width = 5
        self.client_.call(pen)
        twist = Twist()
        twist.linear.x = 2.0
        twist.angular.z = 1.0
        self.publisher_.publish(twist)

def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    rclpy.spin(node)
    rclpy.shutdown()
