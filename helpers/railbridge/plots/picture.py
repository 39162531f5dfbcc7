"""A figure that reuses its artists as PNG, drawn again in a few milliseconds.

Text is what takes time to draw. Axes, ticks, labels and the texts that stay as they are form a
background that is kept; only curves, and the texts that have been seen to change, are drawn again
on a copy of it. An axes whose limits or labels change renews its own part of the background.
"""

from __future__ import annotations

from functools import lru_cache
from io import BytesIO
from weakref import WeakKeyDictionary, WeakSet

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_rgb
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.spines import Spine
from matplotlib.text import Text
from matplotlib.transforms import Bbox
from PIL import Image
from scipy.spatial import cKDTree

from .style import DECK_COLOUR, GREY, QUANTITY_STYLES, SHADE

__all__ = ["Picture"]

_ROOM = 0.08
"""inch, left free beside each axes: so much may tick labels grow before all is laid out anew."""
_BITS = 5
"""Kept of each channel when a colour is looked up in the palette."""


class Picture:
    """Renders a figure that reuses its artists; see `drawing.reuse_artists`.

    Parameters
    ----------
    figure : Figure
        With a constrained layout. It is laid out here, and again only where labels no longer fit.
    """

    def __init__(self, figure: Figure) -> None:
        self.figure = figure
        self._renderer: RendererAgg | None = None
        self._drawn: dict[Axes, tuple] = {}
        self._boxes: dict[Axes, Bbox] = {}
        self._first_texts: WeakKeyDictionary[Artist, tuple] = WeakKeyDictionary()
        self._changing_texts: WeakSet[Artist] = WeakSet()

    def png(self) -> bytes:
        """Return the figure as it stands now."""
        axes = [ax for ax in self.figure.axes if ax.get_visible()]
        for ax in axes:
            self._find_changing_texts(ax)
        outdated = [ax for ax in axes if self._drawn.get(ax) != self._background_of(ax)]
        fits = self._renderer is not None
        for ax in outdated:
            fits = fits and self._renew_background(ax)
        if not fits:
            self._lay_out(axes)
        np.copyto(self._pixels, self._background)
        for ax in axes:
            children = ax.get_children()
            over = [a for a in children if self._is_redrawn(a) or isinstance(a, Spine)]
            _draw(self._renderer, over)
        return self._encoded()

    def _is_redrawn(self, artist: Artist) -> bool:
        """Return whether an artist is drawn each time: curves, shades, texts that change."""
        shade = isinstance(artist, Rectangle) and artist.get_gid() is not None
        return isinstance(artist, Line2D) or shade or artist in self._changing_texts

    def _find_changing_texts(self, ax: Axes) -> None:
        for artist in ax.get_children():
            if not isinstance(artist, (Text, Legend)) or artist in self._changing_texts:
                continue
            text = _text_of(artist)
            if self._first_texts.setdefault(artist, text) != text:
                self._changing_texts.add(artist)

    def _background_of(self, ax: Axes) -> tuple:
        """Return everything that the background of an axes depends on."""
        kept = [a for a in ax.get_children() if not self._is_redrawn(a)]
        limits = ax.get_xlim(), ax.get_ylim(), ax.get_xscale(), ax.get_yscale()
        texts = ((id(a), self._first_texts.get(a)) for a in kept)
        return (*limits, ax.get_xlabel(), ax.get_ylabel(), *texts)

    def _renew_background(self, ax: Axes) -> bool:
        """Draw the background of one axes again; return False if its labels need more room."""
        box, page = ax.get_tightbbox(self._renderer), self.figure.bbox
        inside = box.x0 >= page.x0 and box.y0 >= page.y0 and box.x1 <= page.x1 and box.y1 <= page.y1
        others = (other for a, other in self._boxes.items() if a is not ax)
        if not inside or any(box.overlaps(other) for other in others):
            return False
        np.copyto(self._pixels, self._background)
        area = Bbox.union([box, self._boxes[ax]])
        height = self._pixels.shape[0]
        rows = slice(max(int(height - area.y1) - 1, 0), int(height - area.y0) + 2)
        self._pixels[rows, max(int(area.x0) - 1, 0) : int(area.x1) + 2] = 255
        self._draw_background(ax)
        self._store_background()
        self._boxes[ax] = box
        return True

    def _lay_out(self, axes: list[Axes]) -> None:
        """Share out the space, and draw the whole background."""
        figure = self.figure
        self._renderer = RendererAgg(figure.bbox.width, figure.bbox.height, figure.dpi)
        self._pixels = np.asarray(self._renderer.buffer_rgba())
        pads = {"w_pad": _ROOM, "h_pad": 0.04, "wspace": 0.0, "hspace": 0.0}
        figure.set_layout_engine("constrained", **pads)
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
        self._pixels[:] = 255
        for ax in axes:
            self._boxes[ax] = ax.get_tightbbox(self._renderer)
            self._draw_background(ax)
        self._store_background()

    def _store_background(self) -> None:
        """Keep what stands on the page as background, in pixels and in colours of the palette."""
        self._background = self._pixels.copy()
        self._indexed = _palette_index(self._background.view("<u4").ravel())

    def _draw_background(self, ax: Axes) -> None:
        _draw(self._renderer, [a for a in ax.get_children() if not self._is_redrawn(a)])
        self._drawn[ax] = self._background_of(ax)

    def _encoded(self) -> bytes:
        if any(isinstance(a, ContourSet) for ax in self.figure.axes for a in ax.collections):
            return self._encoded_in_full()
        packed = self._pixels.view("<u4").ravel()
        changed = np.flatnonzero(packed != self._background.view("<u4").ravel())
        index = self._indexed.copy()
        index[changed] = _palette_index(packed[changed])
        buffer = BytesIO()
        with Image.fromarray(index.reshape(self._pixels.shape[:2])) as picture:
            picture.putpalette(_palette()[0])
            picture.save(buffer, "png", compress_level=1)
        return buffer.getvalue()

    def _encoded_in_full(self) -> bytes:
        """Return the picture in all of its colours: those of a map are not in the palette."""
        buffer = BytesIO()
        with Image.fromarray(self._pixels) as picture, picture.convert("RGB") as plain:
            plain.save(buffer, "png", compress_level=1)
        return buffer.getvalue()


def _draw(renderer: RendererAgg, artists: list[Artist]) -> None:
    for artist in sorted(artists, key=lambda a: a.get_zorder()):
        artist.draw(renderer)


def _text_of(artist: Text | Legend) -> tuple:
    if isinstance(artist, Legend):
        return tuple(t.get_text() for t in artist.get_texts())
    return (artist.get_text(), artist.get_position())


def _palette_index(packed: np.ndarray) -> np.ndarray:
    """Return the place in the palette of every pixel, red in the lowest byte."""
    code = (packed >> 3) & 0x1F
    code |= (packed >> 6) & 0x3E0
    code |= (packed >> 9) & 0x7C00
    return _palette()[1][code]


@lru_cache(maxsize=1)
def _palette() -> tuple[bytes, np.ndarray]:
    """Return the suite's colours with their mixtures, and the nearest of them for every colour.

    Mixtures with white and shade, as antialiasing makes them, and of both with black.
    """
    own = sorted({style.colour for style in QUANTITY_STYLES.values()} | {GREY, DECK_COLOUR})
    white, shade = np.ones(3), np.array(to_rgb(SHADE))
    greys = np.linspace(0.0, 1.0, 32)[:, None] * white
    mixed = [greys, shade[None], np.linspace(0.0, 1.0, 9)[:, None] * shade]
    for colour in own:
        for ground, count in ((white, 11), (shade, 7)):
            parts = np.linspace(0.0, 1.0, count)[1:, None]
            mixed.append(ground + parts * (to_rgb(colour) - ground))
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
