"""The commands of `ros2` that a page may run: a fixed list of verbs that change nothing. No shell is used."""

from __future__ import annotations

import re
import shlex
import signal
import subprocess
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.interpreter import interpreter
from grader.common.words import nearest, shorten
from grader.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping

VERBS: Mapping[str, tuple[str, ...]] = {
    "topic": ("list", "info", "echo", "hz", "type", "find"),
    "interface": ("show", "list", "package", "packages"),
    "node": ("list", "info"),
    "service": ("list", "info", "type", "find"),
    "param": ("list", "get", "describe"),
    "action": ("list", "info", "type", "find"),
}
"""The allowed groups and verbs."""
_REFUSED: Mapping[str, tuple[str, ...]] = {
    "topic": ("pub", "bw", "delay"),
    "interface": ("proto",),
    "service": ("call", "echo"),
    "param": ("set", "delete", "load", "dump"),
    "action": ("send_goal", "echo"),
}
"""Other verbs of these groups. Users must type them in a terminal."""
_OPTIONS = frozenset(
    {*("-t", "-v", "-c", "-a"), *("--show-types", "--verbose", "--count-topics", "--no-comments", "--all", "--once")}
)
_WORD = re.compile(r"[A-Za-z0-9_/~.][A-Za-z0-9_/~.\-]*")
_MOST_WORDS = 8
LONGEST = 20_000
"""The maximum length of the output of a command (bytes)."""
HZ_S = 5.0
"""The time after which `ros2 topic hz` is stopped, and the maximum time for any command to exit after Ctrl-C (s)."""
PATIENCE_S = 15.0


@dataclass(frozen=True)
class Answer:
    """The output of the command, and whether the output is incomplete because the command was stopped."""

    output: str
    stopped: bool


def arguments(text: str) -> list[str]:
    """Return the arguments of `ros2` for a typed command.

        arguments("ros2 topic echo /turtle1/pose")  # ["topic", "echo", "/turtle1/pose", "--once"]

    Raises:
        UsageError: the command is not allowed, or it has a quote that is not closed or ends with a backslash.
    """
    try:
        words = shlex.split(text)
    except ValueError as error:
        message = f"The command has a quote that is not closed, or ends with a backslash: {text}."
        raise UsageError(message) from error
    words = words[1:] if words[:1] == ["$"] else words
    words = words[1:] if words[:1] == ["ros2"] else words
    if len(words) < 2 or words[1] not in VERBS.get(words[0], ()):
        guess = _meant(words)
        if guess:
            message = f"`ros2 {shorten(' '.join(words[:2]))}` is not a command. Did you mean `ros2 {guess}`?"
            raise UsageError(message)
        allowed = "; ".join(f"{group} {', '.join(verbs)}" for group, verbs in VERBS.items())
        message = f"Only commands that change nothing can be run here: {allowed}. Use a terminal for other commands."
        raise UsageError(message)
    wrong = [each for each in words[2:] if each not in _OPTIONS and not _WORD.fullmatch(each)]
    if wrong:
        message = f"{wrong[0]!r} is not allowed here. Use a terminal for this command."
        raise UsageError(message)
    if len(words) > _MOST_WORDS:
        message = f"At most {_MOST_WORDS} words are allowed after `ros2` here. Use a terminal for this command."
        raise UsageError(message)
    if words[:2] == ["topic", "echo"] and "--once" not in words:
        words.append("--once")
    return words


def _meant(words: list[str]) -> str:
    """Return the group and the verb that are similar to the first two words, or an empty string.

    A command of `ros2` that exists but cannot be run here does not count as a typo.
    """
    group = nearest(words[0], VERBS) if words else None
    if group is None or words[1:2] in ([], [""]):
        return ""
    if group == words[0] and words[1] in _REFUSED.get(group, ()):
        return ""
    verb = nearest(words[1], VERBS[group])
    return f"{group} {verb}" if verb else ""


def answer(words: list[str], env: Mapping[str, str]) -> Answer:
    """Run `ros2` with the arguments that `arguments` returned. Return its output.

    If `topic echo` or `topic hz` received too few messages, the output is a sentence that says so.
    """
    start = interpreter("-m", "grader.ros2.main", *words, env=env, searches=True)
    endless = words[:2] == ["topic", "hz"]
    patience_s = HZ_S if endless else PATIENCE_S
    process = subprocess.Popen(
        start.argv,
        env=start.env,
        cwd="/",
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
    )
    stopped = False
    try:
        output, _ = process.communicate(timeout=patience_s)
    except subprocess.TimeoutExpired:
        stopped = True
        process.send_signal(signal.SIGINT)
        try:
            output, _ = process.communicate(timeout=HZ_S)
        except subprocess.TimeoutExpired:
            process.kill()
            output, _ = process.communicate()
    if stopped and not output and words[:2] in (["topic", "echo"], ["topic", "hz"]):
        few = "Too few messages to measure a rate" if endless else "No message"
        return Answer(f"{few} arrived within {patience_s:.0f} s.", stopped=False)
    return Answer(output[:LONGEST].decode("utf-8", "replace"), stopped and not endless)
