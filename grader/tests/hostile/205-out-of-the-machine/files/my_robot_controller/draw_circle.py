"""The node creates a socket that connects to the host of a virtual machine."""

import socket


def main():
    print("TRA" "CE", socket.socket(socket.AF_VSOCK, socket.SOCK_STREAM))
