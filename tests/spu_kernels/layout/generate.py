#!/usr/bin/env python3
"""Writes structures.h: 200 structures and how a real SPU compiler lays them out.

    generate.py <an SPU gcc> > structures.h

The structures come from a fixed seed. The compiler is asked once, by a table of sizeof, alignment and offsetof that it
compiles to assembly; structures.h keeps its answers as static assertions, which the compilers of kernels must agree with.
"""
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

COUNT = 200
SCALARS = [
    "char", "signed char", "unsigned char", "short", "unsigned short", "int", "unsigned int", "long", "unsigned long",
    "long long", "unsigned long long", "float", "double", "long double", "SIZE", "PTRDIFF", "WCHAR", "void*", "const char*",
    "enum layout_choice", "int8_t", "uint8_t", "int16_t", "uint16_t", "int32_t", "uint32_t", "int64_t", "uint64_t", "uintptr_t",
]
VECTORS = [
    "vec_uchar16", "vec_char16", "vec_ushort8", "vec_short8", "vec_uint4", "vec_int4", "vec_ullong2", "vec_llong2",
    "vec_float4", "vec_double2", "qword",
]
BIT_FIELDS = [("unsigned int", 32), ("int", 32), ("unsigned short", 16), ("unsigned char", 8), ("unsigned long long", 64)]
NAMES = {"SIZE": "__SIZE_TYPE__", "PTRDIFF": "__PTRDIFF_TYPE__", "WCHAR": "__WCHAR_TYPE__"}


def member(rng, index, number):
    """A declaration, and the member's name; None as the name of one whose offset cannot be asked for."""
    name = f"m{index}"
    kind = rng.random()
    if kind < 0.50:
        declaration = f"{rng.choice(SCALARS)} {name}"
    elif kind < 0.62:
        declaration = f"{rng.choice(VECTORS)} {name}"
    elif kind < 0.74:
        declaration = f"{rng.choice(SCALARS + VECTORS)} {name}[{rng.randint(1, 5)}]"
    elif kind < 0.78:
        declaration = f"int (*{name})(void*, long)"
    elif kind < 0.86:
        base, width = rng.choice(BIT_FIELDS)
        return f"{base} {name} : {rng.randint(1, width)}", None
    elif kind < 0.93 and number > 0:
        declaration = f"struct layout_{rng.randrange(number)} {name}"
    else:
        inner = f"{rng.choice(SCALARS)} a; {rng.choice(SCALARS)} b[{rng.randint(1, 3)}];"
        declaration = f"{rng.choice(['union', 'struct'])} {{ {inner} }} {name}"
    if rng.random() < 0.05:
        declaration += f" __attribute__((aligned({rng.choice([2, 4, 8, 16, 32, 128])})))"
    return declaration, name


def structures():
    rng = random.Random(17)
    for number in range(COUNT):
        count = rng.randint(1, 8)
        # Packed ones hold scalars only: the vectors of C++ kernels are classes, which GCC does not pack.
        packed = rng.random() < 0.06
        members = [(f"{rng.choice(SCALARS)} m{i}", f"m{i}") if packed else member(rng, i, number) for i in range(count)]
        text = " ".join(f"{declaration};" for declaration, _ in members)
        text = re.sub("|".join(NAMES), lambda m: NAMES[m.group()], text)
        aligned = not packed and rng.random() < 0.05
        attributes = " __attribute__((packed))" if packed else " __attribute__((aligned(128)))" if aligned else ""
        yield f"struct layout_{number} {{ {text} }}{attributes};", [name for _, name in members if name]


def ask(compiler, definitions, questions):
    source = "#include <stdint.h>\n#include <spu_intrinsics.h>\n"
    source += "enum layout_choice { layout_first, layout_last = 1000 };\n" + "\n".join(definitions)
    source += "\nconst unsigned int answers[] = {" + ",\n".join(questions) + "};\n"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "layout.c"
        path.write_text(source.replace("qword ", "__vector signed char "))
        assembly = subprocess.run([compiler, "-ffreestanding", "-w", "-S", "-o", "-", path],
                                  check=True, capture_output=True, text=True).stdout
    table = assembly[assembly.index("answers:"):]
    answers = [int(word) for word in re.findall(r"\.(?:long|word|int)\s+(\d+)", table)]
    if len(answers) != len(questions):
        sys.exit(f"{compiler} gave {len(answers)} answers to {len(questions)} questions")
    return answers


def main():
    definitions, questions, texts = [], [], []
    for number, (definition, names) in enumerate(structures()):
        kind = f"struct layout_{number}"
        definitions.append(definition)
        questions += [f"sizeof({kind})", f"__alignof__({kind})"] + [f"__builtin_offsetof({kind}, {n})" for n in names]
        texts.append((definition, kind, names))
    answers = iter(ask(sys.argv[1], definitions, questions))
    print("// Made by generate.py: structures, and their layout by a real SPU compiler (GCC 9.2).")
    print("// clang-format off")
    print("enum layout_choice { layout_first, layout_last = 1000 };")
    for definition, kind, names in texts:
        print(definition)
        print(f"SC_LAYOUT({kind}, {next(answers)}, {next(answers)})")
        for name in names:
            print(f"SC_OFFSET({kind}, {name}, {next(answers)})")


main()
