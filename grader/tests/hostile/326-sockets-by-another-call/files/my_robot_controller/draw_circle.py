"""The node reaches rare protocols with socketpair, by the type of a socket and by a protocol of Netlink.

The kernel loads the module of a protocol even if the call fails afterwards.
"""

import errno
import socket

DCCP, XFRM = 6, 6
REFUSED = (errno.EAFNOSUPPORT, errno.ESOCKTNOSUPPORT, errno.EPROTONOSUPPORT)
WAYS = (
    lambda: socket.socketpair(socket.AF_VSOCK, socket.SOCK_STREAM),
    lambda: socket.socketpair(socket.AF_PACKET, socket.SOCK_RAW),
    lambda: socket.socket(socket.AF_INET, DCCP),
    lambda: socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, XFRM),
)


def main():
    reached = []
    for way in WAYS:
        try:
            reached.append(way())
        except OSError as error:
            print(error)
            if error.errno not in REFUSED:
                reached.append(error)
    print("TRA" "CE of a rare socket" if reached else "none")
