#!/usr/bin/env python3
"""mistakes.py FOLDER SPU_GCC SPU_GXX: what the commands say of common mistakes.

Each source of the folder `mistakes` has one, in its third line. Its message names that line and what is wrong, and is no longer than that of a
real SPU compiler (GCC 9.2: characters of C and of C++, with the folder of the compiler's headers cut off)."""

import os
import shutil
import subprocess
import sys
import tempfile

MISTAKES = {  # what the message names; the real compiler's characters for C and C++
    "double_literal": ("spu_mul()", 220, 382),
    "integer_literal": ("spu_add()", 220, 383),
    "integers_multiplied": ("spu_madd()", 239, 459),
    "lane_for_vector": ("float", 272, 469),
    "mask_of_floats": ("spu_sel()", 223, 418),
    "missing_cast": ("float", 257, 277),
    "pattern_of_words": ("spu_shuffle()", 234, 441),
    "scalar_for_vector": ("spu_mul()", 215, 380),
    "too_few_arguments": ("mfc_get", 843, 765),
    "unknown_intrinsic": ("spu_divide", 512, 275),
    "vector_as_condition": ("", 352, 571),
    "wrong_type_in_sum": ("spu_add()", 224, 418),
}


def message_of(command: str, source: str, headers: str) -> str:
    environment = dict(os.environ, LC_ALL="C", SOFTCELL_QUIET="1")
    ran = subprocess.run([command, "-c", source, "-o", "out.o"], capture_output=True, text=True, env=environment, timeout=60)
    if ran.returncode == 0:
        return ""
    return ran.stderr.replace(headers, "")


def main() -> int:
    folder, spu_gcc, spu_gxx = sys.argv[1:4]
    headers = os.path.normpath(os.path.join(folder, "../../spu_kernels/sdk/host")) + "/"
    sources = {name[:-2] for name in os.listdir(os.path.join(folder, "mistakes"))}
    failures = [f"{name}: no such entry or source" for name in sources ^ set(MISTAKES)]
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        for name in sorted(sources & set(MISTAKES)):
            word, most_c, most_cxx = MISTAKES[name]
            for command, suffix, most in ((spu_gcc, ".c", most_c), (spu_gxx, ".cpp", most_cxx)):
                shutil.copy(os.path.join(folder, "mistakes", name + ".c"), name + suffix)
                said = message_of(command, name + suffix, headers)
                if f"{name}{suffix}:3:" not in said or word not in said:
                    failures.append(f"{name}{suffix}: line 3 and '{word}' are not named in:\n{said}")
                # Clang's messages are what they are.
                if "clang" not in said and "error generated" not in said and len(said) > most:
                    failures.append(f"{name}{suffix}: {len(said)} characters, those of a real compiler {most}:\n{said}")
    print("\n".join(failures) or f"{len(sources)} mistakes, in C and C++")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
