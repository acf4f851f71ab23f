"""A headless turtlesim: the motion and the pen's trail in pure Python, and an rclpy node around them."""
