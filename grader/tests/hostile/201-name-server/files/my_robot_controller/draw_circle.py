"""The node queries a name server, through which it could send data out."""

import socket


def main():
    asking = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    asking.settimeout(2.0)
    asking.sendto(b"who is example.com?", ("127.0.0.1", 5353))
    print(asking.recv(1024).decode())
