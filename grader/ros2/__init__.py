"""The course's own `ros2`, for machines on which no ROS 2 is sourced."""
