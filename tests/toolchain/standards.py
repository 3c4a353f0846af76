#!/usr/bin/env python3
"""standards.py SDK SPU_GCC SPU_GXX: a program may be of any standard of C and C++, with GNU's words or without.

Compiles a program that includes every header of the folder SDK by each. Compilers of Cell SDKs took C for gnu89."""

import os
import pathlib
import subprocess
import sys
import tempfile

C = ["-ansi"] + ["-std=" + name for name in "c89 iso9899:199409 gnu89 c99 gnu99 c11 gnu11 c17 gnu17 c2x gnu2x".split()]
CXX = ["-ansi"] + ["-std=" + name for name in "c++98 gnu++98 c++11 gnu++11 c++14 gnu++14 c++17 gnu++17 c++20 gnu++20".split()]
USES = """
vec_float4 sum(vec_float4 one, vec_float4 two) {
  vec_float4 both = spu_madd(spu_add(one, two), spu_splats(2.0f), spu_re(one));
  both = spu_insert(spu_extract(both, 2), both, 1);
  return spu_sel(both, spu_shuffle(one, two, spu_splats((unsigned char)3)), spu_cmpgt(one, two));
}
vec_uchar16 bytes(vec_uint4 one) { return (vec_uchar16)spu_rlqwbyte(spu_sl(spu_xor(one, spu_maskw(7)), 3), 1); }
qword quad(qword one) { return si_a(si_ai(one, 3), si_shufb(one, one, one)); }
"""
GNU = "int same(int one) { typeof(one) two = one; return two; }\n"


def failure_of(command) -> str:
    ran = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ, LC_ALL="C", SOFTCELL_QUIET="1"), timeout=100)
    return "" if ran.returncode == 0 and not ran.stderr else f"{' '.join(command)}\n{ran.stderr or ran.returncode}"


def main() -> int:
    sdk, spu_gcc, spu_gxx = sys.argv[1:]
    library = pathlib.Path(sdk, "library/include")
    headers = ["spu_intrinsics.h", "spu_internals.h", "spu_mfcio.h", "sys/send_to_ppe.h"]
    headers += sorted(str(path.relative_to(library)) for path in library.rglob("*") if path.is_file() and path.name not in ("ea.h", "cache-api.h"))
    failures = []
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        for command, standards, suffix in ((spu_gcc, C, ".c"), (spu_gxx, CXX, ".cpp")):
            usable = [header for header in headers if suffix == ".cpp" or header.endswith(".h")]
            includes = "".join(f"#include <{header}>\n" for header in usable)
            pathlib.Path("strict" + suffix).write_text(includes + USES)
            pathlib.Path("gnu" + suffix).write_text(GNU)
            for standard in standards:
                failures.append(failure_of([command, standard, "-fsyntax-only", "strict" + suffix]))
            for standard in [[], *([name] for name in standards if "gnu" in name)]:
                failures.append(failure_of([command, *standard, "-fsyntax-only", "gnu" + suffix]))
    print("\n".join(filter(None, failures)) or f"{len(headers)} headers by {len(C)} standards of C and {len(CXX)} of C++")
    return 1 if any(failures) else 0


if __name__ == "__main__":
    sys.exit(main())
