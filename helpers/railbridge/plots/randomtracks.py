"""Random tracks: how rough they are wave by wave, and what a crossing of them is in probability."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from ..errors import InputError
from ..irregularities import D1, D2, D3, TrackSpectrum, spectrum
from ..studies.ensembles import Ensemble
from ..studies.peakfactors import Extreme
from ..studies.randomresponse import RandomResponse
from .drawing import TIME_LABEL, axes_or_new, band, curve, label_axes, shade
from .style import GREY, RUN_COLOURS, QuantityStyle, literal, style_of

__all__ = ["extremes", "random_response", "track_spectra", "wave_shares"]

_WAVELENGTH = "wavelength (m)"
_BANDS = {"D1": D1, "D2": D2, "D3": D3}
_POINTS = 200
_DASHES = ("-", "--", ":")
_BINS = 30
_SEEN = 1e-4
"""Share of the extremes on either side that the axis leaves out."""


def track_spectra(
    spectra: Sequence[TrackSpectrum | str], component: str = "vertical", ax: Axes | None = None
) -> Axes:
    """Plot spectra of one component over the wavelength, each where it is valid.

    The bands D1, D2 and D3 of EN 13848 are shaded in turn.

    Parameters
    ----------
    spectra : sequence of TrackSpectrum or str
        Or names of shipped ones, "german-low".
    component : str
        An angle of cross-level is drawn as a height.
    ax : Axes, optional
    """
    ax = axes_or_new(ax, 3.6)
    for i, own in enumerate(spectra):
        own = own if isinstance(own, TrackSpectrum) else spectrum(own)
        waves = np.geomspace(*own.band, _POINTS)
        density = own.density(component, 2 * np.pi / waves, height=True)
        line = {"color": RUN_COLOURS[i % len(RUN_COLOURS)]}
        line["ls"] = _DASHES[i // len(RUN_COLOURS) % len(_DASHES)]
        curve(ax, own.name, waves, 1e6 * density, label=literal(own.name), **line)
    ax.set(xscale="log", yscale="log")
    for name, (shortest, longest) in _BANDS.items():
        if name != "D2":
            shade(ax, name, shortest, longest)
        place = np.sqrt(shortest * longest)
        ax.text(place, 0.02, name, transform=ax.get_xaxis_transform(), ha="center", va="bottom")
    words = component.replace("_", "-")
    label_axes(ax, _WAVELENGTH, f"{words}, density (mm² per rad/m)", legend=False)
    _wave_axis(ax)
    ax.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize="small")
    return ax


def random_response(
    response: RandomResponse,
    name: str,
    seeds: Sequence[int] = (),
    ax: Axes | None = None,
    extreme: Extreme | None = None,
) -> Axes:
    """Plot the mean of a history, a standard deviation either way, and some realisations in grey.

    Parameters
    ----------
    response : RandomResponse
    name : str
        One of its `names`.
    seeds : sequence of int
        Realisations.
    ax : Axes, optional
    extreme : Extreme, optional
        Of the magnitude: the level that one crossing in twenty exceeds is dashed, either way.
    """
    ax, style = axes_or_new(ax), _style(name)
    time, mean, sigma = response.time(name), response.mean(name), response.sigma(name)
    for i, seed in enumerate(seeds):
        label = f"{len(seeds)} tracks of the spectrum" if i == 0 else None
        line = {"color": GREY, "lw": 0.7, "alpha": 0.7, "zorder": 1.5, "label": label}
        curve(ax, f"track {i}", time, style.factor * response.history(name, seed), **line)
    low, high = style.factor * (mean - sigma), style.factor * (mean + sigma)
    band(ax, "within sigma", time, low, high, style.colour, "mean ± standard deviation")
    for edge, values in (("mean - sigma", low), ("mean + sigma", high)):
        curve(ax, edge, time, values, color=style.colour, lw=0.8)
    curve(ax, "mean", time, style.factor * mean, color=style.colour, label="mean: level track")
    if extreme is not None:
        level, ends = style.factor * extreme.percentile(95.0), time[[0, -1]]
        line = {"color": "k", "ls": "--", "lw": 1.0}
        curve(ax, "rare", ends, [level] * 2, label="exceeded by 1 crossing in 20", **line)
        curve(ax, "rare below", ends, [-level] * 2, **line)
    return label_axes(ax, TIME_LABEL, style.label)


def extremes(
    ensemble: Ensemble,
    name: str,
    predicted: Extreme | None = None,
    ax: Axes | None = None,
    side: str = "magnitude",
) -> Axes:
    """Plot the extremes of many realisations as a histogram, and their predicted distribution.

    Parameters
    ----------
    ensemble : Ensemble
    name : str
        A history, or "wheel_unloading".
    predicted : Extreme, optional
        Its density is the line, and the level that 5 % exceed (the other way, if the smallest are
        meant) a dashed one.
    ax : Axes, optional
    side : {"largest", "smallest", "magnitude"}
    """
    ax = axes_or_new(ax, 3.2)
    style = _style(name)
    values = style.factor * ensemble.values(name, side)
    count = f"{len(values)} tracks"
    options = {"color": style.colour, "alpha": 0.35, "density": True, "label": count}
    ax.hist(values, bins=min(_BINS, max(len(values) // 10, 5)), **options)
    if predicted is not None:
        levels = style.factor * predicted.levels
        density = np.gradient(predicted.probability, levels)
        curve(ax, "predicted", levels, density, color="k", label="predicted from mean and sigma")
        place = style.factor * predicted.percentile(5.0 if side == "smallest" else 95.0)
        options = {"color": "k", "ls": "--", "transform": ax.get_xaxis_transform()}
        curve(ax, "rare", [place, place], [0.0, 1.0], label="1 in 20 is beyond", **options)
        ends = np.interp([_SEEN, 1 - _SEEN], predicted.probability, levels)
        low, high = (ends[0], ends[1]) if ends[0] < ends[1] else (ends[1], ends[0])
        ax.set_xlim(min(low, values.min()), max(high, values.max()))
    what = "wheel unloading (-)" if name == "wheel_unloading" else style.label
    per = "unit" if style.unit == "-" else style.unit
    label_axes(ax, f"extreme of the {what}", f"share per {per}")
    ax.set_ylim(bottom=0.0)
    return ax


def wave_shares(
    response: RandomResponse, name: str, time: float, ax: Axes | None = None, label: str = ""
) -> Axes:
    """Plot which share of a history's variance at a time comes from waves up to a length.

    Parameters
    ----------
    response : RandomResponse
    name : str
        One of its `names`.
    time : float
        s.
    ax : Axes, optional
    label : str
        Of the curve; default the name.

    Raises
    ------
    InputError
        A time at which nothing is random yet.
    """
    ax = axes_or_new(ax, 3.2)
    parts = response.spectrum_at(name, time).sum(axis=0)
    if not parts.sum():
        raise InputError("time", time, "is before the track is felt", "Take a time in the crossing")
    waves = 2 * np.pi / response.track.edges[::-1]
    share = np.concatenate([[0.0], np.cumsum(parts[::-1])]) / parts.sum()
    curve(ax, label or name, waves, share, label=label or name)
    ax.set(xscale="log", ylim=(0.0, 1.0))
    label_axes(ax, "waves up to this length (m)", "share of the variance")
    _wave_axis(ax)
    return ax


def _style(name: str) -> QuantityStyle:
    """Return the style of a history by its name: what stands before its place."""
    if name == "wheel_unloading":
        return style_of("force_z")._replace(words="wheel unloading", unit="-", factor=1.0)
    quantity = name.partition(" ")[0]
    if quantity == "wheel_force_z":
        return style_of("force_z")._replace(words="wheel force")
    return style_of(quantity)


def _wave_axis(ax: Axes) -> None:
    """Give a logarithmic axis of wavelengths plain round numbers."""
    low, high = ax.get_xlim()
    ticks = [n for n in (1, 2, 3, 5, 10, 20, 50, 100, 200) if low <= n <= high]
    ax.set_xticks(ticks, [f"{n:g}" for n in ticks])
    ax.xaxis.set_minor_formatter("")
