"""How do I hand my machine to python-control, to design a controller of my own?

`to_control` gives the exact tangent as a state space with named signals; what is needed is picked by name.
"""

import numpy as np

import control
import flexapod as fx

STIFFENING, DAMPING, FILTER = 4e4, 400.0, 2000.0  # N/m and N s/m on each leg, rad/s


def main() -> float:
    """The static stiffness of the platform along z in the closed loop, N/m."""
    machine = fx.load("cubic-isolator")
    tangent = fx.linearise(machine, fx.home_pose(machine)).to_control()
    print(f"{tangent.nstates} states, {tangent.ninputs} inputs, {tangent.noutputs} outputs, such as", end=" ")
    print(", ".join([*tangent.input_labels[::8], *tangent.output_labels[::8]]))

    push = [f"leg_force_{leg}" for leg in range(1, 7)]
    measured = [f"leg_length_{leg}" for leg in range(1, 7)]
    plant = tangent[["position_z", *measured], ["wrench_z", *push]]
    plant = control.ss(plant, inputs=["wrench_z", *push], outputs=["position_z", *measured], name="plant")

    s = control.tf("s")
    one = STIFFENING + DAMPING * s / (1 + s / FILTER)  # pushes back against length and rate, each leg on its own
    legs = control.append(*[control.tf2ss(-one)] * 6)
    legs = control.ss(legs, inputs=measured, outputs=push, name="legs")
    loop = control.interconnect([plant, legs], inputs=["wrench_z"], outputs=["position_z"])
    for name, system in (("open", plant["position_z", "wrench_z"]), ("closed", loop["position_z", "wrench_z"])):
        poles = system.poles()
        least = control.damp(system, doprint=False)[1].min()
        print(f"{name:6} loop: {1 / system.dcgain():8.0f} N/m, slowest pole {np.abs(poles).min():.1f} rad/s,", end=" ")
        print(f"least damping ratio {least:.3f}")
    return float(1 / loop.dcgain())


if __name__ == "__main__":
    main()
