"""The node connects to an abstract socket, which needs no file."""

import socket


def main():
    connection = socket.socket(socket.AF_UNIX)
    connection.connect("\0host")
    print(connection.recv(1024).decode())
