import rclpy
from rclpy.executors import ExternalShutdownException

from my_robot_controller.timetable import EIGHT, Timetable


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(Timetable("figure_eight", EIGHT))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
