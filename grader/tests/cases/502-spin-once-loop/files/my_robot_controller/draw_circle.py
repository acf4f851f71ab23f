import rclpy
from geometry_msgs.msg import Twist


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("draw_circle")
    publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
    msg = Twist()
    msg.linear.x = 2.0
    msg.angular.z = 1.0
    while rclpy.ok():
        publisher.publish(msg)
        rclpy.spin_once(node, timeout_sec=0.5)
    node.destroy_node()
