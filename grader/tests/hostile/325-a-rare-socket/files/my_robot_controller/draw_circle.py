"""The node opens sockets of rare protocols, whose kernel modules have had many vulnerabilities."""

import socket

KOBJECT_UEVENT, SCTP, UDP_LITE = 15, 132, 136
RARE = (
    (socket.AF_NETLINK, socket.SOCK_RAW, KOBJECT_UEVENT),
    (socket.AF_INET, socket.SOCK_STREAM, SCTP),
    (socket.AF_INET, socket.SOCK_DGRAM, UDP_LITE),
)


def main():
    opened = []
    for which in RARE:
        try:
            opened.append(socket.socket(*which))
        except OSError as error:
            print(error)
    print("TRA" "CE of a rare socket" if opened else "none")
