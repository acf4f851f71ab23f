"""The node compiles filters, of which all programs of the machine share a limited number."""

import ctypes
import socket
import struct

PR_SET_SECCOMP, SECCOMP_SET_MODE_FILTER, SECCOMP = 22, 1, 317
ATTACH_FILTER, ATTACH_REUSEPORT_FILTER = 26, 51
ALLOW = struct.pack("HBBI", 6, 0, 0, 0x7FFF0000)


def main():
    libc = ctypes.CDLL(None, use_errno=True)
    line = ctypes.create_string_buffer(ALLOW, len(ALLOW))
    program = struct.pack("HxxxxxxP", 1, ctypes.addressof(line))
    made = []
    for option in (ATTACH_FILTER, ATTACH_REUSEPORT_FILTER):
        try:
            udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            udp.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
            udp.bind(("127.0.0.1", 0))
            udp.setsockopt(socket.SOL_SOCKET, option, program)
            made.append(option)
        except OSError as error:
            print(option, error)
    if libc.prctl(38, 1, 0, 0, 0) == 0 and libc.prctl(PR_SET_SECCOMP, 2, program, 0, 0) == 0:
        made.append("prctl")
    if libc.syscall(SECCOMP, SECCOMP_SET_MODE_FILTER, 0, program) == 0:
        made.append("seccomp")
    # The same number means another option of IPv6, which Fast DDS uses.
    try:
        socket.socket(socket.AF_INET6, socket.SOCK_DGRAM).setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
    except OSError as error:
        made.append(f"IPV6_V6ONLY: {error}")
    print("TRA" "CE" if made else "no filters", made)
