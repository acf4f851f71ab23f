# ROS 2, its commands and `grader` in this terminal. Type this in each new one, from any folder, with the real path:
#     source ~/ros2-course/.venv/setup.bash
# Installed into the root of the environment, as /opt/ros/jazzy has one. Where a ROS 2 Jazzy is sourced, it is used.
eval "$("$(CDPATH= cd -- "$(dirname -- "${BASH_SOURCE[0]}")" > /dev/null && pwd)/bin/grader" env)"
