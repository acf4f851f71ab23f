"""A headless turtlesim: motion and trails in pure Python, and an rclpy node that uses them."""
