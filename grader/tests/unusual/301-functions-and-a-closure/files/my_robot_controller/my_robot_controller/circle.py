import rclpy
from geometry_msgs.msg import Twist

SPEED = 2.0
TURN = 1.0
HZ = 2


def velocity(forward, turn):
    message = Twist()
    message.linear.x, message.angular.z = forward, turn
    return message


def sender(publisher, message):
    def send():
        publisher.publish(message)

    return send


def main():
    rclpy.init()
    node = rclpy.create_node('draw_circle')
    publisher = node.create_publisher(Twist, '/turtle1/cmd_vel', 1)
    node.create_timer(1 / HZ, sender(publisher, velocity(SPEED, TURN)))
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        print('bye')
    node.destroy_node()
