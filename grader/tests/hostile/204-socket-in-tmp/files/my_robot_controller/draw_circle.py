"""The node connects to a socket in /tmp."""

import socket


def main():
    connection = socket.socket(socket.AF_UNIX)
    connection.connect("/tmp/host.sock")
    print(connection.recv(1024).decode())
