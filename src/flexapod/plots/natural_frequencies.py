"""Natural frequencies as a figure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexapod.conventions import TWO_PI, Array
from flexapod.mechanics.cautions import GROWS, other_than_vibration
from flexapod.plots.style import FAINT, PLATFORM, STRETCHED, across, ink, letters, new_axes, wide

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
        Axes to draw on. Default: those of a new figure.
    tangent : array_like, optional
        (6,) frequencies of the exact tangent that belong to the same modes, rad/s, or its poles; NaN: there is none.
        Of poles that do not vibrate, or grow, the figure says so instead.
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
    ax = new_axes(7.0, 2.6) if ax is None else ax
    y = np.arange(1, 7)
    hz = np.asarray(omega) / TWO_PI
    seen = hz > 0
    ax.hlines(y, 0, 1, transform=ax.get_yaxis_transform(), color=FAINT, lw=wide(0.4), alpha=0.5)
    ax.plot(hz[seen], y[seen], "o", ms=wide(8), color=PLATFORM, label="Eq. 5", clip_on=False, zorder=3)
    if tangent is not None:
        hz = np.append(hz, _tangent(ax, y, np.asarray(tangent)))
        ax.legend(
            loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False, labelcolor=ink(), fontsize=letters()
        )
    _logarithmic(ax, hz)
    ax.set_yticks(y, _names(ax, y, labels), color=ink())
    ax.set_ylim(6.6, 0.4)
    ax.set_xlabel("natural frequency, Hz", color=ink())
    for side in ("top", "right", "left"):
        ax.spines[side].set_visible(False)
    ax.spines["bottom"].set_color(FAINT)
    ax.tick_params(axis="y", length=0)
    ax.tick_params(axis="x", which="both", color=FAINT, labelcolor=ink())
    return ax


def _names(ax: Axes, rows: NDArray[np.int64], labels: Sequence[str] | None) -> list[str]:
    """What stands beside each row. Where a figure is narrow, words go above the lines instead, and numbers beside."""
    if labels is None:
        return [f"mode {i}" for i in rows]
    if across(ax) >= _WIDE:
        return [f"{i}  {label}" for i, label in zip(rows, labels, strict=True)]
    for row, label in zip(rows, labels, strict=True):
        where = ax.get_yaxis_transform()
        ax.text(0.0, row - 0.2, label, transform=where, color=ink(), fontsize=letters(), va="bottom")
    return [str(i) for i in rows]


def _tangent(ax: Axes, rows: NDArray[np.int64], tangent: NDArray[Any]) -> Array:
    """Draw the tangent's modes: a mark at each frequency, words where there is none. Returns the frequencies, Hz."""
    pole = tangent if np.iscomplexobj(tangent) else 1j * np.abs(tangent)
    vibrates = pole.imag > 0
    hz = np.where(vibrates, np.abs(pole), np.nan) / TWO_PI
    ax.plot(hz, rows, "|", ms=wide(17), mew=wide(2.2), color=STRETCHED, label="exact tangent", clip_on=False, zorder=4)
    grows = pole.real > GROWS * np.nanmax(np.abs(pole), initial=0.0)
    across = ax.get_yaxis_transform()
    for row, one, grown in zip(rows, pole, grows, strict=True):
        if words := other_than_vibration(one, grown) if np.isfinite(one) else "":
            ax.text(
                1.0, row - 0.08, words, transform=across, color=STRETCHED, fontsize=letters(), ha="right", va="bottom"
            )
    return hz


_WIDE = 5.0  # inches, in which words of 40 letters leave room for the frequencies beside them
_STEPS = ((1,), (1, 3), (1, 2, 5), (1, 1.5, 2, 3, 4, 5, 7))  # within a decade, from few to many


def _logarithmic(ax: Axes, hz: Array) -> None:
    """A logarithmic scale around all that is drawn, with three round plain numbers or more."""
    from matplotlib.ticker import FixedLocator, MaxNLocator, NullFormatter, NullLocator

    hz = hz[np.isfinite(hz) & (hz > 0)]
    if hz.size == 0:
        return
    low, high = hz.min() / 1.15, hz.max() * 1.15
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    rows = [np.outer(decades, steps).ravel() for steps in _STEPS] + [MaxNLocator(6).tick_values(low, high)]
    inside = [row[(row >= low) & (row <= high)] for row in rows]
    ticks = next((row for row in inside if row.size >= 3), inside[-1])
    ax.set_xscale("log")
    ax.set_xlim(low, high)
    ax.xaxis.set_major_locator(FixedLocator(ticks))
    ax.xaxis.set_minor_locator(NullLocator())
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_xticks(ticks, [f"{tick:.10g}" for tick in ticks])
