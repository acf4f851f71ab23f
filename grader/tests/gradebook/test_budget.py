"""The messages of a kernel that nbgrader may receive, tested one by one."""

from __future__ import annotations

import hashlib
import hmac
import json
from typing import Any

import pytest

from grader.gradebook.budget import DELIMITER, MIB, Account, Budget
from grader.notebook.frames import CHANNELS, MOST_PARTS, ORDER, FrameError, Unpacker, packed

KEY = b"key"
HEADER = {"msg_id": "1", "msg_type": "stream"}


def message(content: Any, *buffers: bytes, key: bytes = KEY, header: Any = HEADER) -> list[bytes]:  # noqa: ANN401
    """Return a message as a kernel sends it. `content` is sent unchanged if it is of the type bytes."""
    read: tuple[Any, ...] = (header, {}, {}, content)
    parts = [part if isinstance(part, bytes) else json.dumps(part).encode() for part in read]
    signature = hmac.new(key, b"".join(parts), hashlib.sha256).hexdigest().encode()
    return [b"topic", DELIMITER, signature, *parts, *buffers]


def refused(*messages: list[bytes], budget: Budget = Budget()) -> str:  # noqa: B008 - frozen
    """Return the reason why the last message is refused. All messages before the last one must be accepted."""
    account = Account(KEY, budget)
    for each in messages[:-1]:
        account.take(each)
    with pytest.raises(FrameError) as error:
        account.take(messages[-1])
    return str(error.value)


def test_messages_of_a_kernel_are_accepted() -> None:
    account = Account(KEY)
    for number in range(100):
        account.take(message({"text": f"{number} \N{TURTLE}", "data": [1, 2.5, None, True, {"a": []}]}, b"\0" * 100))


@pytest.mark.parametrize(
    "parts",
    [
        [],
        [DELIMITER],
        [b"x"] * 20,
        message({}, key=b"another"),
        message({})[:5],
        message([]),
        message({}, header={"msg_id": 1, "msg_type": "stream"}),
        message({}, header={}),
        message(b"{"),
        message(b'{"a": NaN}'),
        message(b'{"a": 1e400}'),
        message(b'{"a": 1%s}' % (b"0" * 1000)),
        message(b'{"a": "\\ud800"}'),
        message(b'{"\\udfff": 1}'),
        message(b"[" * 100_000),
        [b"x"] * 6 + message({}),
    ],
)
def test_data_that_are_not_a_message_are_refused(parts: list[bytes]) -> None:
    assert refused(parts) == "data that is not a Jupyter message"


def test_a_message_is_accepted_only_once() -> None:
    assert refused(message({}), message({})) == "data that is not a Jupyter message"


def test_messages_have_a_budget_in_number_bytes_values_and_depth() -> None:
    each = [message({"number": number}) for number in range(5)]
    assert refused(*each, budget=Budget(messages=4)) == "more than 4 messages"
    large = [message({}, bytes([number]), b"x" * MIB, header={**HEADER, "msg_id": str(number)}) for number in range(3)]
    assert refused(*large, budget=Budget(total=3 * MIB)) == "more than 3 MiB in all its messages"
    assert "more than 1000 values" in refused(message({"a": [0] * 1000}), budget=Budget(values=1000))
    nested: list[Any] = []
    for _ in range(60):
        nested = [nested]
    assert "objects nested more than 50 levels deep" in refused(message({"a": nested}))


def test_frames_survive_the_pipe_in_pieces_of_any_size() -> None:
    sent = [(0, [b"", b"a" * 1000]), (len(CHANNELS) - 1, []), (ORDER, [b"b"])]
    data = b"".join(packed(channel, parts) for channel, parts in sent)
    for size in (1, 3, 7, 5000):
        unpacker = Unpacker(2000)
        pieces = [data[start : start + size] for start in range(0, len(data), size)]
        assert [each for piece in pieces for each in unpacker.feed(piece)] == sent


@pytest.mark.parametrize(
    "data", [b"\xff\0\1", packed(0, [b""] * MOST_PARTS)[:1] + b"\xff\xff", packed(0, [b"x" * 3000])[:7]]
)
def test_a_frame_that_is_too_large_is_refused_before_it_is_read(data: bytes) -> None:
    with pytest.raises(FrameError):
        list(Unpacker(2000).feed(data))
