"""All challenges in one file."""
import rclpy

from my_robot_controller.draw_square import DrawSquareNode
from my_robot_controller.figure_eight import FigureEightNode
from my_robot_controller.go_to_goal import GoToGoalNode
from my_robot_controller.own_circle import OwnCircleNode


def run(cls):
    rclpy.init()
    node = cls()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def own_circle():
    run(OwnCircleNode)


def figure_eight():
    run(FigureEightNode)


def draw_square():
    run(FigureEightNode)


def go_to_goal():
    run(GoToGoalNode)
