"""Checks of a function that fits a circle: its centre and radius, and an error if the points determine no circle."""

from __future__ import annotations

import ast
import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import read_traceback
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_fit import RADIUS_OF_C, Fit, uses_extremes, why_fit, why_noisy
from grader.checks.causes.why_no_error import why_no_error
from grader.checks.kind import Kind, number, string
from grader.checks.outcome import Finding, failed, passed
from grader.common.words import a_list, count, nearest, shorten
from grader.submission.code import module_file
from grader.submission.where import Where
from grader.trial.called import TOO_LATE

if TYPE_CHECKING:
    from grader.checks.causes.crash import Crash
    from grader.evidence.evidence import Evidence
    from grader.exercise.call_inputs import Arc
    from grader.trial.called import Called

IN_MODULE = ", in <module>"
"""The end of a traceback entry for code outside of functions."""
DTYPE = re.compile(r"Cannot (?:construct a dtype from an array|interpret .* as a data type)|Field elements must be")
"""Matches numpy's messages about an array or a list in place of the type of an array."""
PARAMETERS = re.compile(r"TypeError: \w+\(\) (?:takes|missing) ")
"""Matches Python's message about a call with the wrong number of arguments."""
OPTION = re.compile(r"error: the following arguments are required: (?P<name>--?[\w-]+)")
"""Matches the message of argparse about a missing option."""
SLIPS = frozenset({"AttributeError", "ImportError", "ModuleNotFoundError", "NameError", "UnboundLocalError"})
"""Exceptions that nobody raises on purpose to reject points."""
SIGMAS = 6.0
"""The maximum error that noise may cause in a correct result, in standard deviations of the best fit."""


@dataclass(frozen=True, kw_only=True)
class FitCall:
    """One call that the trial makes to the student's function with the points of a circle."""

    call: str = string("the id of a call", about="The id of a `[[trial.points]]` that describes a circle.")
    rounding_m: float = number(
        1e-3,
        above=0,
        about="The maximum error of each value without noise (m). With noise, six standard deviations are added.",
    )


@dataclass(frozen=True, kw_only=True)
class RefusedCall:
    """One call that the trial makes to the student's function with points that determine no circle."""

    call: str = string("the id of a call", about="The id of a `[[trial.points]]` with the lists `x` and `y`.")


def fits_circle(evidence: Evidence, params: FitCall) -> Finding:
    """The function returns the centre and the radius of the circle on which the points lie."""
    called = evidence.called(params.call)
    arc = _arc(evidence, params.call)
    name = evidence.trial.calls.function.rpartition(":")[2]
    expected = (
        f"{name} returns x={arc.x_m:g}, y={arc.y_m:g} and radius={arc.radius_m:g} (m) for {arc.count} points from "
        f"{arc.from_deg:g}° to {arc.to_deg:g}°."
    )
    broken = _missing(evidence, called, expected, name) or stopped(evidence, called, expected, name)
    if broken is not None:
        return broken
    values = called.values
    where = evidence.place("lstsq", "solve")
    if values is None or len(values) != 3:
        observed = f"{name} returned {_form(called)}."
        cause = f"{name} must return three numbers: `return x, y, radius`."
        return failed(observed, expected, Cause("result-form", cause, where))
    observed = f"{name} returned x={values[0]:.3f}, y={values[1]:.3f} and radius={values[2]:.3f}."
    within = tolerances(arc, params.rounding_m)
    fit = Fit(arc, (values[0], values[1], values[2]), within, extremes=uses_extremes(evidence.code))
    if not all(math.isfinite(value) for value in values):
        if fit.centre_right:
            return failed(observed, expected, Cause(*RADIUS_OF_C).at(where))
        cause = (
            "In numpy, the square root of a negative number is NaN, and a division by zero gives NaN or infinity. "
            "numpy only prints a warning."
        )
        return failed(observed, expected, Cause("not-a-number", cause, where))
    if fit.right:
        return passed(observed)
    why = why_fit(fit)
    if why.diagnosis == "wrong-fit":
        why = why_noisy(evidence, fit) or why
    return failed(observed, expected, why.at(where))


def tolerances(arc: Arc, rounding_m: float) -> tuple[float, float, float]:
    """Return the maximum errors of centre x, centre y and radius (m)."""
    x, y, radius = (rounding_m + SIGMAS * each for each in arc.deviations())
    return x, y, radius


def stopped(evidence: Evidence, called: Called, expected: str, name: str) -> Finding | None:
    """Return a finding if the call did not end in time, raised an exception or ended the program, else None."""
    if called.ended == "exit 0":
        return None
    where = evidence.code.start
    late = _late(evidence, called, expected, name)
    if late is not None:
        return late
    crash = read_traceback(called.stderr, evidence.submission.files)
    if crash is not None:
        observed = f"{_raiser(evidence, called, name)} raised {crash.observed}."
        known = _why_raised(evidence, crash, called.id)
        if known is not None:
            return failed(observed, expected, known.at(crash.where or where))
        return crash_finding(evidence, crash, observed, expected)
    parameters = _other_parameters(evidence, called, expected, name)
    if parameters is not None:
        return parameters
    option = OPTION.search(called.stderr)
    if option is not None:
        text = f"The program gets its argument without an option such as {shorten(option['name'])}."
        return failed(f"{name} ended with an error of argparse.", expected, Cause("call-ended", text, where))
    last = called.stderr.strip().splitlines()[-1:]
    how = f"{called.ended or 'no result'}{f': {shorten(last[0], 80)}' if last else ''}"
    ended = "ended the program" if evidence.trial.calls.function else "ended"
    return failed(f"{name} {ended} ({how}).", expected, Cause("call-ended", "", where))


def _other_parameters(evidence: Evidence, called: Called, expected: str, name: str) -> Finding | None:
    """Return a finding if the function of the exercise has the wrong number of parameters, else None."""
    last = "".join(called.stderr.strip().splitlines()[-1:])
    function = evidence.trial.calls.function.rpartition(":")[2]
    if not PARAMETERS.match(last) or not last.startswith(f"TypeError: {function}()"):
        return None
    nodes = [(each, node) for each in evidence.code.modules for node in each.nodes]
    own = [(each, node) for each, node in nodes if isinstance(node, ast.FunctionDef) and node.name == function]
    where = [Where(each.file, node.lineno) for each, node in own]
    text = f"{function} is called with two arguments: the x of all points, and the y of all points."
    cause = Cause("argument-missing" if "missing" in last else "too-many-arguments", text)
    return failed(f"{name} raised {shorten(last, 90)}.", expected, cause.at(next(iter(where), None)))


def _raiser(evidence: Evidence, called: Called, name: str) -> str:
    """Return what raised the exception: the function or program, or the import of the function's module."""
    imports = evidence.trial.calls.function and IN_MODULE in called.stderr and f", in {name}" not in called.stderr
    return f"The import of {name}" if imports else name


def _missing(evidence: Evidence, called: Called, expected: str, name: str) -> Finding | None:
    """Return a finding if the module or the function is missing, else None."""
    module = evidence.trial.calls.function.partition(":")[0]
    file = module_file(module, evidence.submission.files)
    if file is None:
        path = f"{module.replace('.', '/')}.py"
        return failed(f"There is no file {path}.", expected, Cause("function-missing", "", Where(path)))
    if not called.stderr.rstrip().endswith(f"AttributeError: module '{module}' has no attribute '{name}'"):
        return None
    nodes = (node for each in evidence.code.modules if each.file == file for node in each.nodes)
    known = {node.name: node.lineno for node in nodes if isinstance(node, ast.FunctionDef)}
    guess = nearest(name, known)
    cause = f"The file has a function {shorten(guess)}." if guess else ""
    where = Where(file, known[guess] if guess else None)
    return failed(f"{file} has no function {name}.", expected, Cause("function-missing", cause, where))


def _late(evidence: Evidence, called: Called, expected: str, name: str) -> Finding | None:
    """Return a finding if the call did not return, or was not made because an earlier call did not, else None."""
    late = any(each.ended == TOO_LATE for each in evidence.run.called or ())
    if not late or called.ended not in (TOO_LATE, ""):
        return None
    observed = f"{name} did not end in time."
    if not called.ended:
        observed = f"{name} was not called with this input, because an earlier call did not end."
    cause = "A loop may never end, or the code may wait for something that never happens."
    return failed(observed, expected, Cause("call-too-long", cause, evidence.code.start))


def _why_raised(evidence: Evidence, crash: Crash, id_: str) -> Cause | None:
    """Return the cause of an exception that is typical of circle fitting, or None."""
    of_circle = any(each.id == id_ and each.arc for each in evidence.trial.calls.points)
    if of_circle and crash.error == "ValueError" and _is_raise(evidence, crash.where):
        cause = "Your own code raises this error for these points, although they form a circle."
        return Cause("refuses-circle", cause)
    if any(each.id == id_ and each.lists for each in evidence.trial.calls.points):
        arcs = {each.id for each in evidence.trial.calls.points if each.arc and each.id != id_}
        if any(each.id in arcs and each.values is not None for each in evidence.run.called or ()):
            cause = "The function works with numpy arrays, but not with lists. `np.asarray` accepts arrays and lists."
            return Cause("lists-refused", cause)
    if crash.error == "LinAlgError" and evidence.code.calls("solve"):
        cause = "solve needs exactly as many equations as unknowns. lstsq accepts more equations, one for each point."
        return Cause("lstsq-result", cause)
    stacks = evidence.code.calls("vstack")
    if stacks and crash.error == "LinAlgError":
        cause = "vstack puts the arrays below each other. The matrix needs one row for each point, with three columns."
        return Cause("lstsq-result", cause, stacks[0].where)
    if DTYPE.search(crash.message) and evidence.code.calls("array"):
        cause = "The second argument of np.array is the type of the elements. Call np.array once for each list."
        return Cause("array-arguments", cause, evidence.code.calls("array")[0].where)
    if evidence.code.calls("lstsq") and "expected 3, got 2" in crash.message:
        cause = "lstsq returns one value for each column of the matrix. Three unknowns need three columns."
        return Cause("lstsq-result", cause)
    if evidence.code.calls("lstsq") and (crash.error == "LinAlgError" or "to unpack" in crash.message):
        cause = (
            "lstsq takes the matrix first and the right-hand side second. lstsq returns four values: the solution, "
            "the residuals, the rank and the singular values."
        )
        return Cause("lstsq-result", cause)
    return None


def _is_raise(evidence: Evidence, where: Where | None) -> bool:
    """Return whether the line is a raise statement."""
    modules = (module for module in evidence.code.modules if where is not None and module.file == where.file)
    raised = [node for module in modules for node in module.nodes if isinstance(node, ast.Raise)]
    return any(where is not None and node.lineno == where.line for node in raised)


def refuses(evidence: Evidence, params: RefusedCall) -> Finding:
    """The function raises ValueError with a message for points that do not determine a circle."""
    called = evidence.called(params.call)
    name = evidence.trial.calls.function.rpartition(":")[2]
    x, y = next((each.x, each.y) for each in evidence.trial.calls.points if each.id == params.call)
    given = f"x = {list(x)} and y = {list(y)}"
    expected = f"{name} raises ValueError for {given}, with a message that explains why."
    crash = read_traceback(called.stderr, evidence.submission.files)
    raiser = _raiser(evidence, called, name)
    if "ValueError" in called.kind.split() and crash is not None and raiser == name:
        if not crash.message.strip():
            cause = "The argument of ValueError is the message, which says what is wrong with the points."
            return failed(
                f"{name} raises {crash.error} without a message.", expected, Cause("empty-error", cause, crash.where)
            )
        return passed(f"{name} raises {crash.observed}.")
    broken = _missing(evidence, called, expected, name) or _late(evidence, called, expected, name)
    if broken is not None:
        return broken
    where = evidence.place("ValueError", "lstsq", "solve")
    if called.ended == "exit 0":
        return failed(f"{name} returned {_form(called)}.", expected, why_no_error(evidence))
    if crash is not None and called.kind:
        if crash.error in SLIPS:
            return crash_finding(evidence, crash, f"{raiser} raised {crash.observed}.", expected)
        cause = "The caller expects ValueError, and cannot know what another exception means."
        cause = "" if raiser != name else cause
        return failed(f"{raiser} raised {crash.observed}.", expected, Cause("other-error", cause, crash.where or where))
    parameters = _other_parameters(evidence, called, expected, name)
    if parameters is not None:
        return parameters
    exits = called.ended.startswith("exit")
    cause = "sys.exit ends the whole program. After an exception, the caller can decide what to do." if exits else ""
    observed = f"{name} ended the program ({called.ended or 'no result'})."
    return failed(observed, expected, Cause("other-error", cause, where))


def _form(called: Called) -> str:
    if called.values is not None:
        numbers = a_list([f"{each:.3g}" for each in called.values])
        return f"{count(len(called.values), 'number')} ({numbers})" if numbers else "no numbers"
    return {"NoneType": "None", "str": "a string"}.get(called.kind, f"a value of type {shorten(called.kind, 30)}")


def _arc(evidence: Evidence, id_: str) -> Arc:
    arc = next((each.arc for each in evidence.trial.calls.points if each.id == id_), None)
    if arc is None:
        message = f"the points {id_} are not points of an arc"
        raise ValueError(message)
    return arc


FITS = Kind(
    "fits_circle",
    "trial",
    "The function finds the circle",
    FitCall,
    fits_circle,
    about="A function that is called with the points of a `[[trial.points]]` returns the centre and the radius of "
    "their circle.",
)
REFUSES = Kind(
    "raises_value_error",
    "trial",
    "The function refuses points that determine no circle",
    RefusedCall,
    refuses,
    about="The function raises ValueError with a message when it is called with the points of a `[[trial.points]]`.",
)
