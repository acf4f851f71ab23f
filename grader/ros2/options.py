"""Options of many verbs, and functions that check their values."""

from __future__ import annotations

import argparse


def add_spin(parser: argparse.ArgumentParser) -> None:
    """Add the options of a verb that creates a node."""
    parser.add_argument(
        "--spin-time", type=float, help="wait at most this number of seconds for the graph (without a daemon)"
    )
    parser.add_argument("-s", "--use-sim-time", action="store_true", help="use the time from the topic /clock")


def add_look(parser: argparse.ArgumentParser) -> None:
    """Add the options of a verb that reads the graph."""
    add_spin(parser)
    parser.add_argument("--no-daemon", action="store_true", help="do not use or start the daemon")


def positive_int(text: str) -> int:
    """Convert an argument to a positive integer, for argparse."""
    value = _whole(text)
    if value is None or value < 1:
        message = "value must be a positive integer"
        raise argparse.ArgumentTypeError(message)
    return value


def unsigned_int(text: str) -> int:
    """Convert an argument to a non-negative integer, for argparse."""
    value = _whole(text)
    if value is None or value < 0:
        message = "value must be non-negative integer"
        raise argparse.ArgumentTypeError(message)
    return value


def positive_float(text: str) -> float:
    """Convert an argument to a positive number, for argparse."""
    try:
        value = float(text)
    except ValueError as error:
        message = "Expects a floating point number"
        raise argparse.ArgumentTypeError(message) from error
    if not 0 < value < float("inf"):
        message = "Value must be positive and finite" if value > 0 else "Value must be positive"
        raise argparse.ArgumentTypeError(message)
    return value


def _whole(text: str) -> int | None:
    try:
        return int(text)
    except ValueError:
        return None
