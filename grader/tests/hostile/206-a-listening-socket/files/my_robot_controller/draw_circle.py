"""The node leaves a process behind that listens on a port."""

import socket


import os
import time


def main():
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            server = socket.create_server(("0.0.0.0", 9999))
            for fd in (0, 1, 2):
                os.close(fd)
            time.sleep(60)
            server.close()
        os._exit(0)
    time.sleep(0.5)
