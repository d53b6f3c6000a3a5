"""What other programs read in our files is the ribbon, as accurately as the format can say it."""

import itertools
import json
import struct
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ribbonopt.arrays import Array
from ribbonopt.exports.colours import Colours
from ribbonopt.exports.formats import FORMATS
from ribbonopt.exports.writing import export
from ribbonopt.solution.solution import Solution
from ribbonopt.views.shape import shape_of

try:  # the test extra has both; they need wheels of VTK, and its libraries
    import pyvista
    import trimesh
except ImportError as error:
    pytest.skip(f"nothing reads our files back: {error}", allow_module_level=True)

Solved = Callable[..., Solution]
HALF_WIDTH, ACROSS = 0.03, 2
SINGLE = 2.0**-24  # of the size of a number: rounding to single precision
KINDS = {5126: np.dtype("<f4"), 5125: np.dtype("<u4")}
UP = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])  # x, z, -y: z of the lab is y of glTF


@pytest.fixture(scope="module")
def helix(solved: Solved, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A helix in all formats, as `helix.*`."""
    folder = tmp_path_factory.mktemp("exports")
    export(
        solved("helix"),
        folder,
        list(FORMATS),
        half_width=HALF_WIDTH,
        across=ACROSS,
        rows=61,
        color="m3",
    )
    return folder


def expected(solution: Solution, s: Array, v: Array) -> Array:
    """Return r + v (d2 + u3/u2 d3) at arclengths (k,) and distances (c,): (k c, 3)."""
    o = solution.outputs(s)
    b = o["d2"] + (o["u3"] / o["u2"])[:, None] * o["d3"]
    return (o["r"][:, None] + v[:, None] * b[:, None]).reshape(-1, 3)


def truth(solved: Solved, helix: Path) -> Array:
    """Return what the points of the helix are, by its arclengths in the VTP."""
    s = np.asarray(pyvista.read(helix / "helix.vtp")["s"])[:: ACROSS + 1]
    return expected(solved("helix"), s, np.linspace(-HALF_WIDTH, HALF_WIDTH, ACROSS + 1))


def test_vtp_of_the_surface(solved: Solved, helix: Path) -> None:
    found, solution = pyvista.read(helix / "helix.vtp"), solved("helix")
    assert found.points.dtype == np.float64
    np.testing.assert_allclose(found.points, truth(solved, helix), atol=1e-12)
    told = solution.outputs(np.asarray(found["s"]))
    for name in ("u1", "u2", "u3", "eta", "n", "m", "d1", "d2", "d3", "energy"):
        np.testing.assert_allclose(found[name], told[name], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(found["normal"], told["d1"], atol=1e-12)
    assert found.point_data.active_normals_name == "normal"
    assert not found["mirrored"].any()
    faces = found.regular_faces
    a, b, c, _ = (found.points[faces[:, i]] for i in range(4))
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - b), told["d1"][faces[:, 0]]) > 0).all()
    assert found.field_data["units"][0] == "Dw = L = 1"
    assert found.field_data["ribbon"][0] == "helix"


def test_vtp_of_the_line(solved: Solved, helix: Path) -> None:
    found, solution = pyvista.read(helix / "helix-line.vtp"), solved("helix")
    assert (found.n_lines, found.n_cells) == (1, 1)
    np.testing.assert_array_equal(found.lines, [found.n_points, *range(found.n_points)])
    told = solution.outputs(np.asarray(found["s"]))
    for name in ("d1", "d2", "d3", "n", "m", "u2", "u3"):
        np.testing.assert_allclose(found[name], told[name], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(found.points, told["r"], atol=1e-12)
    steps = np.linalg.norm(np.diff(found.points, axis=0), axis=1)
    assert steps.sum() == pytest.approx(1, rel=1e-3)


@pytest.mark.parametrize("ending", ["obj", "ply", "stl"])
def test_meshes(solved: Solved, helix: Path, ending: str) -> None:
    found = trimesh.load(helix / f"helix.{ending}", process=False)
    points = truth(solved, helix)
    single = ending == "stl"
    if single:  # which has corners of triangles only
        corners = np.array([np.abs(points - x).sum(axis=1).argmin() for x in found.vertices])
        points = points[corners]
        found.merge_vertices()
        assert len(found.vertices) == len(np.unique(corners))
        points = points[[np.abs(points - x).sum(axis=1).argmin() for x in found.vertices]]
    np.testing.assert_allclose(found.vertices, points, atol=SINGLE if single else 1e-12)
    assert found.is_winding_consistent and found.euler_number == 1
    # By r' = d3 and b' = 0 the surface of a helix is flat: 2 w L.
    assert found.area == pytest.approx(2 * HALF_WIDTH, rel=2e-3)


def test_normals_of_stl_are_those_of_its_triangles(helix: Path) -> None:
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    data = (helix / "helix.stl").read_bytes()
    assert not data.startswith(b"solid") and len(data) == 84 + 50 * int.from_bytes(
        data[80:84], "little"
    )
    found = np.frombuffer(data, kind, offset=84)
    a, b, c = (found["corners"][:, i].astype(float) for i in range(3))
    faces = np.cross(b - a, c - a)
    faces /= np.linalg.norm(faces, axis=1, keepdims=True)
    np.testing.assert_allclose(found["normal"], faces, atol=1e-3)


def test_vtp_is_xml_and_its_data_are_marked(helix: Path) -> None:
    root = ET.parse(helix / "helix.vtp").getroot()
    (data,) = root.findall("AppendedData")
    assert data.get("encoding") == "base64" and (data.text or "").lstrip().startswith("_")


def test_ribbons_of_no_known_width_are_as_wide_as_each_other(
    solved: Solved, tmp_path: Path
) -> None:
    several = solved("helix"), solved("moebius_half")  # of lengths 1 and 1/2
    alone = [shape_of(solution, complete=False).half_width for solution in several]
    assert alone[0] > 1.5 * alone[1]
    paths = export(several, tmp_path, ["npz"], complete=False)
    widths = [float(np.load(path)["half_width"].max()) for path in paths]
    assert widths == pytest.approx([min(alone)] * 2)
    # Colours mean the same on both.
    scenes = [glb(path)[0] for path in export(several, tmp_path, ["glb"], complete=False)]
    told = [scene["scenes"][0]["extras"]["color_largest"] for scene in scenes]
    largest = [float(np.abs(np.load(path)["u2"]).max()) for path in paths]
    assert told == [max(largest)] * 2 and largest[0] != largest[1]
    # One that is known stays what it is.
    paths = export((*several, solved("ribbon_si")), tmp_path, ["npz"], complete=False)
    assert np.load(paths[2])["half_width"][0] == pytest.approx(0.005)


def test_fields_of_ply(solved: Solved, helix: Path) -> None:
    found = trimesh.load(helix / "helix.ply", process=False)
    data = found.metadata["_ply_raw"]["vertex"]["data"]
    told = solved("helix").outputs(np.asarray(data["arclength"], float))
    for name in ("u2", "u3", "eta", "energy"):
        np.testing.assert_allclose(data[name], told[name], rtol=1e-4)
    for i, axis in enumerate("xyz"):
        np.testing.assert_allclose(data[f"force_{axis}"], told["n"][:, i], atol=1e-3)
        np.testing.assert_allclose(data[f"d3_{axis}"], told["d3"][:, i], atol=1e-5)
        np.testing.assert_allclose(data[f"n{axis}"], told["d1"][:, i], atol=1e-5)


def glb(path: Path) -> tuple[dict[str, Any], bytes]:
    """Return both chunks of a GLB, as its standard lays them out."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON" and size % 4 == 0
    more, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0" and more % 4 == 0 and 28 + size + more == length
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def arrays_of(scene: dict[str, Any], binary: bytes) -> list[Array]:
    """Return all arrays of a glTF, each where its view says."""
    found = []
    for accessor in scene["accessors"]:
        view = scene["bufferViews"][accessor["bufferView"]]
        kind, parts = KINDS[accessor["componentType"]], {"VEC3": 3, "SCALAR": 1}[accessor["type"]]
        assert view["byteOffset"] % 4 == 0
        assert view["byteLength"] == accessor["count"] * parts * kind.itemsize
        flat = np.frombuffer(binary, kind, accessor["count"] * parts, view["byteOffset"])
        found.append(flat.reshape(-1, parts).astype(float))
    return found


def test_glb_keeps_its_standard(solved: Solved, helix: Path) -> None:
    scene, binary = glb(helix / "helix.glb")
    assert scene["buffers"] == [{"byteLength": len(binary)}]
    arrays = arrays_of(scene, binary)
    (surface,), (line,) = (mesh["primitives"] for mesh in scene["meshes"])
    use = surface["attributes"]
    points = arrays[use["POSITION"]]
    for primitive in (surface, line):
        at = primitive["attributes"]["POSITION"]
        assert scene["accessors"][at]["min"] == arrays[at].min(axis=0).tolist()
        assert scene["accessors"][at]["max"] == arrays[at].max(axis=0).tolist()
    np.testing.assert_allclose(points, truth(solved, helix), atol=SINGLE)
    normals, colours = arrays[use["NORMAL"]], arrays[use["COLOR_0"]]
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
    assert 0 <= colours.min() and colours.max() <= 1
    corners = arrays[surface["indices"]].astype(int).reshape(-1, 3)
    assert corners.min() == 0 and corners.max() == len(points) - 1
    a, b, c = (points[corners[:, i]] for i in range(3))
    faces = np.cross(b - a, c - a)
    assert (np.einsum("ij,ij->i", faces, normals[corners[:, 0]]) > 0).all()
    assert scene["materials"][surface["material"]]["doubleSided"]
    assert scene["scenes"][0]["extras"]["color"] == "m3"
    np.testing.assert_allclose(arrays[line["attributes"]["POSITION"]], points[1::3], atol=SINGLE)


def test_glb_stands_upright(solved: Solved, helix: Path) -> None:
    found = trimesh.load(helix / "helix.glb", process=False)
    (name,) = found.graph.nodes_geometry  # the line is none of faces
    turn, shown = found.graph.get(name)
    np.testing.assert_allclose(turn[:3, :3], UP, atol=1e-12)
    assert turn[:3, 3].tolist() == [0, 0, 0]
    surface = found.geometry[shown]
    np.testing.assert_allclose(surface.vertices, truth(solved, helix), atol=SINGLE)
    assert surface.is_winding_consistent


def test_a_band_with_one_side_is_whole(solved: Solved, tmp_path: Path) -> None:
    path = tmp_path / "band.stl"
    assert export(solved("moebius_half"), path) == [path]
    found = trimesh.load(path, process=False)
    found.merge_vertices(digits_vertex=6)  # joins the seam as well
    assert (found.euler_number, found.is_winding_consistent) == (0, False)
    export(solved("moebius_half"), path.with_suffix(".obj"))
    found = trimesh.load(path.with_suffix(".obj"), process=False)
    assert (found.euler_number, found.is_winding_consistent) == (1, True)


def test_rows_that_follow_by_symmetry_go_on_as_equilibrium(solved: Solved, tmp_path: Path) -> None:
    """All along the line r' = d3, n' = 0 and m' = n x d3, also behind what was solved."""
    export(solved("moebius_half"), tmp_path / "band.vtp")
    line = pyvista.read(tmp_path / "band-line.vtp")
    s, mirrored = np.asarray(line["s"]), np.asarray(line["mirrored"]) > 0
    assert mirrored.sum() == (~mirrored).sum()
    assert s[-1] == pytest.approx(1, abs=1e-8)
    np.testing.assert_allclose(line["n"], line["n"][:1].repeat(len(s), 0), atol=1e-7)
    apart = np.diff(s)[:, None]
    r, d3, m, n = (np.asarray(a) for a in (line.points, line["d3"], line["m"], line["n"]))
    middle = (d3[1:] + d3[:-1]) / 2
    np.testing.assert_allclose(np.diff(r, axis=0), apart * middle, atol=2e-6)
    np.testing.assert_allclose(np.diff(m, axis=0), apart * np.cross(n[1:], middle), atol=100 * 2e-6)


@pytest.mark.parametrize("name", ["O'Brien & Söhne", "]]>", "lab\u202eel"])
def test_a_name_is_text_and_no_markup(solved: Solved, tmp_path: Path, name: str) -> None:
    solution = solved("helix")
    shape = replace(shape_of(solution), name=name)
    from ribbonopt.exports.carried import Carried

    title = f'{name}</DataArray>\nv 0 0 0\nend_header\n"'
    carried = Carried(shape, solution, title, Colours("u2", 1.0))
    for kind in ("vtp", "obj", "ply"):
        for ending, content in FORMATS[kind].write(carried).items():
            (tmp_path / f"odd{ending}").write_bytes(content)
    assert pyvista.read(tmp_path / "odd.vtp").field_data["ribbon"][0] == title
    points = len(carried.mesh.points)
    assert len(trimesh.load(tmp_path / "odd.obj", process=False).vertices) == points
    assert len(trimesh.load(tmp_path / "odd.ply", process=False).vertices) == points


def test_values_that_jump_have_both_sides_on_the_line(solved: Solved, tmp_path: Path) -> None:
    """At a support between the ends n jumps by what the support carries."""
    solution = solved("three_supports")
    export(solution, tmp_path / "beam.vtp")
    line = pyvista.read(tmp_path / "beam-line.vtp")
    i = int(np.argmin(np.diff(np.asarray(line["s"]))))
    (place,) = [p for p in _reactions(solution) if p.path.startswith("supports")]
    assert line["s"][i] == pytest.approx(place.at, abs=1e-8)
    np.testing.assert_allclose(line["n"][i] - line["n"][i + 1], place.force, atol=1e-6)


def _reactions(solution: Solution) -> Any:
    from ribbonopt.solution.acting import reactions

    return reactions(solution)


def test_colours_are_pale_at_zero_and_tell_signs_apart(solved: Solved) -> None:
    shape = shape_of(solved("moebius_half"))
    colours = Colours("u2", float(np.abs(shape.u2).max())).of(shape)
    red, blue = colours[:, 0], colours[:, 2]
    assert (red > blue)[shape.u2 > 1].all() and (red < blue)[shape.u2 < -1].all()
    least = np.abs(shape.u2).argsort()
    assert colours[least[0]].sum() > colours[least[-1]].sum() + 200
    assert colours.min() >= 0 and colours.max() <= 255
    nothing = replace(shape, u2=np.full(len(shape.s), np.nan))
    assert len(np.unique(Colours("u2", 1.0).of(nothing))) == 1


def test_all_formats_say_the_same(solved: Solved, helix: Path) -> None:
    arrays = np.load(helix / "helix.npz")
    told = json.loads((helix / "helix.json").read_text())
    points = truth(solved, helix)
    np.testing.assert_allclose(arrays["points"], points, atol=1e-12)
    np.testing.assert_allclose(told["surface"]["points"], points, atol=1e-12)
    assert told["surface"]["quads"] == arrays["quads"].tolist()
    v = np.outer(np.ones(len(arrays["s"])), [-1, 0, 1])[..., None]
    swept = arrays["r"][:, None] + v * arrays["half_width"][:, None, None] * arrays["b"][:, None]
    np.testing.assert_allclose(swept[arrays["point_rows"][::3]].reshape(-1, 3), points, atol=1e-12)
    for name, row in told["rows"].items():
        np.testing.assert_array_equal(np.asarray(row["values"], float), arrays[name])
    assert told["summary"]["energy"] == solved("helix").energy
    pairs = itertools.pairwise(arrays["s"].tolist())
    assert all(a < b for a, b in pairs)
