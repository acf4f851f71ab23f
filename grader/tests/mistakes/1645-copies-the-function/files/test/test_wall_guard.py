import pytest

SPEED = 1.1
TURN = 1.2


def decide(x, y):
    if min(x, 11.0 - x, y, 11.0 - y) < 1.0:
        return 0.5, TURN
    return SPEED, 0.0


@pytest.mark.parametrize(("x", "y"), [(0.5, 5.0), (10.5, 5.0), (5.0, 0.5), (5.0, 10.5)])
def test_turns_near_a_wall(x, y):
    assert decide(x, y) == (0.5, TURN)


def test_straight_on_in_the_middle():
    assert decide(5.0, 5.0) == (SPEED, 0.0)
