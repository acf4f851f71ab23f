"""Which exceptions an except clause or contextlib.suppress catches."""

from __future__ import annotations

import ast

from grader.submission.constants import dotted

EVERY_ERROR = frozenset({"Exception", "BaseException"})
"""The exceptions with which an except clause catches every error."""


def caught(handler: ast.ExceptHandler) -> frozenset[str]:
    """Return the names of the exceptions that the clause catches, without modules. A bare clause: BaseException."""
    if handler.type is None:
        return frozenset({"BaseException"})
    return _names(handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type])


def suppressed(call: ast.expr) -> frozenset[str]:
    """Return the names of the exceptions that a call of contextlib.suppress catches. For other expressions: none."""
    if isinstance(call, ast.Call) and (dotted(call.func) or "").rpartition(".")[2] == "suppress":
        return _names(call.args)
    return frozenset()


def _names(exceptions: list[ast.expr]) -> frozenset[str]:
    return frozenset((dotted(each) or "").rpartition(".")[2] for each in exceptions)
