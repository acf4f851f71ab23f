"""Convert a recording to JSON and back.

The conductor sends this JSON to the grader, and it is a part of each recording on the disk.
"""

from __future__ import annotations

import base64
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from grader.common.lazy import np
from grader.trial.observed import Call, Goal, Offer, PenChange, Track
from grader.trial.recording import (
    Beside,
    Command,
    Endpoint,
    Frames,
    Graph,
    LogLine,
    Message,
    Output,
    Pose,
    ProcessEnd,
    Recording,
)  # fmt: skip

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


def to_json(recording: Recording, *, messages: bool = True) -> dict[str, Any]:
    """Convert a recording to plain data. Without `messages`, leave out the message contents: they are in a bag."""
    frames = {name: getattr(recording.frames, name).tolist() for name in Frames.__dataclass_fields__}
    return _to_json(recording, frames, messages=messages)


def new_to_json(rows: Sequence[tuple[float, float, float, float, float, float, bool]], **values: Any) -> dict[str, Any]:  # noqa: ANN401
    """Return the plain data of a recording with these frames (see `frames_of`) and values, without importing numpy."""
    names = Frames.__dataclass_fields__
    columns = zip(*rows, strict=True) if rows else ((),) * len(names)
    frames = {
        name: list(map(bool if name == "wall" else float, column)) for name, column in zip(names, columns, strict=True)
    }
    return _to_json(Recording(frames=None, **values), frames, messages=True)  # type: ignore[arg-type]


def _to_json(recording: Recording, frames: dict[str, Any], *, messages: bool) -> dict[str, Any]:
    plain = {**recording.__dict__, "frames": None, "messages": None}
    data: dict[str, Any] = asdict(Recording(**plain))
    data["frames"] = frames
    data["messages"] = [
        [m.topic, m.type, base64.b64encode(m.data).decode() if messages else None, m.t_s, m.mono_s]
        for m in recording.messages
    ]
    return data


def from_json(data: dict[str, Any], payloads: Iterable[bytes] | None = None) -> Recording:
    """Return a recording from the result of `to_json`. If `data` has no message contents, `payloads` contains them."""
    contents = iter(payloads) if payloads is not None else (base64.b64decode(row[2]) for row in data["messages"])
    frames = data["frames"]
    wall = np.array(frames["wall"], dtype=np.bool_)
    columns = {name: np.array(frames[name], dtype=np.float64) for name in frames if name != "wall"}
    return Recording(
        **{
            **data,
            "start": Pose(**data["start"]),
            "messages": tuple(
                Message(topic, kind, content, t_s, mono_s)
                for (topic, kind, _, t_s, mono_s), content in zip(data["messages"], contents, strict=True)
            ),
            "commands": tuple(
                Command(c["t_s"], c["mono_s"], tuple(c["linear"]), tuple(c["angular"])) for c in data["commands"]
            ),
            "frames": Frames(**columns, wall=wall),
            "log": tuple(LogLine(**line) for line in data["log"]),
            "graphs": tuple(
                Graph(g["t_s"], tuple(g["nodes"]), tuple(Endpoint(**e) for e in g["endpoints"])) for g in data["graphs"]
            ),
            "topics": {topic: tuple(types) for topic, types in data["topics"].items()},
            "stdout": _output(data["stdout"]),
            "stderr": _output(data["stderr"]),
            "end": ProcessEnd(**data["end"]),
            "beside": tuple(
                Beside(each["executable"], _output(each["stdout"]), _output(each["stderr"]), ProcessEnd(**each["end"]))
                for each in data.get("beside", ())
            ),
            "own_nodes": tuple(data["own_nodes"]),
            "interventions": tuple(data["interventions"]),
            "calls": tuple(Call(**call) for call in data.get("calls", ())),
            "goals": tuple(Goal(**goal) for goal in data.get("goals", ())),
            "offers": tuple(Offer(**offer) for offer in data.get("offers", ())),
            "pens": tuple(PenChange(**{**pen, "color": tuple(pen["color"])}) for pen in data.get("pens", ())),
            "tracks": tuple(
                Track(track["turtle"], tuple(tuple(row) for row in track["rows"]), track["gone_s"])
                for track in data.get("tracks", ())
            ),
            "withdrawn": tuple(data.get("withdrawn", ())),
            "doubts": tuple(data["doubts"]),
            "stalls": tuple((begin, end) for begin, end in data["stalls"]),
        }
    )


def _output(data: dict[str, Any]) -> Output:
    return Output(data["text"], data["dropped"], tuple(data["times"]))
