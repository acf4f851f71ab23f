"""The node locks memory for the data of sockets, which the kernel counts per user."""

import socket

SO_ZEROCOPY = 60


def main():
    try:
        socket.socket(socket.AF_INET, socket.SOCK_STREAM).setsockopt(socket.SOL_SOCKET, SO_ZEROCOPY, 1)
    except OSError as error:
        print(error)
    else:
        print("TRA" "CE")
