"""The node connects to a service that listens on the host's loopback."""

import socket


def main():
    with socket.create_connection(("127.0.0.1", 8080), timeout=2.0) as connection:
        print(connection.recv(1024).decode())
