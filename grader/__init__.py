"""Grade ROS 2 packages by running them: build with colcon, drive a headless turtlesim, judge what it saw."""

__version__ = "0.1.0"
