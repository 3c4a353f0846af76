#!/usr/bin/env python3
"""missing_headers.py SPU_GCC SPU_GXX: a program that includes a header which SPU programs do not have is told why, in one sentence."""

import os
import subprocess
import sys
import tempfile

WHY = {  # None: the compiler's own sentence says all
    ".cpp": {
        "vector": "has neither containers nor streams",
        "iostream": "has neither containers nor streams",
        "thread": "no threads",
        "csignal": "no signals",
        "mine.h": None,
    },
    ".c": {
        "signal.h": "no signals",
        "pthread.h": "no threads",
        "locale.h": "no locales",
        "libspe2.h": "of the PPU side",
        "sys/mman.h": "not in the C library of SPU programs",
        "vector": "containers",
        "mine.h": None,
    },
}


def said_of(command: str, name: str, text: str) -> str:
    with open(name, "w", encoding="utf-8") as source:
        source.write(text)
    environment = dict(os.environ, LC_ALL="C", SOFTCELL_QUIET="1")
    ran = subprocess.run([command, "-MMD", "-c", name, "-o", "out.o"], capture_output=True, text=True, env=environment, timeout=60)
    return ran.stderr if ran.returncode != 0 else "nothing: it compiled"


def main() -> int:
    failures = []
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        for command, suffix in zip(sys.argv[1:3], (".c", ".cpp")):
            for header, why in WHY[suffix].items():
                said = said_of(command, "source" + suffix, f"#include <stdio.h>\n#include <{header}>\nint main(void) {{ return 0; }}\n")
                notes = [line for line in said.splitlines() if line.startswith(f"source{suffix}: note: ")]
                right = not notes if why is None else len(notes) == 1 and f"<{header}>" in notes[0] and why in notes[0]
                if f"source{suffix}:2:" not in said or not right:
                    failures.append(f"{suffix}, <{header}>: {said}")
            said = said_of(command, "source" + suffix, "#include <vector>\n#error no\n#include <vector>\n")
            if said.count("note: <vector>") > 1 or f"source{suffix}:1:" not in said:
                failures.append(f"{suffix}, an error besides: {said}")
            if said_of(command, "source" + suffix, "int main(void) { return nothing; }\n").count("note: <"):
                failures.append(f"{suffix}: a note without a missing header")
    print("\n".join(failures) or "missing headers are explained")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
