"""A headless turtlesim: motion and trails without ROS 2, and an rclpy node that uses them."""
