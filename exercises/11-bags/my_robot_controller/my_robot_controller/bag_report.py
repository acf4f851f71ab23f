"""Print the number of poses in a bag, their rate, and the circle on which they lie."""

import sys
from pathlib import Path

from rosbags.highlevel import AnyReader

from my_robot_controller.circle_fit import fit_circle

TOPIC = "/turtle1/pose"


def read_poses(folder):
    """Return three lists: when each pose arrived (s), and its x and y (m)."""
    times, x, y = [], [], []
    # TODO 4: open the bag with AnyReader, and read the messages on TOPIC.
    return times, x, y


def main():
    if len(sys.argv) != 2:
        sys.exit("Give the folder of a bag: ros2 run my_robot_controller bag_report circle_bag")
    times, x, y = read_poses(sys.argv[1])
    # TODO 5: if there are no poses, exit with a message: sys.exit("...").
    # TODO 6: compute the rate, fit the circle, and print the line that the lesson shows.


if __name__ == "__main__":
    main()
