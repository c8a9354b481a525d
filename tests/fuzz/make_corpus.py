#!/usr/bin/env python3
"""Writes the seed inputs of the harnesses: tests/fuzz/corpus/<harness>/<seed>."""
import base64
import json
import math
import pathlib
import struct

CORPUS = pathlib.Path(__file__).resolve().parent / "corpus"


def seed(harness, name, content):
    path = CORPUS / harness / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())


def obj_text(points, faces):
    lines = ["v %.9g %.9g %.9g" % tuple(p) for p in points]
    lines += ["f " + " ".join(str(i + 1) for i in f) for f in faces]
    return "\n".join(lines) + "\n"


def grid(columns, rows, height):
    """A patch of a surface over the plane; vertices row by row."""
    points = [(x, y, height(x / (columns - 1), y / (rows - 1))) for y in range(rows) for x in range(columns)]
    faces = []
    for y in range(rows - 1):
        for x in range(columns - 1):
            a = y * columns + x
            faces += [(a, a + 1, a + columns + 1), (a, a + columns + 1, a + columns)]
    return points, faces


def dome(s, t):
    return 2 * math.sin(math.pi * s) * math.sin(math.pi * t)


def shapes():
    tetrahedron = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    cube = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    cube_faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    fan = [(0, 0, 1)] + [(math.cos(i), math.sin(i), 0) for i in range(6)]
    cone = [(0, i, i % 6 + 1) for i in range(1, 7)]
    return {
        "triangle": ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]),
        "two_triangles": ([(0, 0, 0), (1, 0, 0), (1, 1, 0.5), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)]),
        "pyramid_open": (tetrahedron, [(1, 2, 3), (0, 3, 2), (0, 1, 3)]),
        "tetrahedron": (tetrahedron, [(0, 2, 1), (1, 2, 3), (0, 3, 2), (0, 1, 3)]),
        "cube": (cube, cube_faces),
        "cube_open": (cube, cube_faces[1:]),
        "cone": (fan, cone),
        "cone_open": (fan, cone[:-1]),
        "dome": grid(5, 4, dome),
        "saddle": grid(4, 4, lambda s, t: 3 * (s - 0.5) * (t - 0.5)),
        "concave_polygon": ([(0, 0, 0), (4, 0, 0), (4, 4, 0), (2, 1, 0), (0, 4, 0)], [(0, 1, 2, 3, 4)]),
        "moebius": ([(math.cos(2 * math.pi * i / 5) * (2 + w * math.cos(math.pi * i / 5)),
                      math.sin(2 * math.pi * i / 5) * (2 + w * math.cos(math.pi * i / 5)),
                      w * math.sin(math.pi * i / 5)) for i in range(5) for w in (-0.5, 0.5)],
                    [(0, 2, 3, 1), (2, 4, 5, 3), (4, 6, 7, 5), (6, 8, 9, 7), (8, 1, 0, 9)]),
    }


def obj_seeds():
    for name in ("triangle", "cube", "concave_polygon", "moebius"):
        seed("obj", name, obj_text(*shapes()[name]))
    seed("obj", "names", "mtllib a.mtl\no last\ng upper toe\nusemtl fine leather\nv 0 0 0\nv 1 0 0\n"
                         "v +1. 1e0 -.0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2//1 3/1\ng sole\nf -3 -2 -1\n")
    seed("obj", "layout", "\ufeff# comment\r\nv\t0 0 0 1\r\nv 1 0 \\\r\n0\r\nv 0 1 0 .5 .5 .5\r\n"
                          "l 1 2\r\np 1\r\ns off\r\nf 1 2 3")
    seed("obj", "wrong", "v 0 0 nan\nv 1 0\nf 0 1 9\nf 1\ncall other.obj\n")


def gltf_document(binary, uri=True, **changes):
    buffer = {"byteLength": len(binary)}
    if uri:
        buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "last", "translation": [0, 0, 1], "scale": [1, 1, -1]}],
        "meshes": [{"name": "upper", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [buffer],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}]}
    document.update(changes)
    return json.dumps(document, separators=(",", ":"))


def glb(text, binary):
    text = text.encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def gltf_seeds():
    square = struct.pack("<12f6H", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 2, 0, 2, 3)
    seed("gltf", "data_uri.gltf", gltf_document(square))
    seed("gltf", "binary.glb", glb(gltf_document(square, uri=False), square))
    strip = [{"attributes": {"POSITION": 0}, "mode": 5}, {"attributes": {"POSITION": 0}, "mode": 6},
             {"attributes": {"POSITION": 0}, "mode": 1, "material": 0}]
    seed("gltf", "unindexed_strip.glb", glb(gltf_document(
        square, uri=False, meshes=[{"primitives": strip}], materials=[{"name": "leather"}]), square))
    children = [{"children": [1, 2], "matrix": [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1]},
                {"mesh": 0, "rotation": [0, 0, 0.6, 0.8], "name": "a"}, {"mesh": 0, "translation": [5, 0, 0]}]
    seed("gltf", "nodes.glb", glb(gltf_document(square, uri=False, nodes=children), square))
    short = struct.pack("<12h4x6B", 0, 0, 0, 0, 32767, 0, 0, 0, 32767, 32767, 0, 0, 0, 1, 2, 0, 2, 3)
    seed("gltf", "quantized.glb", glb(gltf_document(
        short, uri=False, extensionsRequired=["KHR_mesh_quantization"],
        bufferViews=[{"buffer": 0, "byteLength": 28, "byteStride": 8}, {"buffer": 0, "byteOffset": 28, "byteLength": 6}],
        accessors=[{"bufferView": 0, "componentType": 5122, "normalized": True, "count": 3, "type": "VEC3"},
                   {"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"}]), short))
    sparse = {"count": 1, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}}
    seed("gltf", "sparse.glb", glb(gltf_document(square, uri=False, accessors=[
        {"componentType": 5126, "count": 4, "type": "VEC3", "sparse": sparse}]), square))
    mesh = [{"weights": [0.5], "primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3},
                                               "indices": 1, "targets": [{"POSITION": 0}]}]}]
    seed("gltf", "morph_and_skin.glb", glb(gltf_document(
        square + bytes(16) + b"\xff\0\0\0" * 4, uri=False, meshes=mesh,
        nodes=[{"mesh": 0, "skin": 0, "children": [1]}, {"scale": [2, 1, 1]}], skins=[{"joints": [1, 0]}],
        bufferViews=[{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12},
                     {"buffer": 0, "byteOffset": 60, "byteLength": 16}, {"buffer": 0, "byteOffset": 76, "byteLength": 16}],
        accessors=[{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                   {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
                   {"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC4"},
                   {"bufferView": 3, "componentType": 5121, "count": 4, "type": "VEC4", "normalized": True}]),
        square + bytes(16) + b"\xff\0\0\0" * 4))
    seed("gltf", "draco.gltf", gltf_document(square, extensionsRequired=["KHR_draco_mesh_compression"]))
    seed("gltf", "other_file.gltf", gltf_document(b"", buffers=[{"byteLength": 60, "uri": "last.bin"}]))
    seed("gltf", "solid.stl", "solid a\nfacet normal 0 0 1\n")


def request():
    return {
        "units": "mm", "surface": {"groups": ["upper"]}, "weld": {"tolerance_mm": 0.01},
        "points": {"toe_point": {"vertex": 80}, "vamp_point": {"position": [180.0, 3.0, 60.0]}},
        "curves": {"centre_front": {"vertices": [80, 240]}, "heel": {"polyline": [[0, 0, 0], [1, 0, 9]]},
                   "topline": {"from": "toe_point", "to": "vamp_point", "via": ["a"]},
                   "featherline": {"border_of": {"groups": ["upper", "sole"]}}},
        "cuts": ["centre_front", "heel"],
        "regions": {"lateral": {"contains": {"vertex": 5200}}, "interior": {}},
        "locks": [{"curve": "centre_front"}, {"curve": "heel", "keep": "edges"}, {"curve": "topline", "keep": "total"}],
        "method": {"name": "geodesic_fan", "angles": "averaged_conformal"},
        "layout": {"arrangement": "pair"}, "tag": "order-4711"}


def request_seeds():
    seed("request_json", "whole", json.dumps(request()))
    model = base64.b64encode(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").decode()
    seed("request_json", "submission", json.dumps({"model": {"data": model}, "request": request(),
                                                    "webhook": {"url": "http://x/", "secret": "whsec_" + 32 * "A"}}))
    seed("request_json", "map", json.dumps({"to_last": {"region": "a", "points": [[1, 2]], "polylines": [[[0, 0], [1, 1]]]},
                                             "to_pattern": {"points": [[1, 2, 3]]}}))
    seed("request_json", "mean_value", '{"method":{"name":"mean_value","border":"square"}}')
    seed("request_json", "twice", '{"units":"mm","units":"cm"}')
    seed("request_json", "numbers", '{"curves":{"a":{"vertices":[0,-1,2147483648,1.5,1e99]}}}')
    seed("request_json", "escapes", '{"tag":"\\u00e9\\ud83d\\ude00","curves":{"a/b~c":{"vertices":[0,1]}}}')
    seed("request_json", "deep", "[" * 14 + "]" * 14)
    seed("request_json", "empty", " ")


def http_seeds():
    job = "/v1/jobs/0123456789ABCDEFGHJKMNPQRS"
    heads = {
        "get": f"GET {job}/result?format=svg&a=%C3%A9+b HTTP/1.1\r\nHost: a:80\r\nAccept: */*\r\n\r\n",
        "post": "POST /v1/jobs HTTP/1.1\r\nHost: a\r\nContent-Type: model/obj\r\nContent-Length: 12\r\n"
                "Expect: 100-continue\r\n\r\nv 0 0 0",
        "chunked": "POST /v1/jobs HTTP/1.1\r\nHost: [::1]:8\r\nTransfer-Encoding: chunked\r\n\r\n",
        "options": "OPTIONS /v1/jobs HTTP/1.1\r\nHost: a\r\nOrigin: http://b\r\n\r\n",
        "head_1_0": "HEAD /healthz HTTP/1.0\r\n\r\n",
        "delete": f"DELETE {job} HTTP/1.1\r\nHost: a\r\nX: 1\r\nX: 2\r\n\r\n",
        "smuggled": "POST /v1/jobs HTTP/1.1\r\nHost: a\r\nContent-Length: 1\r\nTransfer-Encoding: chunked\r\n\r\n",
        "bare_lf": "GET /healthz HTTP/1.1\nHost: a\n\n"}
    for name, head in heads.items():
        seed("http_head", name, head)
    seed("http_head", "tls", b"\x16\x03\x01\x02\x00\x01")


def body_seeds():
    model = '--x\r\nContent-Disposition: form-data; name="model"; filename="a.obj"\r\nContent-Type: model/obj\r\n\r\nv 0 0 0\r\n'
    constraints = '--x\r\nContent-Disposition: form-data; name="request"\r\n\r\n{}\r\n'
    seed("multipart", "two_parts", "multipart/form-data; boundary=x\n" + model + constraints + "--x--\r\n")
    seed("multipart", "quoted", 'Multipart/Form-Data; charset=utf-8; boundary="x"\npreamble\r\n' + model + "--x--  \r\nepilogue")
    seed("multipart", "cut_off", "multipart/form-data; boundary=x\n" + model)
    seed("multipart", "extended_name", "multipart/form-data; boundary=x\n--x\r\nContent-Disposition: form-data; "
         "name=\"a\\\"b\"; filename*=UTF-8''%e2%82%ac.obj\r\n\r\n--xy\r\n\r\n--x--")
    seed("chunked", "two_chunks", "\x00" "4\r\nwiki\r\nA;a=b\r\n0123456789\r\n0\r\n\r\nGET")
    seed("chunked", "trailer", "\x03" "1\r\na\r\n0\r\nX: y\r\n\r\n")
    seed("chunked", "signs", "\x01" "+1\r\na\r\n-0\r\n\r\n")
    seed("chunked", "huge", "\x02" "ffffffffffffffff1\r\n")
    seed("chunked", "too_large", "\x05" "3e9\r\n")


def flatten_seeds():
    choices = {"isometric": 0x00, "fan": 0x06, "mean_value": 0x03, "square": 0x07, "locked": 0x20, "total": 0x28}
    for shape, choice in [("triangle", "isometric"), ("two_triangles", "locked"), ("pyramid_open", "isometric"),
                          ("tetrahedron", "locked"), ("cube_open", "isometric"), ("cube", "total"), ("cone", "fan"),
                          ("cone_open", "total"), ("dome", "isometric"), ("dome", "locked"), ("dome", "square"),
                          ("saddle", "mean_value"), ("saddle", "total")]:
        seed("flatten", f"{shape}_{choice}", bytes([choices[choice]]) + obj_text(*shapes()[shape]).encode())


def stl_and_ply_seeds():
    points, faces = shapes()["dome"]
    corners = [[points[i] for i in face] for face in faces]
    text = "solid dome\n" + "".join(
        "facet normal 0 0 1\nouter loop\n" + "".join("vertex %.9g %.9g %.9g\n" % tuple(p) for p in triangle) + "endloop\nendfacet\n"
        for triangle in corners) + "endsolid dome\n"
    body = b"".join(struct.pack("<12fH", 0, 0, 1, *sum(map(list, triangle), []), 0) for triangle in corners)
    seed("stl", "text", text)
    seed("stl", "two_solids", text + text.replace("dome", "second"))
    seed("stl", "binary", b"scan".ljust(80) + struct.pack("<I", len(corners)) + body)
    seed("stl", "binary_lies", b"solid".ljust(80) + struct.pack("<I", 0xFFFFFFFF) + body)
    seed("stl", "trailing_bytes", b"scan".ljust(80) + struct.pack("<I", len(corners) - 1) + body + b"end")
    seed("stl", "comments", "\r\n# scan\r\n" + text.replace("\n", "\r"))
    header = "ply\nformat %s 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty double z\nelement face %d\n" \
        "property list uchar int vertex_indices\nend_header\n"
    seed("ply", "text", header % ("ascii", len(points), len(faces)) + "".join("%g %g %g\n" % tuple(p) for p in points) +
         "".join("%d %s\n" % (len(f), " ".join(map(str, f))) for f in faces))
    seed("ply", "strips", (header % ("ascii", len(points), 1)).replace("element face", "element tristrips").replace("uchar", "int") +
         "".join("%g %g %g\n" % tuple(p) for p in points) + "11 0 5 1 6 2 -1 5 10 6 11 7\n")
    for name, order in (("little", "<"), ("big", ">")):
        seed("ply", name, (header % (f"binary_{name}_endian", len(points), len(faces))).encode() +
             b"".join(struct.pack(order + "ffd", *p) for p in points) +
             b"".join(struct.pack(order + "B%di" % len(f), len(f), *f) for f in faces))


if __name__ == "__main__":
    obj_seeds()
    stl_and_ply_seeds()
    gltf_seeds()
    request_seeds()
    http_seeds()
    body_seeds()
    flatten_seeds()
