"""Does my platform resonate on the floor of my laboratory, and by how much does it shake?

The floor just meets a vibration criterion (VC-C), in all three directions at once; the response is integrated over the
exact tangent, so that sharp resonances are neither missed nor overrated.
"""

import numpy as np

import flexapod as fx


def main() -> float:
    """RMS of the platform's vertical acceleration, m/s2."""
    machine = fx.load("cubic-isolator")
    home = fx.home_pose(machine)
    floor = fx.vc_curve("VC-C")
    response = fx.random_response(machine, home, psd={"x": floor, "y": floor, "z": floor})
    still = floor.rms()
    print(f"the floor moves with {1e6 * still:.1f} um/s RMS along each axis")
    for axis in ("x", "y", "z"):
        acceleration = float(response.rms_acceleration.sel(output=axis))
        travel = float(response.rms_displacement.sel(output=axis))
        psd = response.psd_acceleration.sel(output=axis)
        peak = float(psd.omega[np.argmax(psd.values)]) / (2 * np.pi)
        print(f"  {axis}: {1e3 * acceleration:.3f} mm/s2 and {1e6 * travel:.2f} um RMS, most of it at {peak:.2f} Hz")

    hertz = np.geomspace(1.0, 80.0, 500)
    ratio = np.abs(fx.transmissibility(machine, home, frequency=hertz).absolute.sel(output="z", base="z")).values
    isolates = hertz[np.flatnonzero(ratio > 1)[-1] + 1]
    at = hertz[ratio.argmax()]
    print(f"answer: it resonates at {at:.2f} Hz, where it moves {ratio.max():.1f} times as far as the floor,")
    print(f"and isolates from {isolates:.2f} Hz on: at {hertz[-1]:.0f} Hz it moves {ratio[-1]:.3f} times as far")
    return float(response.rms_acceleration.sel(output="z"))


if __name__ == "__main__":
    main()
