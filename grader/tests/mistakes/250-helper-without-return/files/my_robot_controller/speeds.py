from geometry_msgs.msg import Twist


def speeds(forward, turn):
    twist = Twist()
    twist.linear.x = forward
    twist.angular.z = turn
