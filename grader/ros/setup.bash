# Adds ROS 2, its commands and `grader` to this terminal. Type this in each new terminal, with your path:
#     source ~/ros2-course/.venv/setup.bash
# The file is in the root of the environment, as in /opt/ros/jazzy. If a ROS 2 Jazzy is sourced, the sourced ROS 2 is used.
if [ -z "${BASH_VERSION-}" ]; then
    echo "setup.bash is for bash, and this shell is not bash. In zsh, source setup.zsh in the same folder. In another shell," \
        "type bash first." >&2
    return 1 2> /dev/null || exit 1
fi
if [ "$0" = "${BASH_SOURCE-}" ]; then
    typed=$0
    case $typed in *[!A-Za-z0-9/._-]*) typed=${0@Q} ;; esac
    echo "setup.bash was run as a program, so this terminal is as it was before. Type: source $typed" >&2
    exit 1
fi
eval "$("$(CDPATH= builtin cd -- "$(dirname -- "${BASH_SOURCE[0]}")" > /dev/null && pwd)/bin/grader" env || [ $? != 126 ] || echo \
    "echo 'The system runs no programs from this .venv. To see the reason, type make demo in the folder of the course.' >&2")"
