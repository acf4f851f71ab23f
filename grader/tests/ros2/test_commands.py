"""Commands without recordings: their start, their options, the signals that they forward, and how they exit."""

from __future__ import annotations

import os
import signal
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.tests.domains import own_domain
from grader.tests.ros2.world import World, world
from grader.tests.waiting import HANG_S, until_gone

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(scope="module")
def still(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    """Create a world with turtlesim, but without a node that drives."""
    for made in world(tmp_path_factory.mktemp("still")):
        made.turtlesim()
        yield made


ROTATE = "/turtle1/rotate_absolute turtlesim/action/RotateAbsolute"
HALF_SET = """
import rclpy
from rclpy.parameter import Parameter
rclpy.init()
node = rclpy.create_node("half")
node.declare_parameter("number", 1)
node.declare_parameter("later", Parameter.Type.DOUBLE)
print("declared", flush=True)
rclpy.spin(node)
"""
KEEPS = """
import rclpy, signal
from rclpy.qos import QoSProfile, DurabilityPolicy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("keeper")
kept = node.create_publisher(String, "kept", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
kept.publish(String(data="old news"))
print("published", flush=True)
signal.pause()
"""


def package(prefix: Path, name: str, **executables: str) -> None:
    """Install a package with executables: its marker in the ament index, and its executables in lib/."""
    marker = prefix / "share/ament_index/resource_index/packages" / name
    marker.parent.mkdir(parents=True)
    marker.touch()
    for executable, text in executables.items():
        path = prefix / "lib" / name / executable
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)


@pytest.fixture
def tools(still: World, tmp_path: Path) -> Iterator[World]:
    """Yield the same test environment with an additional package."""
    said = '#!/bin/sh\nprintf "%s|" "$@"\necho\nexit 7\n'
    waits = "#!/bin/sh\necho waits\nexec sleep 600\n"
    package(tmp_path / "tools", "tools", say=said, wait=waits, broken="#!/no/such\n")
    (tmp_path / "tools/lib/tools/notes.txt").write_text("not an executable")
    made = World(still.home, {**still.env, "AMENT_PREFIX_PATH": f"{tmp_path}/tools:{still.env['AMENT_PREFIX_PATH']}"})
    yield made
    made.end()


def test_run_passes_arguments_and_the_exit_code_on(tools: World) -> None:
    done = tools.run("ros2 run tools say one 'two words' --ros-args -p x:=1 --prefix")
    assert done.stdout.splitlines() == [
        "one|two words|--ros-args|-p|x:=1|--prefix|",
        "[ros2run]: Process exited with failure 7",
    ]
    assert done.code == 7


def test_run_starts_it_with_a_prefix(tools: World) -> None:
    assert tools.run("ros2 run --prefix 'sh -c \"exec $0 $@\"' tools say one").stdout.startswith("one|\n")
    assert tools.run("ros2 run --prefix echo tools say one").stdout.split()[1:] == ["one"]


def test_run_tells_by_which_signal_the_program_ended(tools: World) -> None:
    for number, name in ((signal.SIGINT, "Interrupt"), (signal.SIGTERM, "Terminated"), (signal.SIGHUP, "Hangup")):
        running = tools.start("ros2 run tools wait", "waits")
        assert running.stop(number) == 256 - number
        assert running.lines == ["waits", f"[ros2run]: {name}"]


def test_a_signal_to_ros2_run_alone_ends_the_program_too(tools: World) -> None:
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGKILL):
        running = tools.start("ros2 run tools wait", "waits")
        program = running.program
        running.process.send_signal(number)
        running.process.wait(HANG_S)
        until_gone(program)


def test_run_of_what_cannot_be_started(tools: World) -> None:
    done = tools.run("ros2 run tools broken")
    assert done.code == 1
    assert "could not be started" in done.stderr
    listed = tools.run("ros2 pkg executables tools").stdout.splitlines()
    assert listed == ["tools broken", "tools say", "tools wait"]


def test_run_finds_an_interpreter_with_a_space_in_its_path(tools: World, tmp_path: Path) -> None:
    shell = tmp_path / "home of Ada/sh"
    shell.parent.mkdir()
    shell.symlink_to("/bin/sh")
    package(tmp_path / "built", "ours", quoted=f'#!"{shell}" -u\necho "$0" "$1"\n')
    env = {"AMENT_PREFIX_PATH": f"{tmp_path}/built:{tools.env['AMENT_PREFIX_PATH']}"}
    assert tools.run("ros2 run ours quoted one", **env).stdout == f"{tmp_path}/built/lib/ours/quoted one\n"


def test_run_finds_an_interpreter_with_a_path_that_is_too_long_for_linux(tools: World, tmp_path: Path) -> None:
    shell = tmp_path.joinpath(*["a" * 50] * 5, "sh")
    shell.parent.mkdir(parents=True)
    shell.symlink_to("/bin/sh")
    package(tmp_path / "built", "ours", long=f'#!{shell} -u\necho "$0" "$1"\n')
    env = {"AMENT_PREFIX_PATH": f"{tmp_path}/built:{tools.env['AMENT_PREFIX_PATH']}"}
    assert tools.run("ros2 run ours long one", **env).stdout == f"{tmp_path}/built/lib/ours/long one\n"


def test_the_first_of_two_prefixes_counts(tools: World, tmp_path: Path) -> None:
    package(tmp_path / "over", "tools", say="#!/bin/sh\necho over\n")
    env = {"AMENT_PREFIX_PATH": f"{tmp_path}/over:{tools.env['AMENT_PREFIX_PATH']}:/does/not/exist"}
    assert tools.run("ros2 run tools say", **env).stdout == "over\n"
    assert tools.run("ros2 pkg prefix tools", **env).stdout == f"{tmp_path}/over\n"


@pytest.mark.parametrize("first", [True, False])
def test_where_ros2cli_is_installed_its_ros2_is_used(first: bool, still: World, tmp_path: Path) -> None:
    sourced = tmp_path / "opt/ros/jazzy"
    package(sourced, "ros2cli")
    theirs = sourced / "bin/ros2"
    theirs.parent.mkdir()
    theirs.write_text('#!/bin/sh\necho theirs "$@"\n')
    theirs.chmod(0o755)
    parts = [str(theirs.parent), still.env["PATH"]]
    env = {
        "PATH": os.pathsep.join(parts if first else parts[::-1]),
        "AMENT_PREFIX_PATH": f"{sourced}:{still.env['AMENT_PREFIX_PATH']}",
    }
    assert still.run("ros2 topic list -t", **env).stdout == "theirs topic list -t\n"


@pytest.mark.parametrize(
    ("command", "ready"),
    [
        ("ros2 topic echo /turtle1/pose", "---"),
        ("ros2 topic echo --csv /turtle1/pose", "5.54"),
        ("ros2 topic echo /never std_msgs/msg/Empty", None),
        ("ros2 topic hz /turtle1/pose", "average rate"),
        ("ros2 topic pub -r 50 /chatter std_msgs/msg/String '{data: hi}'", "publishing #3"),
        ("ros2 topic pub --once /nobody std_msgs/msg/String", "Waiting for at least 1"),
        ("ros2 service call -r 20 /clear std_srvs/srv/Empty", "response:"),
        # No turn reaches this angle, so the goal never ends.
        (f"ros2 action send_goal --feedback {ROTATE} '{{theta: .nan}}'", "Feedback:"),
    ],
)
def test_ctrl_c_ends_a_verb_quietly(command: str, ready: str | None, still: World) -> None:
    running = still.start(command, ready)
    if ready is None:  # the verb prints nothing, but it runs when its node is in the graph
        while still.run("ros2 node list -a").stdout.count("/_ros2cli_") < 2:  # one is the node of `ros2 node list`
            assert running.process.poll() is None
    assert running.stop() == 2
    assert "Traceback" not in "\n".join(running.lines)


def test_a_verb_hears_by_loopback_and_nothing_else(still: World) -> None:
    running = still.start("ros2 topic hz /turtle1/pose", "average rate")
    process = Path("/proc", str(running.process.pid))
    assert "/dev/shm/fastrtps_" not in (process / "maps").read_text()
    sockets = set()
    for link in (process / "fd").iterdir():
        with suppress(FileNotFoundError):  # the process may close a file in the meantime
            sockets.add(link.readlink().name)
    rows = [row.split() for row in (process / "net/udp").read_text().splitlines()[1:]]
    addresses = {row[1].partition(":")[0] for row in rows if f"socket:[{row[9]}]" in sockets}
    multicast = "0100FFEF"
    assert addresses - {multicast} == {"0100007F"}
    running.stop()


def test_echo_of_a_part(still: World) -> None:
    assert still.run("ros2 topic echo --once /turtle1/pose --field x").stdout == "5.544444561004639\n---\n"
    assert still.run("ros2 topic echo --once /turtle1/pose --field x --csv").stdout == "5.544444561004639\n---\n"
    both = still.run("ros2 topic echo --once /turtle1/pose --field x --field y").stdout
    assert both == "5.544444561004639\n---\n" * 2
    assert still.run("ros2 topic echo --once --csv /turtle1/pose --field x --field y").stdout == (
        "5.544444561004639,5.544444561004639\n"
    )


def test_what_is_published_arrives(still: World) -> None:
    # Without a publisher, the default is best effort: a message that arrives before the publisher's data is lost.
    echo = still.start("ros2 topic echo --qos-reliability reliable /numbers std_msgs/msg/Float64MultiArray")
    sent = still.run(
        "ros2 topic pub -t 2 -r 50 -p 2 /numbers std_msgs/msg/Float64MultiArray '{data: [1, 2.5, 1e-3]}'"
    ).stdout
    assert "publishing #2" in sent
    assert "publishing #1" not in sent
    echo.wait_for("---", times=2)
    layout = ["layout:", "  dim: []", "  data_offset: 0"]
    assert echo.lines[: echo.lines.index("---")] == [*layout, "data:", "- 1.0", "- 2.5", "- 0.001"]
    echo.stop()


def test_echo_gets_the_last_message_of_a_transient_local_publisher(still: World) -> None:
    # A transient local publisher sends its last message to a late subscription.
    keeper = still.start(f"python3 -c '{KEEPS}'", "published")
    assert still.run("ros2 topic echo --once /kept").stdout == "data: old news\n---\n"
    keeper.stop()


def test_param_dump_is_a_parameter_file(still: World) -> None:
    dumped = still.run("ros2 param dump /turtlesim").stdout
    assert dumped.startswith("/turtlesim:\n  ros__parameters:\n    background_b: 255\n")
    assert "    qos_overrides:\n      /parameter_events:\n        publisher:\n          depth: 1000\n" in dumped
    (still.home / "params.yaml").write_text(dumped.replace("background_b: 255", "background_b: 12"))
    domain = str(own_domain())
    command = "ros2 run turtlesim turtlesim_node --ros-args --params-file params.yaml"
    other = still.start(command, "Spawning", ROS_DOMAIN_ID=domain)
    assert still.run("ros2 param get /turtlesim background_b --hide-type", ROS_DOMAIN_ID=domain).stdout == "12\n"
    other.stop()


def test_param_dump_leaves_out_only_a_parameter_without_a_value(still: World) -> None:
    half = still.start(f"python3 -c '{HALF_SET}'", "declared")
    assert "    number: 1\n" in still.run("ros2 param dump /half").stdout
    half.stop()


def test_options_of_lists(still: World) -> None:
    assert still.run("ros2 param list /turtlesim --param-type").stdout.startswith("  background_b (type: integer)\n")
    assert still.run("ros2 node list -c").stdout == "1\n"
    assert "/_ros2cli" in still.run("ros2 node list -a").stdout
    assert still.run("ros2 action info /turtle1/rotate_absolute -t").stdout.endswith(
        "    /turtlesim [turtlesim/action/RotateAbsolute]\n"
    )
    assert still.run("ros2 service find std_srvs/srv/Empty").stdout == "/clear\n/reset\n"
    assert "/turtle1/rotate_absolute/_action/status" in still.run("ros2 topic list --include-hidden-topics").stdout


def test_types_and_interfaces_work_together(still: World) -> None:
    shown = still.run("ros2 topic type /turtle1/pose | ros2 interface show -")
    assert shown.stdout.startswith("float32 x\n")
    listed = still.run("ros2 interface list -a").stdout
    assert listed == "Actions:\n    turtlesim/action/RotateAbsolute\n"
    assert "geometry_msgs\n" in still.run("ros2 interface packages -m").stdout


def test_a_new_package_is_right_by_the_courses_own_checks(still: World) -> None:
    create = "ros2 pkg create --build-type ament_python --license MIT --description 'It says \"it'\"'\"'s\" & <more>'"
    assert still.run(f"{create} --node-name my_node --dependencies rclpy std_msgs -- my_package").code == 0
    folder = still.home / "my_package"
    assert "Permission is hereby granted" in (folder / "LICENSE").read_text()
    build = "colcon build --base-paths my_package --build-base b --install-base i"
    built = still.run(f"{build} && . i/setup.bash && ros2 run my_package my_node")
    assert built.stdout.endswith("Hi from my_package.\n"), built
    assert "WARNING" not in built.stderr
    tested = still.run("cd my_package && python3 -m pytest -q test")
    assert tested.code in (0, 5), tested


@pytest.mark.exhaustive
def test_the_list_is_complete_each_time(still: World) -> None:
    whole = still.run("ros2 topic list -t").stdout
    assert whole.count("\n") == 5
    assert [still.run("ros2 topic list -t").stdout for _ in range(40)] == [whole] * 40
