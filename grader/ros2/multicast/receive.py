"""The verb `multicast receive`: wait for a UDP multicast packet."""

from __future__ import annotations

import socket
import struct
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error
from grader.ros2.multicast.options import add_address

if TYPE_CHECKING:
    import argparse

_LONGEST = 4096


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_address(parser)


def run(args: argparse.Namespace) -> int:
    """Wait for a packet and print it.

    Raises:
        Ros2Error: the port cannot be opened.
    """
    print("Waiting for UDP multicast datagram...", flush=True)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM, socket.IPPROTO_UDP) as receiver:
        try:
            receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
            receiver.bind(("", args.port))
            membership = struct.pack("4sl", socket.inet_aton(args.group), socket.INADDR_ANY)
            receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
        except OSError as error:
            message = f"Packets for {args.group}:{args.port} cannot be received: {error.strerror}"
            raise Ros2Error(message) from error
        try:
            data, (host, port) = receiver.recvfrom(_LONGEST)
        except KeyboardInterrupt:
            return 0
    print(f"Received from {host}:{port}: '{data.decode('utf-8', 'replace')}'")
    return 0
