import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from turtlesim.msg import Pose


class Odometer:
    """Adds up small steps; knows nothing of ROS."""

    def __init__(self):
        self.place = None
        self.way = 0.0

    def update(self, place):
        if self.place is not None:
            self.way += abs(place - self.place)
        self.place = place


class Listener(Node):
    def __init__(self):
        Node.__init__(self, 'pose_subscriber')
        odometer = Odometer()
        self.subscription = self.create_subscription(
            Pose, 'turtle1/pose', lambda pose: odometer.update(complex(pose.x, pose.y)), qos_profile_sensor_data)
        self.odometer = odometer
        self.create_timer(1.0, self.tell)

    def tell(self):
        place = self.odometer.place
        if place:
            self.get_logger().info('x=%.2f y=%.2f distance=%.2f' % (place.real, place.imag, self.odometer.way))


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(Listener())
    except KeyboardInterrupt:
        pass
