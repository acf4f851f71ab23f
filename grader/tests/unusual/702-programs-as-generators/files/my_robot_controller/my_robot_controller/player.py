import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from turtlesim.msg import Pose


class Player:
    """Has a node, hears the pose, and sends the next command of a program at each call of a timer."""

    def __init__(self, name, period, program):
        self.node = rclpy.create_node(name)
        self.pose = None
        self.publisher = self.node.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.node.create_subscription(Pose, "turtle1/pose", lambda pose: setattr(self, "pose", pose), 10)
        self.program = program(self)
        self.node.create_timer(period, self.step)

    def step(self):
        forward, turning = next(self.program, (0.0, 0.0))
        twist = Twist()
        twist.linear.x = forward
        twist.angular.z = turning
        self.publisher.publish(twist)


def play(name, period, program, args=None):
    rclpy.init(args=args)
    player = Player(name, period, program)
    try:
        rclpy.spin(player.node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        player.node.destroy_node()
        rclpy.try_shutdown()
