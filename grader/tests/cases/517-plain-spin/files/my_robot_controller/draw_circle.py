import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.vel_publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_timer(0.5, self.publish_velocity)

    def publish_velocity(self):
        vel = Twist()
        vel.linear.x = 2.0
        vel.linear.y = 0.0
        vel.linear.z = 0.0
        vel.angular.x = 0.0
        vel.angular.y = 0.0
        vel.angular.z = 1.0
        self.vel_publisher.publish(vel)


def main(args=None):
    rclpy.init(args=args)
    draw_circle = DrawCircleNode()
    rclpy.spin(draw_circle)
    draw_circle.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
