"""Natural frequencies as a figure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from flexapod.conventions import TWO_PI, Array
from flexapod.plots.style import FAINT, INK, PLATFORM, STRETCHED

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def frequencies(
    omega: ArrayLike,
    *,
    ax: Axes | None = None,
    tangent: ArrayLike | None = None,
    labels: Sequence[str] | None = None,
) -> Axes:
    """Draw six natural frequencies on a logarithmic scale in Hz.

    Parameters
    ----------
    omega : array_like
        (6,) natural frequencies, rad/s; those that are zero are left out.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure of pyplot.
    tangent : array_like, optional
        (6,) frequencies of the exact tangent, rad/s, drawn beside.
    labels : sequence of str, optional
        Words for each mode. Default: its number.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Notes
    -----
    The frequencies of `natural_modes` are those of Eq. 5 of the paper, undamped and without preload.

    Examples
    --------
    >>> ax = fx.plots.frequencies(fx.natural_modes(fx.load("motion-base")).omega)
    >>> ax.get_xlabel()
    'natural frequency, Hz'
    """
    if ax is None:
        import matplotlib.pyplot as plt

        ax = plt.figure(figsize=(7, 2.6), layout="constrained").add_subplot()
    y = np.arange(1, 7)
    hz = np.asarray(omega) / TWO_PI
    seen = hz > 0
    ax.hlines(y, 0, 1, transform=ax.get_yaxis_transform(), color=FAINT, lw=0.4, alpha=0.5)
    ax.plot(hz[seen], y[seen], "o", ms=8, color=PLATFORM, label="Eq. 5", clip_on=False, zorder=3)
    if tangent is not None:
        at = np.abs(np.asarray(tangent)) / TWO_PI
        ax.plot(at, y, "|", ms=17, mew=2.2, color=STRETCHED, label="exact tangent", clip_on=False, zorder=4)
        ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False, labelcolor=INK, fontsize=10)
    _logarithmic(ax, hz[seen])
    names = (
        [f"mode {i}" for i in y] if labels is None else [f"{i}  {label}" for i, label in zip(y, labels, strict=True)]
    )
    ax.set_yticks(y, names, color=INK)
    ax.set_ylim(6.6, 0.4)
    ax.set_xlabel("natural frequency, Hz", color=INK)
    for side in ("top", "right", "left"):
        ax.spines[side].set_visible(False)
    ax.spines["bottom"].set_color(FAINT)
    ax.tick_params(axis="y", length=0)
    ax.tick_params(axis="x", which="both", color=FAINT, labelcolor=INK)
    return ax


def _logarithmic(ax: Axes, hz: Array) -> None:
    """A logarithmic scale with round plain numbers around the frequencies."""
    from matplotlib.ticker import FixedLocator, NullFormatter, NullLocator

    if hz.size == 0:
        return
    low, high = hz.min() / 1.15, hz.max() * 1.15
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    wide = high / low > 30
    ticks = np.outer(decades, (1, 3) if wide else (1, 1.5, 2, 3, 4, 5, 7)).ravel()
    if high / low > 3000:
        ticks = decades
    inside = ticks[(ticks >= low) & (ticks <= high)]
    ax.set_xscale("log")
    ax.set_xlim(low, high)
    ax.xaxis.set_major_locator(FixedLocator(inside))
    ax.xaxis.set_minor_locator(NullLocator())
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_xticks(inside, [f"{tick:,.10g}" for tick in inside])
