#!/usr/bin/env python3
"""Draws a last as a shaded SVG picture, with its curves on it and, if given, its pattern beside it.

    draw_last.py last.obj --request request.json --view three-quarter --out last.svg
    draw_last.py last.obj --request request.json --pattern pattern.svg --out readme.svg

Only the standard library is needed. Axes of the model: x heel to toe, y medial, z up; millimetres.
Hidden surfaces are hidden by painting the far polygons first (painter's algorithm), which is exact
enough for a fine mesh of a solid.
"""

import argparse
import json
import math
import re
import sys
import xml.etree.ElementTree as ElementTree

# Where the eye stands, seen from the last, and which way is up in the picture.
VIEWS = {
    "side": ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),  # the lateral side
    "medial": ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    "top": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    "bottom": ((0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
    "front": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "back": ((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "three-quarter": ((0.55, -0.95, 0.62), (0.0, 0.0, 1.0)),
}
SOFT_COLOURS = [(222, 196, 160), (171, 190, 205), (196, 205, 176), (214, 182, 186), (190, 182, 210)]
GROUP_COLOURS = {"upper": SOFT_COLOURS[0], "sole": SOFT_COLOURS[1], "top": SOFT_COLOURS[2]}
CURVE_COLOURS = {
    "centre_front": "#b3372b",
    "heel": "#1f5f8b",
    "featherline": "#3a3a3a",
    "topline": "#2f7d4a",
}
OTHER_CURVE_COLOUR = "#7a3f8f"
MARGIN_MM = 10.0
GAP_MM = 25.0
SVG_NAMESPACE = "http://www.w3.org/2000/svg"
MM_PER_UNIT = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72.0, "pc": 25.4 / 6.0,
               "px": 25.4 / 96.0, "": 25.4 / 96.0}


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def unit(a):
    length = math.sqrt(dot(a, a))
    return (a[0] / length, a[1] / length, a[2] / length) if length > 0.0 else (0.0, 0.0, 0.0)


def read_obj(path):
    """Returns the vertices and, for every polygon, its group and its vertex ids (0-based)."""
    vertices, polygons, group = [], [], "default"
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                vertices.append(tuple(float(word) for word in words[1:4]))
            elif words[0] == "g":
                group = words[1] if len(words) > 1 else "default"
            elif words[0] == "f":
                ids = [int(word.split("/")[0]) for word in words[1:]]
                # A negative id counts back from the last vertex read so far.
                polygons.append((group, [i - 1 if i > 0 else len(vertices) + i for i in ids]))
    return vertices, polygons


def read_curves(path):
    """Returns the curves of a request that are vertex paths, by name."""
    with open(path, encoding="utf-8") as file:
        request = json.load(file)
    curves = request.get("curves", {})
    return {name: curve["vertices"] for name, curve in curves.items() if "vertices" in curve}


class Camera:
    """Parallel projection: picture x to the right, picture y down, depth towards the eye."""

    def __init__(self, view):
        towards_eye, up = VIEWS[view]
        self.eye = unit(towards_eye)
        self.right = unit(cross(up, self.eye))
        self.up = cross(self.eye, self.right)
        # The light comes from above the left shoulder of whoever looks.
        self.light = unit(tuple(
            self.eye[k] - 0.55 * self.right[k] + 0.75 * self.up[k] for k in range(3)))

    def project(self, point):
        return (dot(point, self.right), -dot(point, self.up), dot(point, self.eye))


def vertex_normals(vertices, polygons):
    """Area-weighted normals, one per group and vertex, so that the feather edge stays sharp."""
    normals = {}
    for group, ids in polygons:
        a, b, c = vertices[ids[0]], vertices[ids[1]], vertices[ids[2]]
        normal = cross(minus(b, a), minus(c, a))
        for vertex in ids:
            old = normals.get((group, vertex), (0.0, 0.0, 0.0))
            normals[group, vertex] = (old[0] + normal[0], old[1] + normal[1], old[2] + normal[2])
    return {key: unit(normal) for key, normal in normals.items()}


def shade(colour, normal, camera):
    """Soft light: half of it ambient, a broad diffuse term and a faint gloss as of varnish."""
    diffuse = max(0.0, 0.5 + 0.5 * dot(normal, camera.light))
    halfway = unit(tuple(camera.light[k] + camera.eye[k] for k in range(3)))
    gloss = max(0.0, dot(normal, halfway)) ** 40
    strength = 0.38 + 0.70 * diffuse * diffuse
    return "#%02x%02x%02x" % tuple(
        min(255, max(0, round(channel * strength + 24.0 * gloss))) for channel in colour)


def group_colours(polygons):
    """The known groups keep their colour; others take the soft colours in order of appearance."""
    colours, spare = dict(GROUP_COLOURS), 0
    for group, _ in polygons:
        if group not in colours:
            colours[group] = SOFT_COLOURS[spare % len(SOFT_COLOURS)]
            spare += 1
    return colours


def mean(values):
    return sum(values) / len(values)


def halfway(a, b):
    return tuple(0.5 * (a[k] + b[k]) for k in range(3))


def facets(corners, normals, depth=2):
    """Splits a polygon into triangles, and these into four each where the surface curves so much
    that one shade would show as a facet. Gives (corners, normal) of every piece."""
    if len(corners) > 3:
        for k in range(1, len(corners) - 1):
            yield from facets([corners[0], *corners[k:k + 2]], [normals[0], *normals[k:k + 2]],
                              depth)
        return
    flattest = min(dot(normals[k], normals[(k + 1) % 3]) for k in range(3))
    if depth == 0 or flattest > math.cos(math.radians(7.0)):
        yield corners, unit(tuple(sum(normal[k] for normal in normals) for k in range(3)))
        return
    (a, b, c), (p, q, r) = corners, normals
    ab, bc, ca = halfway(a, b), halfway(b, c), halfway(c, a)
    pq, qr, rp = unit(halfway(p, q)), unit(halfway(q, r)), unit(halfway(r, p))
    for part, part_normals in (((a, ab, ca), (p, pq, rp)), ((ab, b, bc), (pq, q, qr)),
                               ((ca, bc, c), (rp, qr, r)), ((ab, bc, ca), (pq, qr, rp))):
        yield from facets(part, part_normals, depth - 1)


def painted_polygons(vertices, polygons, camera):
    """Every polygon that faces the eye, as (depth, SVG element, picture points)."""
    colours = group_colours(polygons)
    normals = vertex_normals(vertices, polygons)
    painted = []
    for group, ids in polygons:
        a, b, c = (vertices[i] for i in ids[:3])
        if dot(cross(minus(b, a), minus(c, a)), camera.eye) <= 0.0:
            continue  # it faces away, and a solid hides its own far side
        for corners, normal in facets([vertices[i] for i in ids],
                                      [normals[group, i] for i in ids]):
            colour = shade(colours[group], normal, camera)
            places = [camera.project(corner) for corner in corners]
            outline = " ".join("%.2f,%.2f" % (x, y) for x, y, _ in places)
            element = '<polygon points="%s" color="%s"/>' % (outline, colour)
            painted.append((mean([z for _, _, z in places]), element, places))
    return painted


def painted_curves(vertices, curves, camera, lift_mm=4.0):
    """Every edge of every curve, lifted a little towards the eye so that it lies on the surface."""
    painted = []
    for name, path in curves.items():
        colour = CURVE_COLOURS.get(name, OTHER_CURVE_COLOUR)
        for first, second in zip(path, path[1:]):
            a, b = camera.project(vertices[first]), camera.project(vertices[second])
            element = ('<line x1="%.2f" y1="%.2f" x2="%.2f" y2="%.2f" stroke="%s" '
                       'stroke-width="0.9" stroke-linecap="round"/>' % (a[0], a[1], b[0], b[1],
                                                                        colour))
            painted.append((0.5 * (a[2] + b[2]) + lift_mm, element, [a, b]))
    return painted


def draw_model(vertices, polygons, curves, camera):
    """Returns the SVG elements from far to near, and the box they fill: x, y, width, height."""
    painted = painted_polygons(vertices, polygons, camera) + painted_curves(vertices, curves, camera)
    painted.sort(key=lambda item: item[0])
    xs = [x for _, _, corners in painted for x, _, _ in corners]
    ys = [y for _, _, corners in painted for _, y, _ in corners]
    box = (min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys))
    return [element for _, element, _ in painted], box


def length_in_mm(text):
    match = re.fullmatch(r"\s*([0-9.eE+-]+)\s*([a-z]*)\s*", text)
    if not match or match.group(2) not in MM_PER_UNIT:
        raise ValueError("not a length: %r" % text)
    return float(match.group(1)) * MM_PER_UNIT[match.group(2)]


def read_pattern(path):
    """Returns the pattern as an <svg> element, and its true width and height in mm."""
    ElementTree.register_namespace("", SVG_NAMESPACE)
    root = ElementTree.parse(path).getroot()
    if root.tag != "{%s}svg" % SVG_NAMESPACE:
        raise ValueError("%s is not an SVG drawing" % path)
    view_box = [float(word) for word in root.get("viewBox", "").replace(",", " ").split()]
    sizes = [root.get("width"), root.get("height")]
    if all(size and not size.endswith("%") for size in sizes):
        width, height = (length_in_mm(size) for size in sizes)
    elif len(view_box) == 4:
        width, height = view_box[2], view_box[3]  # no stated size: one unit is one mm
    else:
        raise ValueError("%s has neither a size nor a viewBox" % path)
    if len(view_box) != 4:  # without one, user units are CSS pixels
        root.set("viewBox", "0 0 %g %g" % (width * 96.0 / 25.4, height * 96.0 / 25.4))
    return root, width, height


def place_pattern(pattern, x, y):
    root, width, height = pattern
    for name, value in (("x", x), ("y", y), ("width", width), ("height", height)):
        root.set(name, "%.2f" % value)
    return ElementTree.tostring(root, encoding="unicode")


def compose(model, pattern):
    """One drawing in true millimetres: the last at the left, the pattern at its right."""
    elements, (left, top, model_width, model_height) = model
    width, height = model_width, model_height
    if pattern:
        width += GAP_MM + pattern[1]
        height = max(height, pattern[2])
    page = (width + 2 * MARGIN_MM, height + 2 * MARGIN_MM)
    lines = [
        '<svg xmlns="%s" width="%.2fmm" height="%.2fmm" viewBox="0 0 %.2f %.2f">'
        % (SVG_NAMESPACE, page[0], page[1], page[0], page[1]),
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        # A thin stroke in the polygon's own colour closes the hairlines between neighbours.
        '<g transform="translate(%.2f %.2f)" fill="currentColor" stroke="currentColor" '
        'stroke-width="0.25" stroke-linejoin="round">'
        % (MARGIN_MM - left, MARGIN_MM - top + 0.5 * (height - model_height)),
        *elements,
        "</g>",
    ]
    if pattern:
        lines.append(place_pattern(pattern, MARGIN_MM + model_width + GAP_MM,
                                   MARGIN_MM + 0.5 * (height - pattern[2])))
    lines.append("</svg>")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", help="the last, OBJ, in mm")
    parser.add_argument("--request", help="request JSON whose vertex-path curves are drawn")
    parser.add_argument("--view", choices=sorted(VIEWS), default="three-quarter")
    parser.add_argument("--pattern", help="pattern SVG to put at the right, in its true size")
    parser.add_argument("--out", required=True, help="the SVG to write")
    arguments = parser.parse_args()
    try:
        vertices, polygons = read_obj(arguments.model)
        curves = read_curves(arguments.request) if arguments.request else {}
        pattern = read_pattern(arguments.pattern) if arguments.pattern else None
        model = draw_model(vertices, polygons, curves, Camera(arguments.view))
        drawing = compose(model, pattern)
        with open(arguments.out, "w", encoding="utf-8") as file:
            file.write(drawing)
    except (OSError, ValueError, IndexError, ElementTree.ParseError) as error:
        print("draw_last: %s" % error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
