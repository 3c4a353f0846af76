#!/usr/bin/env python3
"""check_installation_target.py BUILD: the target softcell_installation builds every file that `cmake --install` copies from this folder
of Ninja's, so that packages can be made of it where nothing else was built."""
import pathlib
import re
import subprocess
import sys

build = pathlib.Path(sys.argv[1]).resolve()


def ninja(*arguments):
    return subprocess.run(["ninja", "-C", build, "-t", *arguments], capture_output=True, text=True, check=True).stdout


built = set()
for line in ninja("targets", "all").splitlines():
    file, _, rule = line.rpartition(": ")
    if rule != "phony":
        built.add(str(build / file))
# A command names all files that it makes; some make more than the one that another command reads.
of_target = {str(build / word) for word in ninja("commands", "softcell_installation").split()}
installed = set()
for script in build.rglob("cmake_install.cmake"):
    if build / "tests" in script.parents:
        continue
    for files in re.findall(r"file\(INSTALL [^)]*? FILES([^)]*)\)", script.read_text()):
        installed.update(re.findall(r'"([^"]*)"', files))
missing = sorted((installed & built) - of_target)
for file in missing:
    print(f"{file} is installed, and softcell_installation does not build it: add its target to SOFTCELL_INSTALLED")
found = len(installed & built)
if found < 10:
    print(f"only {found} built files are installed according to cmake_install.cmake; more were expected")
sys.exit(1 if missing or found < 10 else 0)
