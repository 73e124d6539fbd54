"""Models of OBJ, PLY and STL with their descriptions: what each file is to look like."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from model_files import (
    CUBE,
    ELL,
    GREEN,
    QUADS,
    RED,
    SIDES,
    SQUARE,
    STAR,
    logo,
    obj,
    ply,
    png,
    prism,
    stl,
    triangles_of,
)
from model_reference import Face, light

XYZ = [("float", "x"), ("float", "y"), ("float", "z")]
RGB = [("uchar", "red"), ("uchar", "green"), ("uchar", "blue")]
LIST = [(("uchar", "int"), "vertex_indices")]
TRIANGLES = triangles_of(QUADS)


@dataclass(frozen=True)
class Case:
    """A file's name and bytes, other files beside it, what it shows, and words of its notes."""

    name: str
    data: bytes
    faces: list
    beside: dict = field(default_factory=dict)
    says: str = ""
    options: dict = field(default_factory=dict)


def bytes_of(colors):
    """Colours as whole numbers, and what those are as shown."""
    return np.round(255 * np.asarray(colors)).astype(int)


def polygons(points, faces, colors=None):
    """Faces of a description."""
    grey = (0.7, 0.7, 0.7)
    p = np.asarray(points, float)
    return [Face(p[list(f)], grey if colors is None else colors[i]) for i, f in enumerate(faces)]


def words(face, uv=None):
    """Face words that count from 1."""
    return [f"{v + 1}" if uv is None else f"{v + 1}/{uv[i] + 1}" for i, v in enumerate(face)]


def plain(points, faces, **options):
    """An OBJ file without colours."""
    return obj(points, [("", [words(f) for f in faces])], **options)


def mtl(colors, more=""):
    """Materials m0, m1, … of colours."""
    return "".join(
        f"newmtl m{i}\nKa 0 0 0\nKd {c[0]} {c[1]} {c[2]}\nillum 2\n{more}\n"
        for i, c in enumerate(colors)
    ).encode()


def textured(picture, uv=None, tint=(1, 1, 1), **options):
    """The cube with a picture on each side, v downwards."""
    uv = np.asarray(SQUARE if uv is None else uv, float)
    p = np.asarray(CUBE)
    return [Face(p[list(q)], picture=picture, uv=uv, tint=tint, **options) for q in QUADS]


def _obj_cases():
    sided = [(f"usemtl m{i}", [words(q)]) for i, q in enumerate(QUADS)]
    of_sides = polygons(CUBE, QUADS, SIDES)
    ell, ells = prism(ELL)
    star = [(x, y, 0.0) for x, y in STAR]
    yield Case("grey.obj", plain(CUBE, QUADS), polygons(CUBE, QUADS))
    yield Case("kd.obj", obj(CUBE, sided, "mtllib kd.mtl"), of_sides, {"kd.mtl": mtl(SIDES)})
    yield Case(
        "spaces.obj", obj(CUBE, sided, "mtllib my colours.mtl", ends="\r\n"), of_sides,
        {"my colours.mtl": mtl(SIDES).replace(b"\n", b"\r\n")},
    )  # fmt: skip
    yield Case(
        "two.obj", obj(CUBE, sided, "mtllib a.mtl b.mtl"), of_sides,
        {"a.mtl": mtl(SIDES[:3]), "b.mtl": mtl(SIDES)[mtl(SIDES).index(b"newmtl m3") :]},
    )  # fmt: skip
    yield Case("concave.obj", plain(ell, ells), polygons(ell, ells))
    turned = [ells[0][2:] + ells[0][:2], *ells[1:]]  # the fan's first corner is the hollow one
    yield Case("concave-turned.obj", plain(ell, turned), polygons(ell, ells))
    yield Case("star.obj", plain(star, [range(12)]), polygons(star, [range(12)]), says="open")
    back = [(0.0, 0.0, 0.0), (1, 0, 0), (0.2, 0.2, 0), (0, 1, 0)]  # an arrowhead of four corners
    yield Case("dart.obj", plain(back, [(0, 1, 2, 3)]), polygons(back, [range(4)]), says="open")
    lid = QUADS[:-1]
    yield Case("no-lid.obj", plain(CUBE, lid), polygons(CUBE, lid), says="open")
    mixed = [q if i % 2 else q[::-1] for i, q in enumerate(QUADS)]
    yield Case("mixed.obj", plain(CUBE, mixed), polygons(CUBE, QUADS), says="turned")
    mixed = [t if i % 3 else t[::-1] for i, t in enumerate(triangles_of(lid))]
    yield Case("mixed-open.obj", plain(CUBE, mixed), polygons(CUBE, lid), says="open")
    inside = [q[::-1] for q in QUADS]
    yield Case("inside-out.obj", plain(CUBE, inside), polygons(CUBE, QUADS), says="turned")
    two = [*CUBE, *[(x + 3, y, z) for x, y, z in CUBE]]
    other = [tuple(v + 8 for v in q[::-1]) for q in QUADS]
    yield Case("one-of-two.obj", plain(two, QUADS + other), polygons(two, QUADS + other))
    sheets = [QUADS[0], QUADS[0][::-1]]
    two_sided = [("usemtl m0", [words(sheets[0])]), ("usemtl m1", [words(sheets[1])])]
    yield Case(
        "two-sheets.obj", obj(CUBE, two_sided, "mtllib kd.mtl"),
        polygons(CUBE, QUADS[:1], [SIDES[0]]), {"kd.mtl": mtl([SIDES[0], SIDES[0]])},
    )  # fmt: skip
    negative = [[str(v - 8) for v in q] for q in QUADS]
    yield Case("negative.obj", obj(CUBE, [("", negative)]), polygons(CUBE, QUADS))
    broken = plain(CUBE, QUADS).replace(b"f 1 2 ", b"f 1 \\\n 2 ")
    yield Case("continued.obj", broken, polygons(CUBE, QUADS))
    far = np.asarray(CUBE) * 1e-6 + [1.0, 0.0, 0.0]
    text = b"".join(b"v %.17g %.17g %.17g\n" % tuple(p) for p in far)
    far_words = plain(CUBE, QUADS)
    text += far_words[far_words.index(b"f ") :]
    yield Case("tiny-and-far.obj", text, polygons(far, QUADS))
    corner = np.array([(x / 2, y, z / 1.5) for x, y, z in CUBE])
    rows = [[*p, *c] for p, c in zip(CUBE, corner, strict=True)]
    faces = [Face(np.asarray(CUBE)[list(t)], light(corner[list(t)])) for t in TRIANGLES]
    yield Case("vertices.obj", plain(rows, TRIANGLES), faces)
    rows = [[*p, *(255 * c)] for p, c in zip(CUBE, corner, strict=True)]
    yield Case("vertices-255.obj", plain(rows, TRIANGLES), faces)
    uv = np.asarray(SQUARE)
    up = np.column_stack([uv[:, 0], 1 - uv[:, 1]])
    on = [words(q, range(4)) for q in QUADS]
    head, use = "mtllib t.mtl", "usemtl m0"
    maps = mtl([(1, 1, 1)], "map_Kd logo.png")
    file = {"t.mtl": maps, "logo.png": png(logo())}
    large = {"t.mtl": maps, "logo.png": png(logo(64))}
    yield Case("logo-64.obj", obj(CUBE, [(use, on)], head, up), textured(logo(64)), large)
    yield Case("logo.obj", obj(CUBE, [(use, on)], head, up), textured(logo()), file)
    windows = {
        "T.MTL": maps.replace(b"logo.png", b"C:\\Users\\me\\LOGO.png"),
        "Logo.PNG": png(logo()),
    }
    yield Case("windows.obj", obj(CUBE, [(use, on)], head, up), textured(logo()), windows)
    moved = mtl([(1, 1, 1)], "map_Kd -s 2 1 1 -o 0.25 0 0 -bm 1 logo.png")
    there = np.column_stack([2 * up[:, 0] + 0.25, 1 - up[:, 1]])
    yield Case(
        "moved.obj", obj(CUBE, [(use, on)], head, up), textured(logo(), there),
        {"t.mtl": moved, "logo.png": png(logo())},
    )  # fmt: skip
    red = mtl([RED], "map_Kd logo.png")
    yield Case(
        "tinted.obj", obj(CUBE, [(use, on)], head, up), textured(logo(), tint=light(RED)),
        {"t.mtl": red, "logo.png": png(logo())},
    )  # fmt: skip
    glass = mtl(SIDES).replace(b"newmtl m2", b"d 1\nnewmtl m2\nd 0")
    yield Case(
        "clear.obj", obj(CUBE, sided, "mtllib kd.mtl"),
        [f for i, f in enumerate(of_sides) if i != 2], {"kd.mtl": glass}, says="alpha 0",
    )  # fmt: skip


def _ply_cases():
    faces = [[t] for t in TRIANGLES]
    corner = bytes_of([(x / 2, y, z / 1.5) for x, y, z in CUBE])
    smooth = [Face(np.asarray(CUBE)[list(t)], light(corner[list(t)] / 255)) for t in TRIANGLES]
    colored = [(*p, *(int(v) for v in c)) for p, c in zip(CUBE, corner, strict=True)]
    for form in ("ascii", "binary_little_endian", "binary_big_endian"):
        data = ply([("vertex", XYZ + RGB, colored), ("face", LIST, faces)], form)
        yield Case(f"{form}.ply", data, smooth)
    floats = [("float", n) for n in ("red", "green", "blue")]
    rows = [(*p, *(c / 255)) for p, c in zip(CUBE, corner, strict=True)]
    data = ply([("vertex", XYZ + floats, rows), ("face", LIST, faces)], "binary_little_endian")
    yield Case("floats.ply", data, smooth)
    shorts = [("ushort", n) for n in ("red", "green", "blue")]
    rows = [(*p, *(int(v) * 257 for v in c)) for p, c in zip(CUBE, corner, strict=True)]
    data = ply([("vertex", XYZ + shorts, rows), ("face", LIST, faces)], "binary_big_endian")
    yield Case("shorts.ply", data, smooth)
    ell, ells = prism(ELL)
    for form in ("ascii", "binary_little_endian"):
        data = ply([("vertex", XYZ, ell), ("face", LIST, [[f] for f in ells])], form)
        yield Case(f"concave-{form}.ply", data, polygons(ell, ells))
    first = [0, 1, 2, 3, -1, 4, 5, 6, 7]  # the sides x = 0 and x = 2, as strips
    strips = [("tristrips", [(("int", "int"), "vertex_indices")], [[first]])]
    sides = polygons(CUBE, [(0, 1, 3, 2), (4, 6, 7, 5)])
    yield Case("strips.ply", ply([("vertex", XYZ, CUBE), *strips], "binary_big_endian"), sides)
    rows = [[q, *(int(v) for v in bytes_of(SIDES[i]))] for i, q in enumerate(QUADS)]
    shown = polygons(CUBE, QUADS, bytes_of(SIDES) / 255)
    yield Case("faces.ply", ply([("vertex", XYZ, CUBE), ("face", LIST + RGB, rows)]), shown)
    up = [(u, 1 - v) for u, v in SQUARE]
    wedge = [*LIST, (("uchar", "float"), "texcoord"), ("int", "texnumber")]
    rows = [[q, [c for p in up for c in p], 0] for q in QUADS]
    data = ply([("vertex", XYZ, CUBE), ("face", wedge, rows)], comments=["TextureFile a b.png"])
    yield Case("wedges.ply", data, textured(logo()), {"a b.png": png(logo())})
    own = np.asarray(CUBE)[[v for q in QUADS for v in q]]
    rows = [(*p, *up[i % 4]) for i, p in enumerate(own)]
    quads = [[range(4 * i, 4 * i + 4)] for i in range(6)]
    data = ply(
        [("vertex", [*XYZ, ("float", "s"), ("float", "t")], rows), ("face", LIST, quads)],
        "binary_little_endian", ["TextureFile logo.jpg"],
    )  # fmt: skip
    flat = np.repeat(np.repeat(logo(8), 8, 0), 8, 1)  # blocks that JPEG keeps
    coded = png(flat, "JPEG", quality=100, subsampling=0)
    yield Case("st.ply", data, textured(flat), {"logo.jpg": coded})
    rows = [(*p, *c, 0 if p[0] == 0 else 255) for p, c in zip(CUBE, corner.tolist(), strict=True)]
    data = ply([("vertex", [*XYZ, *RGB, ("uchar", "alpha")], rows), ("face", LIST, faces)])
    there = [f for f, t in zip(smooth, TRIANGLES, strict=True) if max(t) > 3]
    yield Case("alpha.ply", data, there, says="alpha 0")


def _stl_cases():
    fives = [np.round(31 * np.asarray(c)).astype(int) for c in SIDES]
    shown = polygons(CUBE, QUADS, [c / 31 for c in fives])
    yield Case("binary.stl", stl(CUBE, TRIANGLES, head=b"solid one"), polygons(CUBE, QUADS))
    yield Case("up.stl", stl(CUBE, TRIANGLES), polygons(CUBE, QUADS), options={"up": "z"})
    codes = [1 << 15 | r << 10 | g << 5 | b for r, g, b in fives for _ in range(2)]
    yield Case("viscam.stl", stl(CUBE, TRIANGLES, codes), shown)
    codes = [b << 10 | g << 5 | r for r, g, b in fives for _ in range(2)]
    codes[2:4] = [1 << 15] * 2
    whole = bytes_of(GREEN)
    head = b"Made by hand COLOR=" + bytes(whole.tolist()) + b"\xff"
    shown = [*shown[:1], Face(shown[1].corners, whole / 255), *shown[2:]]
    yield Case("magics.stl", stl(CUBE, TRIANGLES, codes, head), shown)
    text = []
    for number, rows in enumerate((TRIANGLES[:6], TRIANGLES[6:])):
        text.append(f"solid part {number}")
        for t in rows:
            loop = "\n".join("vertex {:e} {:e} {:e}".format(*CUBE[v]) for v in t)
            text.append(f"facet normal 0 0 0\nouter loop\n{loop}\nendloop\nendfacet")
        text.append("endsolid")
    yield Case("text.stl", "\n".join(text).encode(), polygons(CUBE, QUADS))


CASES = [*_obj_cases(), *_ply_cases(), *_stl_cases()]
