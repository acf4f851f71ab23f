from pytest import approx, mark

from .support import Command, new_bench


@mark.parametrize("x", [1.5, 5.5, 9.5])
def test_straight_on(x):
    with new_bench() as bench:
        last = bench.turtle(x, 5.5).wait(0.2).commands[-1]
        assert last.__dict__ == approx({"speed": 1.1, "turn": 0.0})


@mark.parametrize("place", [(0.9, 5.0), (10.1, 5.0), (5.0, 0.9), (5.0, 10.1)])
def test_walls(place):
    with new_bench() as bench:
        assert bench.turtle(*place).wait(0.2).commands[-1] == Command(0.5, 1.2)
        assert bench.turtle(5.0, 5.0).wait(0.2).commands[-1] == Command(1.1, 0.0)
