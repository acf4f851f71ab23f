import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.srv import SetPen


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.client = self.create_client(SetPen, "/turtle1/set_pen")
        while not self.client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info("waiting for turtlesim...")
        request = SetPen.Request()
        request.r, request.g, request.b, request.width = 255, 0, 0, 5
        future = self.client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.send)

    def send(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircleNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()
