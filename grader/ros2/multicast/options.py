"""The options of both verbs of `ros2 multicast`: the multicast group and the port."""

from __future__ import annotations

import argparse
import ipaddress

_GROUP, _PORT = "225.0.0.1", 49150


def add_address(parser: argparse.ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("--group", type=_group, default=_GROUP, help=f"the multicast group (default: {_GROUP})")
    parser.add_argument("--port", type=_port, default=_PORT, help=f"the port (default: {_PORT})")


def _group(text: str) -> str:
    try:
        right = ipaddress.IPv4Address(text).is_multicast
    except ValueError:
        right = False
    if not right:
        message = "value must be a valid IPv4 multicast address"
        raise argparse.ArgumentTypeError(message)
    return text


def _port(text: str) -> int:
    if not text.isdecimal() or not 0 < int(text) < 2**16:
        message = "value must be a port: an integer from 1 to 65535"
        raise argparse.ArgumentTypeError(message)
    return int(text)
