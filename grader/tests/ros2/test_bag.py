"""`ros2 bag`: a bag contains all messages and can be played again, however its recorder was stopped."""

from __future__ import annotations

import json
import shutil
import signal
import sqlite3
import time
from contextlib import closing, suppress
from typing import TYPE_CHECKING

import pexpect
import pytest
from mcap.reader import make_reader

from grader.ros2.bag.recovery import saved_messages
from grader.tests.ros2.world import World, world
from grader.tests.waiting import HANG_S, until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from grader.tests.ros2.world import Running

TALKER = """
import sys, rclpy
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from std_msgs.msg import Int32
rclpy.init()
node = rclpy.create_node("talker")
publisher = node.create_publisher(Int32, "/count", QoSProfile(depth=1000))
while not publisher.get_subscription_count():
    rclpy.spin_once(node, timeout_sec=0.05)
for number in range(int(sys.argv[1])):
    publisher.publish(Int32(data=number))
publisher.wait_for_all_acked()
print("sent", flush=True)
while rclpy.ok():
    rclpy.spin_once(node, timeout_sec=0.05)
"""
LISTENER = """
import rclpy
from rclpy.qos import QoSProfile
from std_msgs.msg import Int32
rclpy.init()
node = rclpy.create_node("listener")
def heard(message, info):
    print("heard", message.data, info["received_timestamp"], flush=True)
node.create_subscription(Int32, "/heard", heard, QoSProfile(depth=1000))
print("listening", flush=True)
rclpy.spin(node)
"""


@pytest.fixture
def quiet(tmp_path: Path) -> Iterator[World]:
    """Create a domain without nodes. The home folder contains two programs."""
    for made in world(tmp_path):
        made.home.joinpath("talker.py").write_text(TALKER)
        made.home.joinpath("listener.py").write_text(LISTENER)
        yield made


def record(here: World, options: str = "/count", count: int = 300) -> Running:
    """Start recording, and publish this number of messages. Return the recorder when it has received all messages."""
    recorder = here.start(f"ros2 bag record -o bag {options}", "Recording...")
    here.start(f"python3 talker.py {count}", "sent")
    return recorder


def numbers(folder: Path) -> list[int]:
    """Return the values in a bag, as a different library reads them."""
    (file,) = folder.glob("*.mcap")
    with file.open("rb") as stream:
        found = list(make_reader(stream).iter_messages())
    assert all(schema is not None and schema.name == "std_msgs/msg/Int32" for schema, _, _ in found)
    return [int.from_bytes(message.data[4:8], "little", signed=True) for _, _, message in found]


def saved(file: Path) -> int:
    """Return the number of messages in the file of a bag that is still being recorded."""
    if file.suffix == ".mcap":
        return len(list(saved_messages(file)))
    copy = shutil.copyfile(file, file.parents[1] / "copy.db3")
    with closing(sqlite3.connect(copy)) as connection, suppress(sqlite3.Error):
        (count,) = connection.execute("SELECT COUNT(*) FROM messages").fetchone()
        return 0 if file.with_name(f"{file.name}-journal").exists() else int(count)
    return 0


@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.exhaustive)])
def test_all_that_arrived_before_the_end_is_in_the_bag(quiet: World, number: signal.Signals) -> None:
    recorder = record(quiet, count=500)
    assert recorder.stop(number) == 0
    assert numbers(quiet.home / "bag") == list(range(500))
    reported = quiet.run("ros2 bag info bag").stdout
    # rosbag2 counts metadata.yaml, too.
    size = sum(file.stat().st_size for file in (quiet.home / "bag").iterdir())
    assert f"Bag size:          {size / 1024:.1f} KiB\n" in reported
    assert "Files:             bag_0.mcap\n" in reported
    assert "ROS Distro:        jazzy\n" in reported
    assert "Messages:          500\n" in reported
    assert "Topic: /count | Type: std_msgs/msg/Int32 | Count: 500 | Serialization Format: cdr\n" in reported
    assert quiet.run("ros2 bag info -t bag").stdout == "/count\n"


def test_a_bag_is_played_in_its_rhythm_to_another_topic(quiet: World) -> None:
    record(quiet, count=50).stop()
    listener = quiet.start("python3 listener.py", "listening")
    done = quiet.run("ros2 bag play bag --remap /count:=/heard --rate 4")
    listener.wait_for("heard", 50)
    assert done.code == 0
    assert "Set rate to 4" in done.stderr
    assert [line.split()[1] for line in listener.lines if "heard" in line] == [str(number) for number in range(50)]


def test_a_burst_does_not_wait_and_pauses_after_so_many_messages(quiet: World) -> None:
    record(quiet, count=30).stop()
    listener = quiet.start("python3 listener.py", "listening")
    burst = quiet.start("ros2 bag burst bag -n 10 --remap /count:=/heard", "Playback until")
    listener.wait_for("heard", 10)
    burst.stop(signal.SIGINT)
    assert quiet.run("ros2 bag burst bag --remap /count:=/heard").code == 0
    listener.wait_for("heard", 40)
    heard = [line.split()[1] for line in listener.lines if "heard" in line]
    assert heard == [str(number) for number in (*range(10), *range(30))]


@pytest.mark.parametrize(("storage", "ending"), [("mcap", ".mcap"), ("sqlite3", ".db3")])
def test_a_killed_recording_is_made_whole(quiet: World, storage: str, ending: str) -> None:
    recorder = record(quiet, f"-s {storage} /count")
    recorder.wait_for("All requested topics are subscribed")
    # The recorder writes all messages to the file, at most one second later. The reindex of rosbag2 finds only files
    # with a number.
    until(lambda: saved(quiet.home / f"bag/bag_0{ending}") == 300)
    recorder.stop(signal.SIGKILL)
    refused = quiet.run("ros2 bag info bag")
    assert refused.code == 1
    assert "ros2 bag reindex bag" in refused.stderr
    assert quiet.run("ros2 bag reindex bag").code == 0
    assert "Messages:          300\n" in quiet.run("ros2 bag info bag").stdout
    assert sorted(path.name for path in (quiet.home / "bag").iterdir()) == [f"bag_0{ending}", "metadata.yaml"]


def test_a_disk_that_is_full_is_reported_and_the_bag_can_be_read(quiet: World) -> None:
    # A limit on the file size causes the same error as a full disk. Python must not store compiled modules meanwhile,
    # because it would truncate them.
    command = "ulimit -f 8; PYTHONDONTWRITEBYTECODE=1 exec ros2 bag record -o bag /count"
    recorder = quiet.start(f'bash -c "{command}"', "Recording...")
    quiet.start("python3 talker.py 100", "sent")
    until(lambda: saved(quiet.home / "bag/bag_0.mcap") == 100)
    quiet.start("python3 talker.py 900", "sent")  # fewer than the depth of the talker's queue
    assert recorder.process.wait(HANG_S) == 1
    recorder.wait_for("File too large")
    assert quiet.run("ros2 bag reindex bag").code == 0
    assert quiet.run("ros2 bag info bag").code == 0
    found = numbers(quiet.home / "bag")
    assert found == [*range(100), *range(len(found) - 100)]


def test_convert_puts_bags_together(quiet: World) -> None:
    record(quiet, count=20).stop()
    options = quiet.home / "options.yaml"
    options.write_text("output_bags:\n- {uri: new, storage_id: sqlite3, all_topics: true}\n")
    assert quiet.run("ros2 bag convert -i bag -i bag -o options.yaml").code == 0
    assert "Count: 40 " in quiet.run("ros2 bag info new").stdout
    options.write_text("output_bags: 3\n")
    refused = quiet.run("ros2 bag convert -i bag -o options.yaml")
    assert refused.code == 1
    assert "an example:" in refused.stderr


def test_space_pauses_and_the_right_arrow_steps(quiet: World) -> None:
    record(quiet, count=5).stop()
    listener = quiet.start("python3 listener.py", "listening")
    command = "ros2 bag play bag --start-paused --remap /count:=/heard"
    player = pexpect.spawn("bash", ["-c", command], env=quiet.env, cwd=quiet.home, timeout=HANG_S, encoding="utf-8")
    player.expect_exact("Press SPACE for Pause/Resume")
    player.expect_exact("Playback until timestamp: -1")
    player.send("\x1b[C")
    listener.wait_for("heard 0")
    resumed_ns = time.time_ns()
    player.send(" ")
    player.expect_exact("Resuming play.")
    listener.wait_for("heard 4")
    player.expect(pexpect.EOF)
    _, *later = (int(line.split()[2]) for line in listener.lines if "heard" in line)
    assert [stamp > resumed_ns for stamp in later] == [True] * 4


def test_a_loop_over_nothing_ends_and_a_wrong_regular_expression_is_reported(quiet: World) -> None:
    record(quiet, count=2).stop()
    # The bag has no messages after its end.
    assert quiet.run("ros2 bag play bag --loop --start-offset 1000").code == 0
    quiet.home.joinpath("options.yaml").write_text("output_bags:\n- {uri: new, regex: '('}\n")
    for command in ("play bag --regex '('", "play bag -x '('", "convert -i bag -o options.yaml"):
        refused = quiet.run(f"ros2 bag {command}")
        assert refused.code == 1
        assert "The regular expression '(' cannot be read" in refused.stderr


@pytest.mark.parametrize(
    ("command", "text", "code"),
    [
        ("ros2 bag record", "Need to specify at least one option out of --all", 1),
        ("ros2 bag record -o there -a", "Output folder 'there' already exists.", 1),
        ("ros2 bag record -e '('  -o new", "cannot be read", 1),
        ("ros2 bag record -a --use-sim-time --no-discovery", "are incompatible settings", 1),
        ("ros2 bag record -a --snapshot-mode", "--snapshot-mode needs a full ROS 2", 1),
        ("ros2 bag record -a --services --snapshot-mode", "--services and --snapshot-mode need a full ROS 2", 1),
        ("ros2 bag record -a -o /proc/bag", "Could not create bag folder '/proc/bag'.", 1),
        ("ros2 bag play nowhere", "Bag path 'nowhere' does not exist!", 2),
        ("ros2 bag play there --rate 0", "0 is not in the valid range (> 0.0)", 2),
        ("ros2 bag play there --rate inf", "inf is not a finite number", 2),
        ("ros2 bag play there --start-offset inf", "inf is not a finite number", 2),
        ("ros2 bag play there --remap x", "'x' is not a remapping", 1),
        ("ros2 bag info there", "No metadata.yaml in 'there'.", 1),
        ("ros2 bag info broken", "The bag 'broken' cannot be read", 1),
        ("ros2 bag reindex there", "No .mcap or .db3 file in 'there'", 1),
    ],
)
def test_a_bag_command_that_fails_prints_an_error_without_a_traceback(
    quiet: World, command: str, text: str, code: int
) -> None:
    quiet.home.joinpath("there").mkdir()
    quiet.home.joinpath("broken").mkdir()
    quiet.home.joinpath("broken/metadata.yaml").write_text(json.dumps({"rosbag2_bagfile_information": []}))
    done = quiet.run(command)
    assert text in done.stderr
    assert "Traceback" not in done.stderr
    assert done.code == code
