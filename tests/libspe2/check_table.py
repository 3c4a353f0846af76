"""Holds the tables of functions in docs/guide/cell-programs.md and docs/reference/c-library.md against the headers and against what the
tests call, and libsync.h of the one side against that of the other.

Usage: check_table.py ROOT
"""

import pathlib
import re
import sys


def without_comments(file):
    return re.sub(r"/\*.*?\*/", "", file.read_text(), flags=re.S)


def sources_of(root, folders):
    return "".join(
        file.read_text()
        for folder in folders
        for file in sorted((root / folder).rglob("*"))
        if file.suffix in (".c", ".cpp", ".h")
    )


def check_c_library(root):
    """The functions of the C library of the local store; those of math.h count with their float twins."""
    headers = root / "spu_kernels/sdk/library/include"
    declared = set()
    for header in sorted(headers.rglob("*.h")):
        text = re.sub(r"//[^\n]*", "", without_comments(header))
        text = re.sub(r"^__attribute__\(\(error\([^;]*;", "", text, flags=re.M)  # what is refused
        declared |= set(re.findall(r"^[A-Za-z_][\w \t*]*?[\s*](\w+)\s*\([^;{]*\)[^;{]*;", text, flags=re.M))
        declared |= set(re.findall(r"^SC_FUNCTION_OF_[12]\((\w+)\)", text, flags=re.M))
        declared |= set(re.findall(r"^#define _(\w+) \1$", text, flags=re.M))
    declared -= {"softcell_assertion_failed", "name", "SC_CACHE_OF"}
    declared = {each for each in declared if not (each.endswith("f") and each[:-1] in declared)}
    page = set(re.findall(r"`(\w+)`", (root / "docs/reference/c-library.md").read_text()))
    called = sources_of(root, ("tests/programs/sources", "tests/labs", "tests/psl1ght", "tests/libspe2"))
    stems = set(re.findall(r"OF_(?:ONE|TWO|DOUBLES)\((\w+)\)", called)) | set(re.findall(r"\bX\((\w+)\)", called))
    words = set(re.findall(r"\w+", called)) | {stem + end for stem in stems for end in ("", "f", "4", "d2")}
    wrong = [f"{each}: is declared, and docs/reference/c-library.md does not have it" for each in declared - page]
    wrong += [f"{each}: no test calls it" for each in declared if each not in words and each + "f" not in words]
    if len(declared) < 200:
        wrong.append(f"only {len(declared)} functions of the C library are found")
    return wrong


def check_both_sides(root):
    """libsync.h has the same functions on both sides, and each has a name with an underscore and a header of its own."""
    sides = [(root / folder / "libsync.h").read_text() for folder in ("spu_kernels/sdk/library/include", "ppu/libspe2/include")]
    calls = [set(re.findall(r"^(?:SOFTCELL_SYNC_INLINE )?(?:void|int) ((?!softcell_)\w+)\(", side, flags=re.M)) for side in sides]
    shared = (root / "spu_kernels/sdk/shared/softcell_sync.h").read_text()
    names = set(re.findall(r"^#define _(\w+) \1$", shared, flags=re.M))
    wrong = [f"{each}: is in libsync.h of one side only" for each in calls[0] ^ calls[1]]
    wrong += [f"{each}: softcell_sync.h does not define _{each}" for each in calls[0] - names]
    folder = "spu_kernels/sdk/library/include"
    wrong += [f"{each}: {folder} has no {each}.h" for each in calls[0] if not (root / folder / f"{each}.h").exists()]
    called = set(re.findall(r"\w+", sources_of(root, ("tests/libspe2/ppu",))))
    wrong += [f"{each}: no test calls it on the PPU side" for each in calls[1] - called]
    if len(calls[0]) < 30:
        wrong.append("libsync.h declares nothing that this script finds")
    return wrong


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
        called = set(re.findall(rf"\b({name})\b", sources_of(root, tests)))
        wrong += [f"{each}: is declared, and the table does not have it" for each in declared - table]
        wrong += [f"{each}: is in the table, and no header declares it" for each in table - declared]
        wrong += [f"{each}: no test calls it" for each in declared - called]
        if not declared:
            wrong.append(f"{headers} declare nothing that this script finds")
    wrong += check_c_library(root) + check_both_sides(root)
    for sentence in sorted(wrong):
        print(sentence, file=sys.stderr)
    return 1 if wrong else 0


sys.exit(main())
