import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class DibujaCirculo(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publicador = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.reloj = self.create_timer(0.5, self.mover)

    def mover(self):
        orden = Twist()
        orden.linear.x = 2.0  # adelante
        orden.angular.z = 1.0  # giro
        self.publicador.publish(orden)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(DibujaCirculo)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
