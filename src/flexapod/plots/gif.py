"""Writes GIF files whose pictures share one palette: to find one for each takes longer than to draw it."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.animation import AbstractMovieWriter
from numpy.typing import NDArray
from PIL import Image

_SAMPLES = 4  # pictures that the palette is made from
_RGB = np.uint32(0xFFFFFF)  # of a pixel's four bytes, red the lowest


class GifWriter(AbstractMovieWriter):
    """A writer of Matplotlib's for GIF; its films begin again where they end."""

    def setup(self, fig: Any, outfile: str | Path, dpi: float | None = None) -> None:
        super().setup(fig, outfile, dpi)
        self._pictures: list[NDArray[np.uint32]] = []

    def grab_frame(self, **_: Any) -> None:
        drawn = io.BytesIO()
        self.fig.savefig(drawn, format="rgba", dpi=self.dpi)
        pixels = np.frombuffer(drawn.getvalue(), "<u4").astype(np.uint32) & _RGB
        self._pictures.append(pixels.reshape(self.frame_size[::-1]))

    def finish(self) -> None:
        if not self._pictures:
            return  # it was stopped before the first
        first, *others = _with_one_palette(self._pictures)
        duration = int(1000 / self.fps)
        first.save(self.outfile, format="GIF", save_all=True, append_images=others, duration=duration, loop=0)


def _with_one_palette(pictures: list[NDArray[np.uint32]]) -> Iterator[Image.Image]:
    """Each pixel in the nearest of 256 colours."""
    samples = np.concatenate(pictures[:: -(-len(pictures) // _SAMPLES)])
    palette = Image.fromarray(_channels(samples).astype(np.uint8)).quantize().getpalette()
    colors = np.array(palette).reshape(-1, 3)
    nearest = np.full(1 << 24, -1, dtype=np.int16)
    for picture in pictures:
        new = np.unique(picture[nearest[picture] < 0])
        nearest[new] = (np.square(colors).sum(axis=1) - 2 * _channels(new) @ colors.T).argmin(axis=1)
        found = Image.fromarray(nearest[picture].astype(np.uint8))
        found.putpalette(palette)  # type: ignore[arg-type]  # an image of colours has one
        yield found


def _channels(pixels: NDArray[np.uint32]) -> NDArray[np.int64]:
    """(..., 3): red, green and blue."""
    return pixels[..., None].astype(np.int64) >> np.array([0, 8, 16]) & 255
