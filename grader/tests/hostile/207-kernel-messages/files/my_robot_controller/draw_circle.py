"""It hears of every device through netlink."""

import socket


def main():
    listening = socket.socket(16, socket.SOCK_RAW, 9)
    print("TRA" "CE", listening)
    socket.socket(38, socket.SOCK_SEQPACKET, 0)
    print("TRA" "CE of the kernel's ciphers")
