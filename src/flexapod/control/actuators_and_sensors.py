"""What real actuators and sensors do to a controller: force limits and noise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import floats, instance, numbers, one_of, whole
from flexapod.control.linear_controller import MEASUREMENTS, signals
from flexapod.conventions import Array
from flexapod.errors import ArgumentError, shown
from flexapod.showing import in_notebooks

_SIGNALS = 6 * len(MEASUREMENTS)


@in_notebooks
@dataclass(frozen=True)
class Hardware:
    """Limits of actuators and noise of sensors.

    Parameters
    ----------
    force_limit : float or array_like, shape (6,), optional
        Largest force of each leg's actuator, N. Unlimited by default.
    noise : mapping of str to float or array_like of shape (6,), optional
        Root mean square of the white noise on each kind of measurement, in its unit (see `Controller`).
    seed : int, optional
        Seed of the noise.

    Examples
    --------
    >>> hardware = fx.control.Hardware(force_limit=5.0, noise={"acceleration": 1e-3})
    >>> hardware.limits()
    array([5., 5., 5., 5., 5., 5.])
    """

    force_limit: ArrayLike = np.inf
    noise: Mapping[str, ArrayLike] = field(default_factory=dict)
    seed: int = 0

    def limits(self) -> Array:
        """Return the largest force of each leg's actuator.

        Returns
        -------
        ndarray, shape (6,)
            Forces, N.

        Raises
        ------
        ArgumentError
            If a limit is not positive, or they are neither one nor six.
        """
        try:
            limit = np.broadcast_to(floats(self.force_limit), (6,)).copy()
        except (TypeError, ValueError):
            raise ArgumentError(
                f"force_limit is {shown(self.force_limit)}; give a number, or six for the legs"
            ) from None
        if not (limit > 0).all():
            raise ArgumentError(f"force_limit is {shown(self.force_limit)} N; it must be > 0")
        return limit

    def drawn(self, samples: int) -> Array:
        """Draw the noise on every measurement.

        Parameters
        ----------
        samples : int
            Number of samples.

        Returns
        -------
        ndarray, shape (samples, 36)
            Noise in the units of the measurements.

        Raises
        ------
        ArgumentError
            If a measurement is unknown or its noise negative, or the seed is no whole number >= 0.
        """
        rms = np.zeros(_SIGNALS)
        instance(self.noise, Mapping, "noise", "from a measurement to its RMS")
        for name, value in self.noise.items():
            one_of(name, "a key of noise", MEASUREMENTS)
            part = numbers(value, f"noise of {name}", None)
            if part.shape not in ((), (6,)) or not np.isfinite(part).all() or (part < 0).any():
                raise ArgumentError(f"noise of {name} is {shown(value)}; give a finite number >= 0, or six")
            rms[signals(name)] = part
        random = np.random.default_rng(whole(self.seed, "seed", 0))
        drawn: Array = rms * random.standard_normal((samples, _SIGNALS))
        return drawn
