import rclpy

from my_robot_controller.circle_node import DrawCircleNode

SPEED = 2.0
TURN = 1.0


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircleNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
