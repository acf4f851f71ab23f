# Adds ROS 2, its commands and `grader` to this terminal. Type this in each new terminal, with your path:
#     source ~/ros2-course/.venv/setup.zsh
# The file is in the root of the environment, as in /opt/ros/jazzy. If a ROS 2 Jazzy is sourced, the sourced ROS 2 is used.
eval "$("${${(%):-%x}:A:h}/bin/grader" env)"
