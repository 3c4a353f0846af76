#!/usr/bin/env python3
"""The SPU programs of this folder and their executables, which are kept in git (executables/).

    programs.py check                 each executable was made of the sources as they are: by the hashes in executables.txt
    programs.py compare SPU_ELF_AS    the assembler makes the same of the sources again (nothing to do without one: status 77)
    programs.py build SPU_ELF_AS      writes the executables and their hashes anew

The linker is the one beside the assembler.
"""
import hashlib
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SHARED = [HERE / name for name in ("program.inc", "program.ld", "start.s")]
RECORD = HERE / "executables.txt"
NOT_TRIED = 77


def programs():
    return sorted(path for path in HERE.glob("*.s") if path not in SHARED)


def hash_of(*paths):
    digest = hashlib.sha256()
    for path in paths:
        digest.update(path.read_bytes())
    return digest.hexdigest()


def executable(program):
    return HERE / "executables" / (program.stem + ".elf")


def loaded(elf):
    """What a loader takes of it: the entry, and address, size and bytes of each segment."""
    entry, offset = struct.unpack_from(">II", elf, 24)
    size, count = struct.unpack_from(">HH", elf, 42)
    segments = []
    for i in range(count):
        kind, begin, address, _, in_file, in_memory = struct.unpack_from(">6I", elf, offset + i * size)
        if kind == 1:
            segments.append((address, in_memory, elf[begin:begin + in_file]))
    return entry, sorted(segments)


def assemble(program, assembler, scratch):
    linker = assembler.with_name(re.sub("as$", "ld", assembler.name))
    objects = []
    for source in (HERE / "start.s", program):
        objects.append(scratch / (source.stem + ".o"))
        subprocess.run([assembler, "-I", HERE, "-o", objects[-1], source], check=True)
    # The linker writes the name of its output into it.
    name = executable(program).name
    subprocess.run([linker, "-T", HERE / "program.ld", "--build-id=none", "-o", name, *objects], cwd=scratch, check=True)
    return (scratch / name).read_bytes()


def record_of(program):
    return f"{program.stem} {hash_of(*SHARED, program)} {hash_of(executable(program))}"


def check():
    recorded = RECORD.read_text().splitlines()
    wrong = [f"{program.stem}: its sources or its executable changed; run programs.py build" for program in programs()
             if not executable(program).exists() or record_of(program) not in recorded]
    known = {program.stem for program in programs()}
    wrong += [f"{line.split()[0]}: recorded, but has no source" for line in recorded if line.split()[0] not in known]
    wrong += [f"{path.name}: has no source" for path in (HERE / "executables").iterdir() if path.stem not in known]
    print("\n".join(wrong) or f"{len(known)} executables match their sources")
    return 1 if wrong else 0


def compare(assembler):
    if not assembler.is_file():
        print("no assembler for spu-elf: not compared")
        return NOT_TRIED
    wrong = []
    with tempfile.TemporaryDirectory() as scratch:
        for program in programs():
            if loaded(assemble(program, assembler, pathlib.Path(scratch))) != loaded(executable(program).read_bytes()):
                wrong.append(f"{program.stem}: {assembler.name} makes another executable of its source; run programs.py build")
    print("\n".join(wrong) or f"{assembler.name} makes the same {len(programs())} executables")
    return 1 if wrong else 0


def build(assembler):
    with tempfile.TemporaryDirectory() as scratch:
        for program in programs():
            executable(program).write_bytes(assemble(program, assembler, pathlib.Path(scratch)))
    RECORD.write_text("".join(record_of(program) + "\n" for program in programs()))
    return 0


def main():
    arguments = sys.argv[1:]
    if arguments == ["check"]:
        return check()
    if len(arguments) == 2 and arguments[0] in ("compare", "build"):
        return {"compare": compare, "build": build}[arguments[0]](pathlib.Path(arguments[1]).absolute())
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
