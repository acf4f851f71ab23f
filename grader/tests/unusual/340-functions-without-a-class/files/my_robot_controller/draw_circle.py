import rclpy
from geometry_msgs.msg import Twist


def main():
    rclpy.init()
    node = rclpy.create_node("draw_circle")
    publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)

    def send():
        command = Twist()
        command.linear.x = 2.0
        command.angular.z = 1.0
        publisher.publish(command)

    node.create_timer(0.5, send)
    rclpy.spin(node)
