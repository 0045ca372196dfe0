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
    response = fx.random_response(machine, home, {"x": floor, "y": floor, "z": floor})
    still = floor.rms()
    print(f"the floor moves with {1e6 * still:.1f} um/s RMS along each axis")
    for axis in ("x", "y", "z"):
        acceleration = float(response.rms_acceleration.sel(output=axis))
        travel = float(response.rms_displacement.sel(output=axis))
        psd = response.psd_acceleration.sel(output=axis)
        peak = float(psd.omega[np.argmax(psd.values)]) / (2 * np.pi)
        print(f"  {axis}: {1e3 * acceleration:.3f} mm/s2 and {1e6 * travel:.2f} um RMS, most of it at {peak:.2f} Hz")

    hertz = np.array([1.0, 5.0, 10.0, 20.0, 50.0])
    ratio = np.abs(fx.transmissibility(machine, home, 2 * np.pi * hertz).absolute.sel(output="z", base="z"))
    for f, r in zip(hertz, ratio.values, strict=True):
        print(f"  at {f:4.0f} Hz the platform moves {r:.3g} times as much as the floor")
    print("answer: it resonates near 5 Hz and isolates from about 7 Hz on")
    return float(response.rms_acceleration.sel(output="z"))


if __name__ == "__main__":
    main()
