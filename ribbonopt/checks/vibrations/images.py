"""All of a closed band at stages, put together of the piece that was solved, by its symmetry."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array

from ..gauss_stages import Sampled
from ..topology import ClosedBand

LAB = ("n", "m")


class Image(NamedTuple):
    """How an image of a piece follows from it: x -> turn x + shift, units L = 1.

    Directors are turned as well and take `signs` (3,); what is reversed is run through from its
    end, so that what acted on a section from ahead acts from behind.
    """

    turn: Array
    shift: Array
    signs: Array
    reverse: bool

    def of(self, o: Mapping[str, Array]) -> dict[str, Array]:
        """Return those outputs of the piece that the energy takes, as they are in the image."""
        T, acts = self.turn.T, -1.0 if self.reverse else 1.0
        found = {"r": o["r"] @ T + self.shift}
        for i, sign in enumerate(self.signs):
            found[f"d{i + 1}"] = sign * o[f"d{i + 1}"] @ T
            found |= {f"{load}{i + 1}": acts * sign * o[f"{load}{i + 1}"] for load in LAB}
        found |= {load: acts * o[load] @ T for load in LAB}
        found["switching"] = o["switching"]
        return {name: v[::-1] for name, v in found.items()} if self.reverse else found

    def followed(self, turn: Array, shift: Array, sign: float) -> Image:
        """Return what follows from this image by another motion, d1 and d2 taking a sign."""
        signs = self.signs * np.array([sign, sign, 1.0])
        return Image(turn @ self.turn, turn @ self.shift + shift, signs, self.reverse)


def images_of(band: ClosedBand) -> Iterator[Image]:
    """Yield the images that follow the piece that was solved, in their order along the band."""
    assert band.flip is not None
    unit, flip = band.solution.units.length, band.flip
    sign = -1.0 if flip.along_d2 else 1.0
    point = flip.point / unit
    signs = np.array([sign, -sign, -1.0])
    same = Image(np.eye(3), np.zeros(3), np.ones(3), reverse=False)
    pair = [same, Image(flip.matrix, point - flip.matrix @ point, signs, reverse=True)]
    for copy in range(band.copies):
        if copy:
            pair = [each.followed(band.turn, band.shift / unit, sign) for each in pair]
        yield from pair[copy == 0 :]


def whole(band: ClosedBand, piece: Sampled) -> Sampled:
    """Return all of a band at the stages of all its pieces; nothing switches along it."""
    images = tuple(images_of(band))
    parts = [piece.every, *(each.of(piece.every) for each in images)]
    # Of joints there are no stages: each part without its ends.
    inner = {k: np.concatenate([part[k][1:-1] for part in parts]) for k in parts[-1]}
    every = {
        k: np.concatenate([piece.every[k][:1], v, parts[-1][k][-1:]]) for k, v in inner.items()
    }
    count, widths, places = len(parts), [piece.widths], [piece.fraction[1:-1]]
    for i, image in enumerate(images, 1):
        widths.append(piece.widths[::-1] if image.reverse else piece.widths)
        places.append(i + (1 - places[0][::-1] if image.reverse else places[0]))
    return piece._replace(
        widths=np.concatenate(widths) / count,
        fraction=np.concatenate([[0.0], *places, [float(count)]]) / count,
        every=every,
        rows=np.array([0, len(every["r"]) - 1]),
    )
