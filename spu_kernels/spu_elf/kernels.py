#!/usr/bin/env python3
"""softcell's kernels as executables for the SPU, which are kept in git so that nobody needs the compiler to run them.

    kernels.py check                      each executable was made of the sources as they are: by the hashes in kernels.txt
    kernels.py check COMPILER FOLDER      the compiler's executables in FOLDER are the same bytes
    kernels.py update COMPILER FOLDER     copies those of FOLDER here, and writes the hashes anew

Without a compiler a stale executable is told, with status 77: it still runs. FOLDER is spu_kernels/spu_elf of a build with SOFTCELL_SPU_CXX.
"""
import hashlib
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
KERNELS = HERE.parent
RECORD = HERE / "kernels.txt"
SHARED = [KERNELS / "sdk/spu/start.s", KERNELS / "sdk/spu/ls.ld"]
SKIPPED = 77


def declarations():
    """Of each kernel that CMakeLists.txt declares: the declaration."""
    text = (KERNELS / "CMakeLists.txt").read_text()
    return {found[1]: found[0] for found in re.finditer(r"softcell_add_spu_kernel\((\w+)[^)]*\)", text)}


def sources(path, known):
    """The file and all that it includes of spu_kernels."""
    if path not in known:
        known.add(path)
        for name in re.findall(r'^ *# *include *"([^"]+)"', path.read_text(), re.MULTILINE):
            beside = [folder / name for folder in (path.parent, KERNELS, KERNELS / "sdk/shared") if (folder / name).is_file()]
            if beside:
                sources(beside[0], known)
    return known


def hash_of_sources(name, declaration):
    settings = (KERNELS.parent / "cmake/SoftcellKernelSettings.cmake").read_text()
    digest = hashlib.sha256(declaration.encode())
    for flags in re.findall(r"set\(SOFTCELL_SPU_C\w*_FLAGS.*?\)", settings, re.DOTALL):
        digest.update(flags.encode())
    for path in sorted(sources(KERNELS / f"{name}.cpp", set())) + SHARED:
        digest.update(path.read_bytes())
    return digest.hexdigest()


def record_of(name, declaration):
    elf = HERE / f"{name}.elf"
    return f"{name} {hash_of_sources(name, declaration)} {hashlib.sha256(elf.read_bytes()).hexdigest() if elf.exists() else '-'}"


def version_of(compiler):
    return subprocess.run([compiler, "-dumpfullversion"], check=True, capture_output=True, text=True).stdout.strip()


def recorded():
    lines = RECORD.read_text().splitlines() if RECORD.exists() else [""]
    return lines[0].removeprefix("compiler "), lines[1:]


def check(compiler, folder):
    version, lines = recorded()
    known = declarations()
    stale = [f"{name}: its sources changed, or its executable" for name in known if record_of(name, known[name]) not in lines]
    stale += [f"{path.name}: is no kernel's" for path in HERE.glob("*.elf") if path.stem not in known]
    if compiler and version_of(compiler) == version:
        stale += [f"{name}: the compiler makes another executable" for name in known
                  if not (HERE / f"{name}.elf").exists() or (folder / f"{name}.elf").read_bytes() != (HERE / f"{name}.elf").read_bytes()]
    if not stale:
        print(f"{len(known)} executables match their sources")
        return 0
    print("\n".join(stale))
    print("stale executables for the SPU: build with SOFTCELL_SPU_CXX, then run kernels.py update COMPILER FOLDER")
    return 1 if compiler else SKIPPED


def update(compiler, folder):
    known = declarations()
    for name in known:
        (HERE / f"{name}.elf").write_bytes((folder / f"{name}.elf").read_bytes())
    for path in HERE.glob("*.elf"):
        if path.stem not in known:
            path.unlink()
    RECORD.write_text("".join(line + "\n" for line in [f"compiler {version_of(compiler)}", *(record_of(name, known[name]) for name in known)]))
    return 0


def main():
    arguments = sys.argv[1:]
    if arguments == ["check"]:
        return check(None, None)
    if len(arguments) == 3 and arguments[0] in ("check", "update"):
        return {"check": check, "update": update}[arguments[0]](arguments[1], pathlib.Path(arguments[2]))
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
