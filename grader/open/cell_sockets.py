"""Open UDP sockets inside a sandbox cell, send them to the grader outside, and then execute another program.

This file is executed as a script, before any student code is in the cell. The arguments of the script are the
descriptor of the Unix socket to the grader, the ports separated by commas, and the command of the other program.
"""

import os
import socket
import sys

HOST = "127.0.0.1"


def main() -> None:
    """Send the sockets in the order of the ports, and execute the command."""
    connection, ports, *command = sys.argv[1:]
    opened = []
    for port in map(int, ports.split(",")):
        opened.append(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        opened[-1].bind((HOST, port))
    with socket.socket(fileno=int(connection)) as grader:
        socket.send_fds(grader, [b"\0"], [each.fileno() for each in opened])
    os.execv(command[0], command)


if __name__ == "__main__":
    main()
