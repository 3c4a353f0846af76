"""Holds the tables of functions in docs/guide/cell-programs.md against the headers and against what the tests call.

Usage: check_table.py ROOT
"""

import pathlib
import re
import sys


def without_comments(file):
    return re.sub(r"/\*.*?\*/", "", file.read_text(), flags=re.S)


def main():
    root = pathlib.Path(sys.argv[1])
    interfaces = {
        r"spe_\w+": (["ppu/libspe2/include/libspe2.h"], ["tests/libspe2"]),
        r"(?:sysSpu|sysEvent|lv2err)\w+": (
            [f"ppu/psl1ght/include/{name}.h" for name in ("lv2/spu", "sys/spu", "sys/event_queue", "sys/lv2errno")],
            ["tests/psl1ght"],
        ),
    }
    guide = (root / "docs/guide/cell-programs.md").read_text()
    wrong = []
    for name, (headers, tests) in interfaces.items():
        declared = set()
        for header in headers:
            text = re.sub(r"#define.*?[^\\]\n", "\n", without_comments(root / header), flags=re.S)
            declared |= set(re.findall(rf"^\w[^;{{]*?\b({name})\s*\(", text, flags=re.M))
        table = set(re.findall(rf"^\| `({name})` \|", guide, flags=re.M))
        sources = "".join(
            file.read_text()
            for folder in tests
            for file in sorted((root / folder).rglob("*"))
            if file.suffix in (".c", ".cpp", ".h")
        )
        called = set(re.findall(rf"\b({name})\b", sources))
        wrong += [f"{each}: is declared, and the table does not have it" for each in declared - table]
        wrong += [f"{each}: is in the table, and no header declares it" for each in table - declared]
        wrong += [f"{each}: no test calls it" for each in declared - called]
        if not declared:
            wrong.append(f"{headers} declare nothing that this script finds")
    for sentence in sorted(wrong):
        print(sentence, file=sys.stderr)
    return 1 if wrong else 0


sys.exit(main())
