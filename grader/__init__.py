"""Grade ROS 2 packages: build them with colcon, run them with a headless turtlesim, and judge the recording."""

__version__ = "0.1.0"
