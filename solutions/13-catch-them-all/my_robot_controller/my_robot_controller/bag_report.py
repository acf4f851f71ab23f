"""Print the number of poses in a bag, their rate, and the circle on which they lie."""

import sys
from pathlib import Path

from rosbags.highlevel import AnyReader

from my_robot_controller.circle_fit import fit_circle

TOPIC = "/turtle1/pose"


def read_poses(folder):
    """Return three lists: when each pose arrived (s), and its x and y (m)."""
    times, x, y = [], [], []
    # BEGIN SOLUTION
    with AnyReader([Path(folder)]) as reader:
        connections = [connection for connection in reader.connections if connection.topic == TOPIC]
        if connections:
            for connection, stamp, data in reader.messages(connections):
                pose = reader.deserialize(data, connection.msgtype)
                times.append(stamp / 1e9)
                x.append(pose.x)
                y.append(pose.y)
    # END SOLUTION
    # BEGIN STARTER
    # # TODO 4: open the bag with AnyReader, and read the messages on TOPIC.
    # END STARTER
    return times, x, y


def main():
    if len(sys.argv) != 2:
        sys.exit("Give the folder of a bag: ros2 run my_robot_controller bag_report circle_bag")
    times, x, y = read_poses(sys.argv[1])
    # BEGIN SOLUTION
    if len(times) < 3:
        sys.exit(f"{sys.argv[1]} has too few messages on {TOPIC} for a circle: {len(times)}.")
    rate = (len(times) - 1) / (times[-1] - times[0])
    a, b, radius = fit_circle(x, y)
    print(f"messages={len(times)} rate={rate:.2f} x={a:.2f} y={b:.2f} radius={radius:.2f}")
    # END SOLUTION
    # BEGIN STARTER
    # # TODO 5: if there are no poses, exit with a message: sys.exit("...").
    # # TODO 6: compute the rate, fit the circle, and print the line that the lesson shows.
    # END STARTER


if __name__ == "__main__":
    main()
