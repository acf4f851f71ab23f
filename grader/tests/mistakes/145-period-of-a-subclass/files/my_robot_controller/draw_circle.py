import rclpy

from my_robot_controller.mover import Mover


class Circle(Mover):
    period = 0.2

    def speeds(self):
        return 2.0, 1.0


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Circle("draw_circle"))
    rclpy.shutdown()
