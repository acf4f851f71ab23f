"""The ids of mistakes in functions and programs, with their meanings. diagnoses.py lists all ids."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis

OF_FUNCTIONS: dict[str, dict[Diagnosis, str]] = {
    "Functions and programs": {
        "function-missing": "the module does not have the required function, or does not exist",
        "result-form": "a function returns something other than the required numbers, such as None",
        "result-order": "a function returns the right values in the wrong order",
        "radius-squared": "the square of the radius is given as the radius",
        "diameter": "the diameter is given as the radius",
        "radius-without-centre": "the radius is computed without the squares of the centre's coordinates",
        "centre-doubled": "the centre is twice as far away as it should be",
        "centre-sign": "the centre has the wrong sign",
        "mean-for-centre": "the mean of the points of an arc is used as the centre",
        "extremes-for-centre": "the centre or the radius is computed only from the extremes of the points",
        "wrong-fit": "the fitted circle is wrong",
        "lists-refused": "a function works with arrays but not with lists",
        "caret-for-power": "^ is used as if it were a power",
        "array-arguments": "np.array is called with two lists",
        "list-for-array": "a program computes with a whole list, as if the list were an array",
        "own-name-read": "the program does not open the path in its first argument",
        "lstsq-result": "numpy's lstsq or solve is called incorrectly, or its result is used incorrectly",
        "refuses-circle": "a function raises ValueError for the points of a circle",
        "no-error": "a function returns a value instead of raising an exception",
        "other-error": "a function raises the wrong exception, or ends the program instead of raising one",
        "empty-error": "a function raises the right exception, but without a message",
        "call-too-long": "a function or a program does not end in time",
        "call-ended": "a function ends the whole program, or a program ends with an error but without a traceback",
        "prints-nothing": "the program prints nothing, or prints the line on standard error",
        "print-format": "the printed line has the wrong format",
        "wrong-count": "the number of messages is wrong",
        "program-traceback": "the program ends with a traceback instead of a message",
        "exit-code": "if something is missing, the program ends with exit code 0, without a message, or not by itself",
    },
}
