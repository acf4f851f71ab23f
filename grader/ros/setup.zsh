# Adds ROS 2, its commands and `grader` to this terminal. Type this in each new terminal, with your path:
#     source ~/ros2-course/.venv/setup.zsh
# The file is in the root of the environment, as in /opt/ros/jazzy. If a ROS 2 Jazzy is sourced, the sourced ROS 2 is used.
if [ -z "${ZSH_VERSION-}" ]; then
    echo "setup.zsh is for zsh, and this shell is not zsh. In bash, source setup.bash in the same folder." >&2
    return 1 2> /dev/null || exit 1
fi
if [ "$ZSH_EVAL_CONTEXT" = toplevel ]; then
    echo "setup.zsh was run as a program, so this terminal is as it was before. Type: source ${(q-)0}" >&2
    exit 1
fi
eval "$("${${(%):-%x}:A:h}/bin/grader" env || [ $? != 126 ] || echo \
    "echo 'The system runs no programs from this .venv. To see the reason, type make demo in the folder of the course.' >&2")"
