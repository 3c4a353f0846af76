#!/usr/bin/env python3
"""demos/scenes/beach_ball.py: writes beach_ball.glb beside itself, the model of the scene `painted`.

It is made to show what a model brings along: a ball with a texture, two metal caps, and a woven belt with a normal map,
which share one file. Numbers are quantized (KHR_mesh_quantization), so that the file stays small. Like models of many
programs it stands on the z axis, which glTF does not intend: the scene has up = "z"."""

import json
import math
import os
import struct
import zlib

COLUMNS = 30


def png(width, height, pixel):
    rows = b"".join(b"\0" + bytes(value for x in range(width) for value in pixel(x, y)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def surface(rows, columns, place):
    """A grid of (rows + 1) by (columns + 1) vertices: place(u, v) with u once around and v upwards."""
    vertices = [(place(c / columns, r / rows), (c / columns, 1 - r / rows)) for r in range(rows + 1) for c in range(columns + 1)]
    triangles = []
    for r in range(rows):
        for c in range(columns):
            a = r * (columns + 1) + c
            b = a + columns + 1
            triangles += [(a, a + 1, b + 1), (a, b + 1, b)]
    return vertices, triangles


def around(u):
    # The seam's two ends are the same point to the last bit.
    angle = 2 * math.pi * (u % 1)
    return math.cos(angle), math.sin(angle)


def ball(low, high, radius):
    """The part of a sphere about the z axis between two angles from its lower pole, in degrees."""
    def place(u, v):
        polar = math.radians(low + (high - low) * v)
        x, y = around(u)
        flat = 0.0 if polar in (0.0, math.pi) else math.sin(polar)
        return radius * flat * x, radius * flat * y, -radius * math.cos(polar)
    return place


def belt(u, v):
    x, y = around(u)
    angle = 2 * math.pi * (v % 1)
    outwards = 0.94 + 0.05 * -math.cos(angle)
    return outwards * x, outwards * y, -0.09 * math.sin(angle)


def panels(x, y):
    colours = [(226, 60, 50), (250, 245, 235), (40, 110, 190), (250, 245, 235), (245, 190, 40), (250, 245, 235)]
    column = 6 * x // 96
    edge = (6 * x) % 96 < 6
    if 22 <= y < 26 or 38 <= y < 42:
        return 30, 50, 90
    return (60, 60, 70) if edge else colours[column]


def weave(x, y):
    """A normal map: threads across and along, each a half cylinder."""
    over = (x // 8 + y // 8) % 2 == 0
    across = ((x % 8) - 3.5) / 4 if over else 0.0
    along = 0.0 if over else (3.5 - (y % 8)) / 4
    up = math.sqrt(1 - across * across - along * along)
    return tuple(round(127.5 + 127 * value) for value in (across, along, up))


class File:
    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def view(self, data):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data
        return len(self.views) - 1

    def accessor(self, data, count, kind, component, **more):
        self.accessors.append({"bufferView": self.view(data), "count": count, "type": kind, "componentType": component, **more})
        return len(self.accessors) - 1

    def primitive(self, grid, material, repeat=(1, 1)):
        vertices, triangles = grid
        positions = b"".join(struct.pack("<3hxx", *(round(32767 * c) for c in p)) for p, _ in vertices)
        position = self.accessor(positions, len(vertices), "VEC3", 5122, normalized=True)
        self.views[self.accessors[position]["bufferView"]]["byteStride"] = 8
        if repeat == (1, 1):
            texture = self.accessor(b"".join(struct.pack("<2H", round(65535 * u), round(65535 * v)) for _, (u, v) in vertices),
                                    len(vertices), "VEC2", 5123, normalized=True)
        else:
            texture = self.accessor(b"".join(struct.pack("<2B", round(u * repeat[0]), round(v * repeat[1])) + b"\0\0" for _, (u, v) in vertices),
                                    len(vertices), "VEC2", 5121)
            self.views[self.accessors[texture]["bufferView"]]["byteStride"] = 4
        used = [t for t in triangles if len({vertices[i][0] for i in t}) == 3]
        indices = self.accessor(b"".join(struct.pack("<3H", *t) for t in used), 3 * len(used), "SCALAR", 5123)
        return {"attributes": {"POSITION": position, "TEXCOORD_0": texture}, "indices": indices, "material": material}


def main():
    file = File()
    meshes = [
        {"name": "ball", "primitives": [file.primitive(surface(14, COLUMNS, ball(20, 160, 0.92)), 0)]},
        {"name": "caps", "primitives": [file.primitive(surface(3, COLUMNS, ball(0, 20, 0.92)), 1),
                                        file.primitive(surface(3, COLUMNS, ball(160, 180, 0.92)), 1)]},
        {"name": "belt", "primitives": [file.primitive(surface(8, COLUMNS, belt), 2, (COLUMNS, 8))]},
    ]
    images = [{"bufferView": file.view(png(96, 64, panels)), "mimeType": "image/png"},
              {"bufferView": file.view(png(16, 16, weave)), "mimeType": "image/png"}]
    document = {
        "asset": {"version": "2.0", "generator": "demos/scenes/beach_ball.py"},
        "extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"],
        "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "beach ball", "children": [1, 2, 3]}] + [{"name": m["name"], "mesh": i} for i, m in enumerate(meshes)],
        "meshes": meshes,
        "materials": [
            {"name": "panels", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 0.3}},
            {"name": "brass", "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.6, 0.2, 1], "metallicFactor": 1, "roughnessFactor": 0.3}},
            {"name": "webbing", "normalTexture": {"index": 1},
             "pbrMetallicRoughness": {"baseColorFactor": [0.05, 0.2, 0.12, 1], "metallicFactor": 0, "roughnessFactor": 0.8}},
        ],
        "textures": [{"source": 0}, {"source": 1}], "images": images,
        "accessors": file.accessors, "bufferViews": file.views, "buffers": [{"byteLength": len(file.bytes)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data = file.bytes + b"\0" * (-len(file.bytes) % 4)
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "beach_ball.glb"), "wb") as out:
        out.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text)
        out.write(struct.pack("<II", len(data), 0x004E4942) + data)


if __name__ == "__main__":
    main()
