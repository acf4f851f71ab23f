"""All kinds of checks. A check in exercise.toml selects its kind by name, with the key `kind`.

An exercise uses only a few kinds. The module of a kind is imported when the kind is first used, because importing all
modules takes 0.1 s.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from grader.checks.kind import Kind
    from grader.exercise.kind_spec import KindSpec, Param

_KINDS = {
    "plain_files": ("building", "PLAIN_FILES"),
    "package_xml": ("package_xml", "VALID"),
    "dependencies": ("package_xml", "DEPENDENCIES"),
    "package_name": ("package_xml", "NAME"),
    "builds": ("building", "BUILDS"),
    "installs": ("building", "INSTALLS"),
    "entry_point": ("entry_point", "ENTRY_POINT"),
    "node_starts": ("running", "STARTS"),
    "node_name": ("running", "NAME"),
    "publishes": ("topic", "PUBLISHES"),
    "topic_type": ("topic", "ONLY_TYPE"),
    "subscribes": ("topic", "SUBSCRIBES"),
    "rate": ("rate", "RATE"),
    "values": ("values", "VALUES"),
    "log_lines": ("log", "LOG_LINES"),
    "log_rate": ("log", "LOG_RATE"),
    "log_counter": ("log", "LOG_COUNTER"),
    "log_position": ("log_pose", "LOG_POSITION"),
    "log_distance": ("log_pose", "LOG_DISTANCE"),
    "circle": ("path", "CIRCLE"),
    "no_wall": ("path", "NO_WALL"),
    "own_numbers": ("own", "NUMBERS"),
    "own_circle": ("own", "CIRCLE"),
    "own_rate": ("own", "RATE"),
    "own_constants": ("own_constants", "CONSTANTS"),
    "figure_eight": ("eight", "EIGHT"),
    "square": ("square", "SQUARE"),
    "goal": ("goal", "GOAL"),
    "short_turn": ("short_turn", "SHORT_TURN"),
    "answers": ("answers", "ANSWERS"),
    "answer_text": ("answers", "TEXT"),
    "answer_list": ("answers", "LIST"),
    "answer_graph": ("answers", "GRAPH"),
    "answer_rate": ("answers", "RATE"),
    "no_calls": ("no_calls", "NO_CALLS"),
    "never_waits": ("waits", "NEVER_WAITS"),
    "arc": ("arc", "ARC"),
    "calls_service": ("services", "CALLS"),
    "answers_call": ("services", "ANSWERS"),
    "pause": ("pause", "PAUSE"),
    "declares_parameter": ("parameters", "DECLARES"),
    "sets_parameter": ("parameters", "SETS"),
    "sends_goals": ("goals", "SENDS_GOALS"),
    "awaits_result": ("goals", "AWAITS_RESULT"),
    "log_feedback": ("feedback", "LOG_FEEDBACK"),
    "cancels_goal": ("cancel", "CANCELS_GOAL"),
    "no_goal_after": ("cancel", "NO_GOAL_AFTER"),
    "says_whether_active": ("cancel", "SAYS_WHETHER_ACTIVE"),
    "star": ("star", "STAR"),
    "spawns_targets": ("spawning", "SPAWNS"),
    "places_differ": ("spawning", "PLACES_DIFFER"),
    "announces_targets": ("announcing", "ANNOUNCES"),
    "removes_targets": ("spawning", "REMOVES"),
    "catches_all": ("catching", "CATCHES"),
    "nearest_first": ("catching", "NEAREST_FIRST"),
    "within_reach": ("catching", "WITHIN_REACH"),
    "forgets_targets": ("forgetting", "FORGETS"),
    "waits_for_pose": ("catching", "WAITS_FOR_POSE"),
    "bag": ("recorded_bag", "READABLE"),
    "bag_topic": ("recorded_bag", "TOPIC"),
    "bag_circle": ("recorded_bag", "CIRCLE"),
    "fits_circle": ("fit", "FITS"),
    "raises_value_error": ("fit", "REFUSES"),
    "prints_report": ("program", "PRINTS"),
    "ends_with_message": ("program", "ENDS"),
    "bag_answer": ("bag_answers", "ANSWER"),
    "stops": ("stop", "STOP"),
    "tests_declared": ("tests_written", "DECLARED"),
    "tests_outside": ("tests_written", "OUTSIDE"),
    "tests_promises": ("tests_promises", "PROMISES"),
    "tests_steady": ("tests_written", "STEADY"),
    "tests_assert": ("tests_written", "ASSERTS"),
    "tests_found": ("tests_run", "FOUND"),
    "tests_pass": ("tests_run", "PASS"),
    "tests_catch": ("tests_run", "CATCHES"),
    "uses_timer": ("advice", "USES_TIMER"),
}
"""Maps the name of each kind to a module in grader.checks.subjects and to a constant in that module."""


class _Kinds(Mapping[str, "Kind[Any]"]):
    """A mapping from the name of each kind to the kind."""

    def __getitem__(self, name: str) -> Kind[Any]:
        module, constant = _KINDS[name]
        kind: Kind[Any] = getattr(import_module(f"grader.checks.subjects.{module}"), constant)
        return kind

    def __iter__(self) -> Iterator[str]:
        return iter(_KINDS)

    def __len__(self) -> int:
        return len(_KINDS)

    def __contains__(self, name: object) -> bool:
        return name in _KINDS


KINDS: Mapping[str, Kind[Any]] = _Kinds()


@dataclass(frozen=True)
class _Outline:
    """A kind without its parameters. The module of the kind is imported only if a check has no title of its own."""

    name: str
    advice: bool = False

    @property
    def title(self) -> str:
        """The title of the kind."""
        return KINDS[self.name].title

    def parameters(self) -> None:
        """Return None: no parameter is read."""

    def defaults(self) -> Mapping[str, Param]:
        """Return no parameters."""
        return {}


OUTLINES: Mapping[str, KindSpec] = {name: _Outline(name) for name in _KINDS}
"""All kinds without their parameters, for commands that only need the ids, titles and hints of an exercise."""
