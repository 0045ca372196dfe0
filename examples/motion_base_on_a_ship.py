"""Which forces do the legs of my motion base carry on a ship in a rough sea?

The ship heaves, rolls and pitches in one sea of 4 m significant wave height; the complete machine is simulated on it.
"""

import numpy as np

import flexapod as fx


def main() -> float:
    """The largest leg force, N."""
    machine = fx.load("motion-base")
    home = fx.home_pose(machine)
    sea = fx.excitation.sea_spectrum(height=4.0, period=9.0)
    peak = 2 * np.pi / 9.0
    ship = {  # motion of the deck per metre of wave: a simple ship that follows long waves and not short ones
        "z": lambda w: 1 / (1 + (w / peak) ** 4),
        "roll": lambda w: 0.05j / (1 - (w / 0.6) ** 2 + 0.2j * w / 0.6),
        "pitch": lambda w: 0.02j / (1 + (w / peak) ** 4),
    }
    deck = fx.excitation.sea_motion(sea, ship, seed=3, samples=60).ramped(5.0)
    run = fx.simulate(machine, home, base_motion=deck, duration=60.0, samples=1201, rtol=1e-6, energies=False)

    rest = fx.hold(machine, home).leg_force
    late = run.sel(time=slice(10, None))
    high, low = float(late.leg_force.max()), float(late.leg_force.min())
    travel = np.degrees(np.abs(deck.evaluate(run.time.values)[0][:, 3]).max())
    print(f"the deck rolls by up to {travel:.1f} degrees")
    print(f"leg forces: {rest.mean():.0f} N at rest; between {low:.0f} and {high:.0f} N at sea (positive: compression)")
    worst = int(np.argmax(late.leg_force.max("time").values)) + 1
    when = float(late.time[np.argmax(late.leg_force.isel(leg=worst - 1).values)])
    print(f"leg {worst} carries the most, {high / rest.mean():.2f} times what it carries at rest, at t = {when:.2f} s")
    print("the joints are", "always pressed" if low > 0 else "also pulled: they need bolts that hold both ways")
    return high


if __name__ == "__main__":
    main()
