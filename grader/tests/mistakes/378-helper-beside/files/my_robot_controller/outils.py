from geometry_msgs.msg import Twist


def vitesse(avant, tourne):
    t = Twist()
    t.linear.x = avant
    t.angular.z = tourne
    return t
