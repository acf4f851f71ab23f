import rclpy
from rclpy.node import Node

# only the node, the package stayed at home
rclpy.init()
node = Node("draw_circle")
rclpy.spin(node)
