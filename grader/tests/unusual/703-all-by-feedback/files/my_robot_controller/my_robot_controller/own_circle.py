import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

RADIUS = 1.8
RATE = 2.5
OMEGA = -1.25


class OwnCircle(Node):
    def __init__(self):
        super().__init__("own_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(RATE ** -1, self.go)

    def go(self):
        t = Twist()
        t.linear.x = RADIUS * abs(OMEGA)
        t.angular.z = OMEGA
        self.pub.publish(t)


def main(args=None):
    rclpy.init(args=args)
    node = OwnCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
