from my_robot_controller.draw import CircleNode

cli = CircleNode.run
