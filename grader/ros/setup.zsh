# Puts ROS 2, its commands and `grader` into this terminal. Type this in each new terminal, with the real path:
#     source ~/ros2-course/.venv/setup.zsh
# It is in the root of the environment, like that of /opt/ros/jazzy. If a ROS 2 Jazzy is sourced, that one is used.
eval "$("${${(%):-%x}:A:h}/bin/grader" env)"
