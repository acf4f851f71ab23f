"""Find waits in callbacks: calls and loops that end late or never, so the executor cannot call other callbacks."""

from __future__ import annotations

import ast
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.callback_code import functions_in_callbacks, inside, last_name
from grader.common.words import shorten
from grader.submission.constants import dotted, evaluate, number
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

RESPONSES = ("call", "send_goal", "cancel_goal", "get_result")
"""Methods of service clients, action clients and goal handles that wait for the response.

For each of them, there is a method with the suffix _async, which does not wait."""
CREATE = ("create_client", "ActionClient")
"""The method and the class that create a client of a service or of an action."""
SPINS = ("spin", "spin_once", "spin_until_future_complete")
SERVERS = ("wait_for_service", "wait_for_server")
SLEEPS = ("sleep", "sleep_for", "sleep_until")
WAITS = (*RESPONSES, *SPINS, *SERVERS, *SLEEPS)
TIMEOUTS = {
    "call": 1,
    "wait_for_service": 0,
    "wait_for_server": 0,
    "spin_once": 0,
    "spin_until_future_complete": 1,
    "rclpy.spin_once": 2,
    "rclpy.spin_until_future_complete": 3,
}
"""The indexes of the argument timeout_sec of methods, and of functions of rclpy (rclpy 7.1)."""
DEADLOCK_OR_ERROR = "a deadlock, or an exception from rclpy 7.1.9 on"
"""What happens if a callback spins. The source is judged before the version of rclpy matters."""
LOOP = "while"
"""The `name` of a `Wait` that is a while loop whose condition calls done()."""
THREADS = frozenset({"MultiThreadedExecutor", "Thread", "ThreadPoolExecutor", "Timer", "start_new_thread"})
"""If the source uses one of these, another thread can receive the response while a callback waits."""
OTHER_CALLS = frozenset({"subprocess", "self", "super", "cls"})
"""Objects whose method `call` does not belong to a service client."""


@dataclass(frozen=True)
class Wait:
    """A wait in a callback: `name` is the function that waits, and `written` is its name or alias in the source.

    `timeout_s` is the timeout of the call (s): infinite if it has none, and None if it is not known from the source.
    """

    name: str
    written: str
    where: Where
    timeout_s: float | None = math.inf

    @property
    def needs_thread(self) -> bool:
        """Whether the node waits for a response, or spins. If it has one thread, it receives no response meanwhile."""
        return self.name in (LOOP, *RESPONSES, *SPINS)

    @property
    def limited(self) -> bool:
        """Whether the wait ends at a timeout."""
        return self.timeout_s != math.inf

    @property
    def deadlock(self) -> bool:
        """Whether a node with one thread waits forever."""
        return self.needs_thread and not self.limited

    @property
    def observed(self) -> str:
        """The end of a sentence that begins with "A callback": what the callback does."""
        return "loops until a future is done" if self.name == LOOP else f"calls {shorten(self.written)}"

    @property
    def cause(self) -> Cause:
        """The reason why a callback must not wait in this way, and the alternative."""
        if self.needs_thread and self.limited:
            return self._limited_cause
        if self.name in SPINS[:2]:
            text = (
                f"{self._subject} waits inside a callback, but the executor calls no other callback until this one "
                f"returns: {DEADLOCK_OR_ERROR}. Remove the call. rclpy.spin in main calls every callback."
            )
            return Cause("spins-in-callback", text, self.where)
        if self.deadlock:
            ends = DEADLOCK_OR_ERROR if self.name in SPINS else "a deadlock"
            text = (
                f"{self._subject} waits inside a callback, so rclpy.spin receives no response: {ends}. {self._instead}"
            )
            return Cause("waits-in-callback", text, self.where)
        if self.name in SERVERS:
            ready = self.name.replace("wait_for_", "") + "_is_ready"
            text = (
                f"{self._subject} waits inside a callback until the server exists, perhaps forever. Meanwhile, a node "
                f"with one thread calls no other callback. {ready} returns at once."
            )
            return Cause("waits-for-server", text, self.where)
        text = (
            "While a callback sleeps, a node with one thread calls no other callback. "
            "Count the timer calls instead, or use a second timer."
        )
        return Cause("sleep-in-callback", text, self.where)

    @property
    def refused_cause(self) -> Cause:
        """The reason why rclpy refuses to spin in a callback (from rclpy 7.1.9 on; earlier versions wait)."""
        text = (
            f"{self._subject} spins inside a callback, which rclpy.spin called, and rclpy does not spin twice at once. "
        )
        if self.name in SPINS[:2]:
            return Cause(
                "spins-in-callback", f"{text}Remove the call. rclpy.spin in main calls every callback.", self.where
            )
        return Cause("waits-in-callback", f"{text}{self._instead}", self.where)

    @property
    def _limited_cause(self) -> Cause:
        if self.name in SPINS[:2]:
            text = (
                f"{self._subject} waits inside a callback, at most until its timeout. Meanwhile, the executor calls no "
                "other callback. Remove the call. rclpy.spin in main calls every callback."
            )
            return Cause("spins-in-callback", text, self.where)
        text = (
            f"{self._subject} waits inside a callback until its timeout, because rclpy.spin receives no response "
            f"before the callback returns. {self._instead}"
        )
        return Cause("waits-in-callback", text, self.where)

    @property
    def _subject(self) -> str:
        if self.name == LOOP:
            return "A loop that checks done()"
        return self.name if self.name == self.written else f"{self.written}, which is {self.name},"

    @property
    def _instead(self) -> str:
        asynchronous = f"{self.name}_async" if self.name in RESPONSES else "the method that ends in _async"
        return f"Use {asynchronous}, and pass the next step to add_done_callback."


def waits_in_callbacks(evidence: Evidence) -> list[Wait]:
    """Return the waits in callbacks and in the functions that callbacks call, in their order in the source."""
    modules = evidence.code.modules
    aliases = _aliases(modules)
    own = {node.name for module in modules for node in module.nodes if isinstance(node, ast.FunctionDef)} & set(WAITS)
    clients = clients_of(modules)
    found: list[Wait] = []
    for module, function in functions_in_callbacks(modules):
        looped = {id(each) for node in inside(function) if isinstance(node, ast.While) for each in ast.walk(node.test)}
        for node in inside(function):
            where = Where(module.file, getattr(node, "lineno", None))
            if isinstance(node, ast.While) and "done" in (last_name(each) for each in _calls_in(node.test)):
                found.append(Wait(LOOP, LOOP, where))
            elif isinstance(node, ast.Call):
                written = last_name(node)
                name = aliases.get(written, "") if written not in own or _of_client(node, clients) else ""
                if isinstance(node.func, ast.Call):
                    name, written = _function_named(node.func, module), last_name(node.func)
                if name and _really_waits(node, name, written, module, in_loop=id(node) in looped):
                    found.append(Wait(name, written, where, timeout_s(node, name, module)))
    places = {module.file: index for index, module in enumerate(modules)}
    return sorted(set(found), key=lambda wait: (places[wait.where.file], wait.where.line or 0))


def has_threads(evidence: Evidence) -> bool:
    """Return whether the node may receive messages in a thread other than the thread that waits."""
    return any(
        getattr(node, "id", getattr(node, "attr", getattr(node, "name", ""))) in THREADS
        for module in evidence.code.modules
        for node in module.nodes
    )


def waits_in_callback(evidence: Evidence) -> Cause | None:
    """Return the cause if a callback, or a function that it calls, waits for a response or spins, else None.

    A wait that may be endless comes first.
    """
    waits = [wait for wait in waits_in_callbacks(evidence) if wait.needs_thread]
    return min(waits, key=lambda wait: wait.limited).cause if waits else None


def long_wait_in_callback(evidence: Evidence, period_s: float) -> Cause | None:
    """Return the cause if a callback waits for a response, or spins, and its timeout is at least a period (s).

    Otherwise, return None. In a node with several threads, such a wait need not delay anything. A timeout that is not
    known does not count.
    """
    if has_threads(evidence):
        return None
    waits = (wait for wait in waits_in_callbacks(evidence) if wait.needs_thread and wait.limited)
    return next((wait.cause for wait in waits if (wait.timeout_s or 0.0) >= period_s), None)


def _really_waits(call: ast.Call, name: str, written: str, module: Module, *, in_loop: bool) -> bool:
    if name in SERVERS:
        return in_loop or timeout_s(call, name, module) == math.inf
    if name in SPINS and timeout_s(call, name, module) == 0.0:
        return False
    if written != "call":
        return True
    owner = getattr(call.func, "value", None)
    if isinstance(owner, ast.Call):
        return last_name(owner) in CREATE
    return isinstance(owner, ast.expr) and dotted(owner) not in OTHER_CALLS


def _of_client(call: ast.Call, clients: frozenset[str]) -> bool:
    """Return whether the called function is a method of a client, not the node's own function with the same name."""
    owner = getattr(call.func, "value", None)
    if isinstance(owner, ast.Call):
        return last_name(owner) in CREATE
    return isinstance(owner, ast.expr) and dotted(owner) in clients


def clients_of(modules: Iterable[Module]) -> frozenset[str]:
    """Return the names of the variables that hold a client of a service or of an action."""
    return frozenset(
        dotted(target) or ""
        for module in modules
        for node in module.nodes
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and last_name(node.value) in CREATE
        for target in node.targets
    )


def timeout_s(call: ast.Call, name: str, module: Module) -> float | None:
    """Return the timeout (s) of a call to the function `name`: infinite if it has none, and None if it is not known.

    In rclpy, None and negative numbers mean no timeout.
    """
    timeout = _timeout(call, name)
    if timeout is None or (isinstance(timeout, ast.Constant) and timeout.value is None):
        return math.inf
    limit = number(timeout, module.names)
    return math.inf if limit is not None and limit < 0.0 else limit


def _timeout(call: ast.Call, name: str) -> ast.expr | None:
    """Return the argument that is the timeout of a call to a function that waits, or None."""
    by_name = [each.value for each in call.keywords if each.arg in ("timeout_sec", None)]
    owner = (dotted(call.func) or "other").rpartition(".")[0]
    place = TIMEOUTS.get(f"{owner or 'rclpy'}.{name}", TIMEOUTS.get(name))
    by_place = [] if place is None else call.args[place : place + 1]
    return next(iter((*by_name, *by_place)), None)


def _aliases(modules: Iterable[Module]) -> dict[str, str]:
    """Return the names under which the modules call functions that wait, each with the function's original name."""
    aliases = {name: name for name in WAITS}
    for module in modules:
        for node in module.nodes:
            if isinstance(node, ast.ImportFrom):
                aliases |= {each.asname: each.name for each in node.names if each.asname and each.name in WAITS}
            value = getattr(node, "value", None)
            if isinstance(node, ast.Assign | ast.AnnAssign | ast.NamedExpr) and isinstance(value, ast.expr):
                name = _function_named(value, module)
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                if name:
                    aliases |= {(dotted(target) or "").rpartition(".")[2]: name for target in targets}
    aliases.pop("", None)
    return aliases


def _function_named(value: ast.expr, module: Module) -> str:
    """Return the name of the waiting function to which `client.call`, partial(...) or getattr(...) refers, or ""."""
    if isinstance(value, ast.Attribute) and value.attr in WAITS:
        return value.attr
    if isinstance(value, ast.Call) and last_name(value) == "partial" and value.args:
        return _function_named(value.args[0], module)
    if isinstance(value, ast.Call) and last_name(value) == "getattr" and len(value.args) > 1:
        name = evaluate(value.args[1], module.names)
        return name if isinstance(name, str) and name in WAITS else ""
    return ""


def _calls_in(node: ast.AST) -> Iterator[ast.Call]:
    return (each for each in ast.walk(node) if isinstance(each, ast.Call))
