"""A live figure as PNG, drawn again in a few milliseconds.

Text is what takes time to draw. Axes, ticks, labels and the texts that stay as they are form a background that is kept; only
curves, and the texts that have been seen to change, are drawn again on a copy of it. An axes whose limits or labels change
renews its own part of the background.
"""

from __future__ import annotations

from functools import lru_cache
from io import BytesIO
from weakref import WeakKeyDictionary

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.spines import Spine
from matplotlib.text import Text
from matplotlib.transforms import Bbox
from PIL import Image
from scipy.spatial import cKDTree

from .drawing import GREY, LOOKS, SHADE

__all__ = ["Picture"]

PAD = 0.08  # inch, left free beside each axes: so much may tick labels grow before all is laid out anew
_BITS = 5  # kept of each channel when a colour is looked up in the palette


class Picture:
    """Renders a live figure; see `drawing.live`.

    Parameters
    ----------
    figure : Figure
        With a constrained layout. It is laid out here, and again only where labels no longer fit.
    """

    def __init__(self, figure: Figure) -> None:
        self.figure = figure
        self._renderer: RendererAgg | None = None
        self._keys: dict[Axes, tuple] = {}
        self._boxes: dict[Axes, Bbox] = {}
        self._said: WeakKeyDictionary[Artist, tuple] = WeakKeyDictionary()
        self._moving: WeakKeyDictionary[Artist, bool] = WeakKeyDictionary()

    def png(self) -> bytes:
        """Return the figure as it stands now."""
        axes = [ax for ax in self.figure.axes if ax.get_visible()]
        for ax in axes:
            self._notice(ax)
        stale = [ax for ax in axes if self._keys.get(ax) != self._key(ax)]
        fits = self._renderer is not None
        for ax in stale:
            fits = fits and self._renew(ax)
        if not fits:
            self._lay_out(axes)
        np.copyto(self._pixels, self._background)
        for ax in axes:
            _draw(self._renderer, [a for a in ax.get_children() if self._moves(a) or isinstance(a, Spine)])
        return self._encoded()

    def _moves(self, artist: Artist) -> bool:
        """Return whether an artist is drawn anew each time: curves, shades, and what has been seen to say something else."""
        shade = isinstance(artist, Rectangle) and artist.get_gid() is not None
        return isinstance(artist, Line2D) or shade or artist in self._moving

    def _notice(self, ax: Axes) -> None:
        for artist in ax.get_children():
            if not isinstance(artist, (Text, Legend)) or artist in self._moving:
                continue
            says = _says(artist)
            if self._said.setdefault(artist, says) != says:
                self._moving[artist] = True

    def _key(self, ax: Axes) -> tuple:
        """Everything that the background of an axes depends on."""
        kept = [(id(a), self._said.get(a)) for a in ax.get_children() if not self._moves(a)]
        axis = (ax.get_xlim(), ax.get_ylim(), ax.get_xscale(), ax.get_yscale(), ax.get_xlabel(), ax.get_ylabel())
        return (*axis, *kept)

    def _renew(self, ax: Axes) -> bool:
        """Draw the background of one axes again; return False if its labels need more room than there is."""
        box = ax.get_tightbbox(self._renderer)
        page = self.figure.bbox
        inside = box.x0 >= page.x0 and box.y0 >= page.y0 and box.x1 <= page.x1 and box.y1 <= page.y1
        if not inside or any(box.overlaps(other) for a, other in self._boxes.items() if a is not ax):
            return False
        np.copyto(self._pixels, self._background)
        area = Bbox.union([box, self._boxes[ax]])
        height = self._pixels.shape[0]
        rows = slice(max(int(height - area.y1) - 1, 0), int(height - area.y0) + 2)
        self._pixels[rows, max(int(area.x0) - 1, 0) : int(area.x1) + 2] = 255
        self._draw_kept(ax)
        self._keep()
        self._boxes[ax] = box
        return True

    def _lay_out(self, axes: list[Axes]) -> None:
        """Share out the space, and draw the whole background."""
        figure = self.figure
        self._renderer = RendererAgg(figure.bbox.width, figure.bbox.height, figure.dpi)
        self._pixels = np.asarray(self._renderer.buffer_rgba())
        figure.set_layout_engine("constrained", w_pad=PAD, h_pad=0.04, wspace=0.0, hspace=0.0)
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
        self._pixels[:] = 255
        for ax in axes:
            self._boxes[ax] = ax.get_tightbbox(self._renderer)
            self._draw_kept(ax)
        self._keep()

    def _keep(self) -> None:
        """Keep what stands on the page as background, in pixels and in colours of the palette."""
        self._background = self._pixels.copy()
        self._indexed = _nearest(self._background.view("<u4").ravel())

    def _draw_kept(self, ax: Axes) -> None:
        _draw(self._renderer, [a for a in ax.get_children() if not self._moves(a)])
        self._keys[ax] = self._key(ax)

    def _encoded(self) -> bytes:
        packed, before = (pixels.view("<u4").ravel() for pixels in (self._pixels, self._background))
        changed = np.flatnonzero(packed != before)
        index = self._indexed.copy()
        index[changed] = _nearest(packed[changed])
        buffer = BytesIO()
        with Image.fromarray(index.reshape(self._pixels.shape[:2])) as picture:
            picture.putpalette(_colours()[0])
            picture.save(buffer, "png", compress_level=1)
        return buffer.getvalue()


def _nearest(packed: np.ndarray) -> np.ndarray:
    """Return the place in the palette of every pixel, red in the lowest byte."""
    code = (packed >> 3) & 0x1F
    code |= (packed >> 6) & 0x3E0
    code |= (packed >> 9) & 0x7C00
    return _colours()[1][code]


@lru_cache(maxsize=1)
def _colours() -> tuple[bytes, np.ndarray]:
    """Return the suite's colours and their mixtures with white, shade and black, and the nearest of them for every colour."""
    own = sorted({style.colour for style in LOOKS.values()} | {GREY, "#34495e"})
    white, shade = np.ones(3), np.array(to_rgb(SHADE))
    mixed = [np.linspace(0.0, 1.0, 32)[:, None] * white, shade[None], np.linspace(0.0, 1.0, 9)[:, None] * shade]
    for colour in own:
        mixed += [
            ground + np.linspace(0.0, 1.0, n)[1:, None] * (to_rgb(colour) - ground) for ground, n in ((white, 11), (shade, 7))
        ]
    palette = np.unique((255 * np.concatenate(mixed)).round().astype(int), axis=0)
    levels = np.arange(2**_BITS) * 255.0 / (2**_BITS - 1)
    # Red is the lowest byte of a pixel.
    blue, green, red = np.meshgrid(levels, levels, levels, indexing="ij")
    every = np.stack([red, green, blue], axis=-1).reshape(-1, 3)
    nearest = cKDTree(palette).query(every)[1]
    red, green, blue = (np.array([to_rgb(c) for c in [*own, SHADE]]) * 255).round().astype(int).T
    exact = (red >> 3) | (green >> 3) << _BITS | (blue >> 3) << 2 * _BITS
    nearest[exact] = cKDTree(palette).query(np.column_stack([red, green, blue]))[1]
    return palette.astype(np.uint8).tobytes(), nearest.astype(np.uint8)


def _says(artist: Text | Legend) -> tuple:
    if isinstance(artist, Legend):
        return tuple(t.get_text() for t in artist.get_texts())
    return (artist.get_text(), artist.get_position())


def _draw(renderer: RendererAgg, artists: list[Artist]) -> None:
    for artist in sorted(artists, key=lambda a: a.get_zorder()):
        artist.draw(renderer)
