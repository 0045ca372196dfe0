"""Can force sensors in my legs damp the machine, and does the simulation agree with the prediction?

Each leg has a force sensor and an actuator. The gain with most damping is found on the exact tangent; the sampled loop
then runs on the non-linear machine over a shaken base.
"""

import numpy as np

import flexapod as fx

LEAK = 3.0  # rad/s: keeps the legs' stiffness at rest


def main() -> float:
    """RMS vertical acceleration with control over that without."""
    machine = fx.load("cubic-isolator")
    home = fx.home_pose(machine)
    locus = fx.control.root_locus(machine, home, "force", gains=np.geomspace(2, 200, 40), leak=LEAK)
    gain = locus.attrs["best_gain"]
    passive = fx.linearise(machine, home).modes().damping_ratio.min()
    print(f"damping ratio: {passive:.3f} without, at best {locus.attrs['best_damping']:.3f} with gain {gain:.1f} rad/s")

    controller = fx.control.ForceFeedback(gain, LEAK).on(fx.linearise(machine, home)).sampled(2e-3)
    base = fx.random_motion("z", fx.excitation.flat_spectrum(0.01, 5.0, 200.0), seed=1)
    hardware = fx.control.Hardware(force_limit=5.0, noise={"leg_force": 1e-3})
    run = fx.control.simulate_control(
        machine, home, controller=controller, base_motion=base, duration=6.0, hardware=hardware, after=1.0
    )
    rms = run.rms_acceleration.sel(axis="z")
    predicted = run.predicted_rms_acceleration.sel(axis="z")
    for case in ("passive", "controlled"):
        simulated, told = 1e3 * float(rms.sel(case=case)), 1e3 * float(predicted.sel(case=case))
        print(f"{case:10}: {simulated:.3f} mm/s2 RMS simulated, {told:.3f} predicted")
    print(f"forces stay below {float(np.abs(run.force).max()):.2f} N; {run.attrs['saturated']:.1%} were limited")
    return float(rms.sel(case="controlled") / rms.sel(case="passive"))


if __name__ == "__main__":
    main()
