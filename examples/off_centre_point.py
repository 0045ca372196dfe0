"""How much floor vibration reaches a sensor that stands off the centre of my platform?

Transmissibility from the floor to a point of the platform: away from the centre, tilting adds to the motion.
"""

import sys

import numpy as np

import flexapod as fx
from flexapod.plots import response

SENSOR = [0.10, 0.0, 0.12]  # m, platform frame


def main(path: str | None = None) -> float:
    """The largest transmissibility from x of the floor to z of the sensor. path: where to save a figure."""
    machine = fx.load("precision-positioner")
    home = fx.home_pose(machine)
    omega = fx.natural_modes(machine, home).omega
    sweep = np.unique(np.concatenate([omega, *(np.linspace(0.5, 1.3, 400) * w for w in omega)]))  # peaks are narrow
    center = fx.transmissibility(machine, home, omega=sweep)
    sensor = fx.transmissibility(machine, home, omega=sweep, point=SENSOR)
    for output in ("x", "z"):
        for name, found in (("centre", center), ("sensor", sensor)):
            curve = np.abs(found.absolute.sel(output=output, base="x"))
            peak = int(np.argmax(curve.values))
            hertz = sweep[peak] / (2 * np.pi)
            print(f"floor x to {name} {output}: at most {float(curve[peak]):7.3f} m/m, at {hertz:.1f} Hz")
    static = fx.transmissibility(machine, home, omega=[0.0], point=SENSOR).compliance.sel(output="z", wrench="z")
    print(f"a hand that presses the sensor down with 10 N moves it by {1e6 * 10 * float(np.abs(static[0])):.2f} um")
    if path is not None:
        response.frequency_response(sensor, given="x", natural=omega).savefig(path)
    return float(np.abs(sensor.absolute.sel(output="z", base="x")).max())


if __name__ == "__main__":
    main(*sys.argv[1:2])
