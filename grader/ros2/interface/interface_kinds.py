"""The options that limit the output of `interface` to messages, services or actions."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse

_NAMES = {"msg": "msgs", "srv": "srvs", "action": "actions"}


def add_kinds(parser: argparse.ArgumentParser) -> None:
    """Add the options."""
    for kind, what in (("msg", "messages"), ("srv", "services"), ("action", "actions")):
        parser.add_argument(f"-{kind[0]}", f"--only-{_NAMES[kind]}", action="store_true", help=f"only {what}")


def chosen(args: argparse.Namespace) -> list[str]:
    """Return the selected kinds ("msg", "srv", "action"). An empty list means all kinds."""
    return [kind for kind, name in _NAMES.items() if getattr(args, f"only_{name}")]
