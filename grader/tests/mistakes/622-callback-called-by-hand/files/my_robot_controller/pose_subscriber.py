from math import hypot
import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose


class Oyente(Node):
    def __init__(self):
        super().__init__("pose_subscriber")
        self.anterior = None
        self.recorrido = 0.0
        self.sub = self.create_subscription(Pose, "/turtle1/pose", self.recibir(), 10)
        self.reloj = self.create_timer(1.0, self.informar)

    def recibir(self, pose):
        if self.anterior is not None:
            self.recorrido += hypot(pose.x - self.anterior.x, pose.y - self.anterior.y)
        self.anterior = pose

    def informar(self):
        p = self.anterior
        if p:
            self.get_logger().info(f"x={p.x:.2f} y={p.y:.2f} distance={self.recorrido:.2f}")


def main():
    rclpy.init()
    rclpy.spin(Oyente())
