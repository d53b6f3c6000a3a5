"""Ribbons along a branch as a moving picture: one camera, scale and width for all frames.

GIF is written by Pillow, which matplotlib has with it; MP4 by `ffmpeg`, where a machine has that.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ribbonopt.errors import OutputError, ViewError
from ribbonopt.output.staging import replaced
from ribbonopt.plain import Rows
from ribbonopt.solution.solution import Solution
from ribbonopt.text import one_line

from .album import Album, album_of, place
from .paper_style import PLAIN, USUAL, Style, sized
from .ribbon import is_flat, scale_bar
from .style import INK, blank, title

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from PIL.Image import Image

Kind = Literal["gif", "mp4"]
KINDS: tuple[Kind, ...] = ("gif", "mp4")
MOST = 200  # frames
RATE = 12  # frames a second
HOLD = 8  # frames for which the last one stays
WIDTH, TALLEST, WORDS, BAR = 6.4, 4.8, 0.75, 0.7  # inches
MOST_PIXELS = 3e8  # of all frames
SECONDS = 600.0  # that ffmpeg may take


def frames_of(rows: Rows) -> list[int]:
    """Return the numbers of points that are frames: all, or `MOST` evenly, special ones among them.

    Of many special points some are left out, too.
    """
    numbers = [int(row["number"]) for row in rows]
    if len(numbers) <= MOST:
        return numbers
    special = [int(row["number"]) for row in rows if row["kind"] != "point"][: MOST // 2]
    even = np.linspace(0, len(numbers) - 1, MOST - len(special)).round().astype(int)
    return sorted({*special, *(numbers[i] for i in even)})


def check_animation(kind: Kind) -> None:
    """Refuse what this machine cannot write; OutputError."""
    if kind == "mp4" and shutil.which("ffmpeg") is None:
        raise OutputError(
            "mp4: needs ffmpeg, which is not found on this machine; install it, or write a gif"
        )


def save_animation(
    ribbons: Sequence[Solution],
    captions: Sequence[str],
    path: Path,
    style: Style = PLAIN,
    name: str = "",
) -> Path:
    """Write ribbons one after the other as .gif or .mp4, as the path ends, and return it.

    Parameters
    ----------
    ribbons, captions
        Of each frame: what is drawn, and what is written under it.
    path
        The file; an older one is replaced.
    style
        Size, camera, colours; its `dpi` gives the pixels.
    name
        What stands over all frames.

    Raises
    ------
    OutputError
        If it cannot be written, or is an .mp4 and there is no ffmpeg.
    ViewError
        If there are no ribbons.
    """
    if not ribbons:
        raise ViewError(f"{path.name}: there are no ribbons to be drawn")
    with style.applied():
        images = _images(album_of(ribbons, style), captions, style, name)
        try:
            with replaced(path) as new:
                if path.suffix == ".gif":
                    _write_gif(images, new)
                else:
                    check_animation("mp4")
                    _write_mp4(images, new)
        except OutputError:
            raise
        except OSError as error:
            raise OutputError(f"{path}: cannot be written ({error.strerror or error})") from error
    return path


def _images(album: Album, captions: Sequence[str], style: Style, name: str) -> Iterator[Image]:
    """Draw the frames, all on one page."""
    from PIL import Image

    box = album.box()
    shape = (box.high - box.low) / (box.right - box.left)
    width = style.width or WIDTH
    words = WORDS * style.type_size / USUAL + (BAR if album.tint and is_flat(box) else 0.0)
    figure = blank(width, min(width * shape, TALLEST * width / WIDTH) + words, style)
    inches = float(np.prod(figure.get_size_inches())) * len(captions)
    figure.set_dpi(min(style.dpi, float(np.sqrt(MOST_PIXELS / inches))))
    axes = figure.add_subplot()
    if album.tint:
        album.tint.bar([axes], below=is_flat(box))
    longest = max(captions, key=len)
    for i in (None, *range(len(captions))):
        axes.clear()
        place(axes, album.drawings[i or 0], box)
        scale_bar(axes, box, album.size, " m" if album.subjects[0].units.si else "")
        title(axes, name)
        axes.set_xlabel(longest if i is None else captions[i], fontsize=sized(10), color=INK)
        if i is None:  # the layout, by the longest caption, is that of all frames
            figure.draw_without_rendering()
            figure.set_layout_engine("none")
            continue
        yield Image.fromarray(_pixels(figure))


def _pixels(figure: Figure) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """Return red, green and blue (height, width, 3) of a page; even numbers of both."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    found = np.asarray(canvas.buffer_rgba(), dtype=np.uint8)
    return np.ascontiguousarray(found[: len(found) // 2 * 2, : found.shape[1] // 2 * 2, :3])


def _write_gif(images: Iterator[Image], path: Path) -> None:
    from PIL import Image

    # Each frame has the colours that it needs.
    first, *rest = (image.quantize(256, dither=Image.Dither.NONE) for image in images)
    times = [1000 // RATE] * len(rest) + [HOLD * 1000 // RATE]
    first.save(path, format="GIF", save_all=True, append_images=rest, duration=times, loop=0)


def _write_mp4(images: Iterator[Image], path: Path) -> None:
    """Pipe frames into ffmpeg; OutputError with its last words where it fails."""
    frame = next(images)
    command = [
        *("ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"),
        *("-s", f"{frame.width}x{frame.height}", "-r", str(RATE), "-i", "-", "-an"),
        *("-pix_fmt", "yuv420p", "-fflags", "+bitexact", "-f", "mp4", str(path)),
    ]
    with TemporaryFile() as words:
        ffmpeg = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=words, stderr=words)
        assert ffmpeg.stdin is not None
        with suppress(BrokenPipeError):  # where it has ended; it says why
            ffmpeg.stdin.write(frame.tobytes())
            for frame in images:
                ffmpeg.stdin.write(frame.tobytes())
            for _ in range(HOLD - 1):
                ffmpeg.stdin.write(frame.tobytes())
            ffmpeg.stdin.close()
        if ffmpeg.wait(SECONDS):
            words.seek(0)
            said = words.read().decode(errors="replace").strip().splitlines()
            last = one_line(said[-1]) if said else "without a word"
            raise OutputError(f"{path.name}: ffmpeg failed: {last}")
