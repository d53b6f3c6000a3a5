"""OBJ, of Wavefront, which nearly all programs of 3D read: text, faces of four corners."""

from __future__ import annotations

from .carried import Carried


def write(carried: Carried) -> dict[str, bytes]:
    """Return the surface with its normals; what it is and its units are comments."""
    mesh = carried.mesh
    lines = [f"# {comment}" for comment in carried.comments]
    lines += ["o ribbon"]
    lines += ["v {!r} {!r} {!r}".format(*point) for point in mesh.points.tolist()]
    lines += ["vn {:.7g} {:.7g} {:.7g}".format(*normal) for normal in mesh.normals.tolist()]
    lines += [
        "f " + " ".join(f"{corner}//{corner}" for corner in face)
        for face in (mesh.quads + 1).tolist()
    ]
    return {".obj": ("\n".join(lines) + "\n").encode(errors="replace")}
