"""Headless turtlesim: motion and pen trail as pure Python, and the rclpy node around them."""
