import rclpy
from geometry_msgs.msg import Twist, Vector3
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter


def main(args=None):
    rclpy.init(args=args)
    node = Node("draw_circle")
    speed = node.declare_parameter("speed", 2.0).value
    turn = node.declare_parameter("turn", Parameter.Type.DOUBLE)
    if turn.value is None:
        node.set_parameters([Parameter("turn", value=1.0)])
    command = Twist(linear=Vector3(x=speed), angular=Vector3(z=node.get_parameter("turn").value))
    publisher = node.create_publisher(Twist, "turtle1/cmd_vel", 10)
    node.create_timer(0.5, lambda: publisher.publish(command))
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
