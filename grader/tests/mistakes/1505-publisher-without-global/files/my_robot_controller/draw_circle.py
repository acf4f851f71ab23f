import rclpy
from geometry_msgs.msg import Twist

publisher = None


def send():
    msg = Twist()
    msg.linear.x = 2.0
    msg.angular.z = 1.0
    publisher.publish(msg)


def main():
    rclpy.init()
    node = rclpy.create_node("draw_circle")
    publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
    node.create_timer(0.5, send)
    rclpy.spin(node)


if __name__ == "__main__":
    main()
