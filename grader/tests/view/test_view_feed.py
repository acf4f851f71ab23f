"""The simulator sends to its view through a real socket.

The simulator continues even if the other end does not read.
"""

from __future__ import annotations

import json
import math
import random
import socket
from contextlib import suppress
from types import SimpleNamespace
from typing import TYPE_CHECKING

import pytest
from PIL import Image

from grader.turtlesim.turtle import FRAME_S, SIDE_PX, Start
from grader.turtlesim.world import World
from grader.view.feed import LARGEST, MOST_LINES, MOST_RECEIVED, MOST_SENT, Feed
from grader.view.state import MOST_RATES, State
from grader.view.trail import place

if TYPE_CHECKING:
    from collections.abc import Iterator

MIDDLE = Start(5.0, 5.0, 0.0)


class Simulator:
    """A simulated turtlesim with its feed, and the messages that arrive at the other end."""

    def __init__(self) -> None:
        ours, self.view = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.view.settimeout(0.0)
        self.feed = Feed(ours)
        self.world = World(MIDDLE, self.feed.canvas)
        self.frames = 0

    def run(self, frames: int, *, paused: bool = False) -> None:
        for _ in range(frames):
            self.world.step(self.frames * FRAME_S)
            self.frames += 1
            self.feed.show(self.world.turtles, paused=paused)

    def reported(self) -> list[dict[str, object]]:
        """Return all messages that can be read now."""
        messages = []
        with suppress(BlockingIOError):
            while True:
                messages.append(json.loads(self.view.recv(LARGEST)))
        return messages


@pytest.fixture
def simulator() -> Iterator[Simulator]:
    made = Simulator()
    yield made
    made.feed.channel.close()
    made.view.close()


def twist(linear_x: float, angular_z: float) -> SimpleNamespace:
    zero = {"x": 0.0, "y": 0.0, "z": 0.0}
    return SimpleNamespace(
        linear=SimpleNamespace(**{**zero, "x": linear_x}), angular=SimpleNamespace(**{**zero, "z": angular_z})
    )


def test_every_second_frame_is_reported_while_the_turtle_moves(simulator: Simulator) -> None:
    simulator.world.command("turtle1", 2.0, 0.0, 1.0)
    simulator.run(20)
    assert len(simulator.reported()) == 10


def test_the_view_knows_what_the_simulator_knows(simulator: Simulator) -> None:
    simulator.world.command("turtle1", 2.0, 0.0, 1.0)
    simulator.feed.on_command("/turtle1/cmd_vel", b"", twist(2.0, 1.0))
    simulator.run(40)
    state = State()
    for message in simulator.reported():
        state.take(message)
    turtle = simulator.world.turtles["turtle1"]
    assert state.turtles["turtle1"][:5] == pytest.approx(turtle.state()[:5])
    (stroke,) = state.trail.strokes
    assert (stroke.points[0], stroke.points[-1]) == (place(5.0, 5.0), place(turtle.x, turtle.y))
    assert state.commands["/turtle1/cmd_vel"].twist == (2.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def test_a_turtle_at_rest_costs_no_messages(simulator: Simulator) -> None:
    simulator.run(2)
    simulator.reported()
    simulator.feed._reported_s = math.inf  # send a message regardless of the time
    simulator.run(40)
    assert simulator.reported() == []


def test_a_view_that_does_not_read_stops_nobody_and_gets_a_picture(simulator: Simulator) -> None:
    # This is enough to fill the socket.
    frames = 0
    while len(simulator.feed.canvas.lines) <= MOST_LINES + 100:
        simulator.world.command("turtle1", 1.0, 0.0, 1.5)
        simulator.run(50)
        frames += 50
        assert frames < 100_000
    messages = simulator.reported()
    simulator.run(2)
    messages += simulator.reported()
    state = State()
    for message in messages:
        state.take(message)
    assert messages[-1]["picture"]
    assert len(simulator.feed.canvas.lines) == 0
    painted, real = state.trail.painted(500), simulator.feed.canvas.trail()
    assert painted.getbbox() == real.getbbox()


def test_a_view_that_ends_with_unread_messages_stops_nobody(simulator: Simulator) -> None:
    simulator.run(4)
    simulator.view.close()
    simulator.world.command("turtle1", 1.0, 0.0, 0.0)
    simulator.run(4)
    with pytest.raises(ConnectionError):
        simulator.feed.requests()


def test_a_cleared_canvas_is_cleared_in_the_view(simulator: Simulator) -> None:
    simulator.world.command("turtle1", 1.0, 0.0, 0.0)
    simulator.run(10)
    simulator.world.canvas.clear()
    simulator.run(4)
    state = State()
    news = [state.take(message) for message in simulator.reported()]
    assert any("trail" in each for each in news[1:])
    begin = place(5.0 + 10 * 0.016, 5.0)
    assert [stroke.points[0] for stroke in state.trail.strokes] == [begin]


def test_a_position_that_is_no_number_is_reported_as_none(simulator: Simulator) -> None:
    simulator.world.command("turtle1", math.nan, 0.0, 0.0)
    simulator.run(2)
    state = State()
    (message,) = simulator.reported()
    news = state.take(message)
    turtles = news["turtles"]
    assert isinstance(turtles, dict)
    assert turtles["turtle1"][0] is None
    json.dumps(news, allow_nan=False)


def test_commands_are_heard_by_the_view_until_it_is_gone(simulator: Simulator) -> None:
    simulator.view.send(b'"pause"')
    simulator.view.send(b'"clear"')
    assert simulator.feed.requests() == ["pause", "clear"]
    simulator.view.close()
    with pytest.raises(ConnectionError):
        simulator.feed.requests()
    # A message without a receiver is not an error.
    simulator.run(4)


def test_a_picture_of_noise_fits_into_a_message_too(simulator: Simulator) -> None:
    noise = Image.frombytes("RGBA", (SIDE_PX, SIDE_PX), random.Random(1).randbytes(4 * SIDE_PX * SIDE_PX))
    simulator.feed.canvas.trail().paste(noise)
    simulator.feed.canvas.lines = [(0.0, 0.0, 1.0, 1.0, 1, 2, 3, 4)] * (MOST_LINES + 1)
    simulator.run(2)
    (message,) = simulator.reported()
    assert message["picture"]


def test_the_most_lines_fit_into_a_message(simulator: Simulator) -> None:
    line = (1 / 3, 10 / 3, 20 / 3, 32 / 3, 255, 255, 255, 255)
    simulator.feed.canvas.lines = [line] * MOST_LINES
    simulator.run(2)
    (message,) = simulator.reported()
    lines = message["lines"]
    assert isinstance(lines, list)
    assert len(lines) == MOST_LINES


def test_endless_new_turtles_neither_stop_the_simulator_nor_fill_the_view(simulator: Simulator) -> None:
    state = State()
    for begin in range(0, 5000, 500):
        for number in range(begin, begin + 500):
            simulator.feed.on_publish(f"/{'t' * 230}{number}/pose", "", b"")
            simulator.feed.on_command(f"/{'t' * 230}{number}/cmd_vel", b"", twist(1.0, 1.0))
        simulator.feed.canvas.lines = [(5.123456, 5.123456, 5.123456, 5.123456, 255, 255, 255, 255)] * MOST_LINES
        simulator.run(2)
        for message in simulator.reported():
            state.take(message)
    assert 0 < len(state.rates) <= MOST_RATES + MOST_RECEIVED + MOST_SENT
