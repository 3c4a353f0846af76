#!/usr/bin/env python3
"""one_letter_macros.py SDK SPU_GCC SPU_GXX [OPTION...]: a program may have macros of one letter before it includes any header.

Compiles a program in C and in C++ in which every letter is such a macro and that includes every header of the folder SDK; then, with the
options, what a kernel includes when its sources are held against a real compiler's declarations."""

import os
import pathlib
import string
import subprocess
import sys
import tempfile

USES = """
vec_float4 sum(vec_float4 one, vec_float4 two) {
  vec_float4 both = spu_madd(spu_add(one, two), spu_splats(2.0f), spu_re(one)) + spu_mul(one, two) * 2.0f;
  both[1] += spu_extract(both, 2);
  return spu_sel(both, spu_shuffle(one, two, spu_splats((unsigned char)3)), spu_cmpgt(one, two));
}
vec_uint4 bits(vec_uint4 one) { return spu_rlqwbyte(spu_sl(spu_xor(one, spu_maskw(7)), 3), 1); }
vec_double2 wide(vec_double2 one) { return spu_add(spu_mul(one, one), spu_extend(spu_roundtf(one))); }
qword quad(qword one) { return si_a(si_ai(one, 3), si_shufb(one, one, one)); }
"""


def program(headers) -> str:
    macros = "".join(f"#define {letter} 1024\n" for letter in string.ascii_letters)
    includes = "".join(f"#include <{header}>\n" for header in headers)
    return macros + includes + USES + "int main(void) { return 0; }\n"


def failure_of(command) -> str:
    ran = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ, LC_ALL="C", SOFTCELL_QUIET="1"), timeout=100)
    return "" if ran.returncode == 0 and not ran.stderr else f"{' '.join(command)}\n{ran.stderr or ran.returncode}"


def main() -> int:
    sdk, spu_gcc, spu_gxx, *check = sys.argv[1:]
    library = pathlib.Path(sdk, "library/include")
    headers = ["spu_intrinsics.h", "spu_internals.h", "spu_mfcio.h", "sys/send_to_ppe.h"]
    failures = []
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        pathlib.Path("checked.cpp").write_text(program(["stddef.h", "stdint.h", *headers]))
        headers += sorted(str(path.relative_to(library)) for path in library.rglob("*") if path.is_file() and path.name not in ("ea.h", "cache-api.h"))
        in_c = [header for header in headers if header.endswith(".h")]
        pathlib.Path("program.c").write_text(program(in_c))
        pathlib.Path("program.cpp").write_text(program(headers))
        failures = [failure_of([spu_gcc, "program.c", "-o", "c.elf"]), failure_of([spu_gxx, "program.cpp", "-o", "cxx.elf"])]
        failures.append(failure_of([*check, "checked.cpp"]))
    print("\n".join(filter(None, failures)) or f"{len(headers)} headers, in C and C++")
    return 1 if any(failures) else 0


if __name__ == "__main__":
    sys.exit(main())
