# -*- coding: utf-8 -*-
# Übung 1: der erste Knoten. Er zählt, jede Sekunde eine Zeile.
import rclpy
from rclpy.node import Node


class ErsterKnoten(Node):
	"""Zählt."""

	def __init__(self):
		super().__init__("first_node")
		self.zähler = 0		# fängt bei null an
		self.wecker = self.create_timer(1.0, self.zähle)

	def zähle(self):
		grüße = "Hello {}".format(self.zähler)
		self.get_logger().info(grüße)
		self.zähler = self.zähler + 1


def haupt(args=None):
	rclpy.init(args=args)
	knoten = ErsterKnoten()
	try:
		rclpy.spin(knoten)
	except KeyboardInterrupt:
		pass	# Strg-C
