#!/usr/bin/env python3
"""check_sources.py FOLDER...: what a host's compiler takes in kernels and an SPU g++ does not, or not so.

- A lambda's attribute in front of its return type: g++ 9 and 10 refuse it (PR c++/90333).
- A decimal float that is no sum of powers of two: an SPU g++ truncates it, as its arithmetic does, a host's
  rounds it. Where the two differ it has to be written in hexadecimal.
"""

import re
import struct
import sys
from fractions import Fraction
from pathlib import Path

ATTRIBUTE_BEFORE_TYPE = re.compile(r"__attribute__\s*\(\(\w+\)\)\s*(mutable\s*)?->")
COMMENT = re.compile(r"//.*")
DECIMAL = re.compile(r"(?<![\w.])(\d+\.?\d*(?:e[-+]?\d+)?)f\b")


def nearest_float(decimal):
    return struct.unpack("<f", struct.pack("<f", float(decimal)))[0]


def faults(path):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        code = COMMENT.sub("", line)
        if ATTRIBUTE_BEFORE_TYPE.search(code):
            yield f"{path}:{number}: g++ 9 takes no lambda with an attribute and a return type; leave the type out"
        for decimal in DECIMAL.findall(code):
            nearest = nearest_float(decimal)
            if Fraction(nearest) > Fraction(decimal):  # rounded up, which truncation never does
                yield f"{path}:{number}: {decimal}f is another number for an SPU g++; write {nearest.hex()}f"


def main():
    sources = [
        path
        for folder in sys.argv[1:]
        for path in sorted(Path(folder).rglob("*"))
        if path.suffix in (".h", ".cpp") and "host" not in path.parts
    ]
    found = [fault for source in sources for fault in faults(source)]
    print("\n".join(found) or f"{len(sources)} sources: nothing found")
    return 1 if found or not sources else 0


if __name__ == "__main__":
    sys.exit(main())
