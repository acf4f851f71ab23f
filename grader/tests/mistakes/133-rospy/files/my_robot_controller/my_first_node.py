#!/usr/bin/env python
import rospy
from std_msgs.msg import String

def main():
    rospy.init_node('first_node')
    rate = rospy.Rate(1)
    i = 0
    while not rospy.is_shutdown():
        rospy.loginfo("Hello %d" % i)
        i += 1
        rate.sleep()

if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
