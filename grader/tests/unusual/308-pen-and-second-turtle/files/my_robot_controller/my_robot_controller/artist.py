import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.srv import SetPen, Spawn


class Artist(Node):
    def __init__(self):
        super().__init__('draw_circle')
        self.declare_parameter('turtle', 'turtle1')
        self.declare_parameter('radius', 2.0)
        self.declare_parameter('omega', 1.0)
        turtle = self.get_parameter('turtle').value
        self.publisher_ = self.create_publisher(Twist, f'/{turtle}/cmd_vel', 10)
        self.pen = self.create_client(SetPen, f'/{turtle}/set_pen')
        self.spawner = self.create_client(Spawn, '/spawn')
        self.timer_ = None
        while not self.pen.wait_for_service(timeout_sec=1.0):
            self.get_logger().info('service not available, waiting again...')
        request = SetPen.Request(r=255, g=200, b=0, width=4, off=0)
        self.pen.call_async(request).add_done_callback(self.pen_is_set)

    def pen_is_set(self, future):
        self.get_logger().info('The pen is yellow')
        self.spawner.call_async(Spawn.Request(x=1.0, y=1.0, theta=0.0, name='friend')).add_done_callback(self.begin)

    def begin(self, future):
        self.get_logger().info(f'{future.result().name} watches')
        self.timer_ = self.create_timer(0.5, self.timer_callback)

    def timer_callback(self):
        omega = self.get_parameter('omega').get_parameter_value().double_value
        radius = self.get_parameter('radius').get_parameter_value().double_value
        msg = Twist()
        msg.linear.x = omega * radius
        msg.angular.z = omega
        self.publisher_.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    artist = Artist()
    try:
        rclpy.spin(artist)
    except (KeyboardInterrupt, ExternalShutdownException) as stop:
        print(type(stop).__name__)
    finally:
        artist.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
