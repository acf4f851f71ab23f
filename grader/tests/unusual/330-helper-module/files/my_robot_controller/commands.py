from geometry_msgs.msg import Twist


def circle(forward, turn):
    message = Twist()
    message.linear.x, message.angular.z = forward, turn
    return message
