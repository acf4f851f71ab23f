import pytest
from geometry_msgs.msg import Twist


class TestWallGuard:
    def test_nothing_before_the_first_pose(self, bench):
        bench.run(5)
        assert bench.heard == []


    def test_ten_commands_a_second(self, bench):
        bench.pose(5.0, 5.0)
        bench.run(10)
        assert len(bench.heard) == 10


    def test_straight_on_in_the_middle(self, bench):
        bench.pose(5.0, 5.0)
        bench.run(2)
        command = bench.heard[-1]
        assert command.linear.x == pytest.approx(1.1)
        assert command.angular.z == pytest.approx(0.0)


    @pytest.mark.parametrize(("x", "y"), [(0.5, 5.0), (10.5, 5.0), (5.0, 0.5), (5.0, 10.5)])
    def test_turns_left_at_each_wall(self, bench, x, y):
        bench.pose(x, y)
        bench.run(2)
        command = bench.heard[-1]
        assert command.linear.x == pytest.approx(0.5)
        assert command.angular.z == pytest.approx(1.2)


    def test_straight_on_again_after_the_wall(self, bench):
        bench.pose(10.5, 5.0)
        bench.run(2)
        bench.pose(9.0, 5.0)
        bench.run(2)
        assert bench.heard[-1].angular.z == pytest.approx(0.0)


    def test_stops_when_no_pose_comes(self, bench):
        bench.pose(5.0, 5.0)
        bench.run(15)
        assert bench.heard[-1] == Twist()
