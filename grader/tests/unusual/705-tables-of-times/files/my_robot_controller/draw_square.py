import rclpy
from rclpy.executors import ExternalShutdownException

from my_robot_controller.timetable import SQUARE, Timetable


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(Timetable("draw_square", SQUARE))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
