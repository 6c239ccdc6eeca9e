"""Ramps of cables that rub, up to a tension and back in 19 points: points lost, and iterations a point.

The paper's arm and one arc of its length, over friction and the largest tension. Asserted is that no point is
lost, and that a point takes no more iterations than allowed.
"""

import numpy as np

from statics import RONE2012_HOLE_OFFSET, Arm, Bending, Cable, CableFriction, Cables, Scene, StaticSolver
from statics.ramp import ramp

FRICTIONS = (0.1, 0.2, 0.3, 0.4, 0.5)
TENSIONS = (2.0, 5.0, 10.0, 20.0, 30.0, 50.0)
"""Largest tensions, N."""
POINTS = 10
"""Points on the way up, the first and the last counted."""
ITERATIONS_WITHIN = 50.0
"""Largest allowed mean of the iterations a point over a ramp."""


def scenes(friction: float) -> dict[str, Scene]:
    """The arms by name, each with one cable of that friction."""
    cables = (Cable("upper", RONE2012_HOLE_OFFSET, friction=friction),)
    arms = {
        "paper": Arm.preset("rone2012", cables=cables),
        "one arc": Arm.preset("rone2012", disks=1, disk_spacing=0.08, cables=cables),
    }
    return {name: Scene(arm, (Bending(), Cables(), CableFriction())) for name, arm in arms.items()}


def lost_and_iterations(scene: Scene, tension: float) -> tuple[int, float]:
    """Points not found in a ramp up to a tension and back, and iterations a point."""
    up = np.linspace(0.0, tension, POINTS)
    points = ramp(StaticSolver(scene), np.concatenate([up, up[-2::-1]])[:, None])
    return sum(not point.found for point in points), float(np.mean([point.iterations for point in points]))


def main() -> None:
    """Print the table and check its bounds."""
    lost = ramps = 0
    most = 0.0
    print("points lost of 19 (iterations a point), by the largest tension")
    print("arm      friction  " + "".join(f"{tension:>9g} N" for tension in TENSIONS))
    for friction in FRICTIONS:
        for name, scene in scenes(friction).items():
            cells = [lost_and_iterations(scene, tension) for tension in TENSIONS]
            print(f"{name:8s} {friction:8g}  " + "".join(f"{n:>4d} ({each:4.1f})" for n, each in cells))
            lost, ramps = lost + sum(n for n, _ in cells), ramps + len(cells)
            most = max(most, *(each for _, each in cells))
    print(f"points lost: {lost} of {ramps * (2 * POINTS - 1)} (allowed: 0)")
    print(f"most iterations a point: {most:.1f} (allowed: {ITERATIONS_WITHIN:g})")
    assert lost == 0
    assert most < ITERATIONS_WITHIN


if __name__ == "__main__":
    main()
