"""The verb `multicast send`: send a UDP multicast packet."""

from __future__ import annotations

import socket
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error
from grader.ros2.multicast.options import add_address
from grader.ros2.options import positive_int

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_address(parser)
    parser.add_argument("--ttl", type=positive_int, help="time to live of the packet: each router subtracts 1")


def run(args: argparse.Namespace) -> int:
    """Send the packet.

    Raises:
        Ros2Error: the packet could not be sent.
    """
    print("Sending one UDP multicast datagram...", flush=True)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM, socket.IPPROTO_UDP) as sender:
        try:
            if args.ttl is not None:
                sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, args.ttl)
            sender.sendto(b"Hello World!", (args.group, args.port))
        except OSError as error:
            message = f"The packet could not be sent: {error.strerror}"
            raise Ros2Error(message) from error
    return 0
