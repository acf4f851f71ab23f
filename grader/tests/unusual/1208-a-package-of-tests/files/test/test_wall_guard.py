"""When the guard sends commands, and when it stops."""

from .support import Command, new_bench


def test_it_waits_for_a_pose():
    with new_bench() as bench:
        assert not bench.wait(1.0).commands


def test_ten_commands_in_a_second():
    with new_bench() as bench:
        assert len(bench.turtle(5.0, 5.0).wait(1.0).commands) == 10


def test_it_stops_without_poses():
    with new_bench() as bench:
        assert bench.turtle(5.0, 5.0).wait(1.1).commands[-1] == Command(1.1, 0.0)
        assert bench.wait(0.4).commands[-1] == Command(0.0, 0.0)
