"""It makes a socket that leads out of a virtual machine."""

import socket


def main():
    print("TRA" "CE", socket.socket(socket.AF_VSOCK, socket.SOCK_STREAM))
