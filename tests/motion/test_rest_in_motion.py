"""Where statics finds an arm at rest, the motion leaves it there: in random scenes."""

from dataclasses import replace

import numpy as np
from random_scenes import Case, at_rest, dynamics_of, following, holds_in, inextensible, loaded, meshed


@holds_in(loaded, following, meshed, inextensible)
def test_equilibrium_is_a_fixed_point_of_the_motion(case: Case) -> None:
    """Newton's step of the motion's own acceleration and Jacobian, from there to its rest, is rounding.

    Not so with friction: at rest statics holds what a cable was last drawn in or let out by, where motion has
    it creep.
    """
    rest = at_rest(case)
    assert rest.found
    scene, inputs = case.scene, case.scene.with_zero_rates(case.drives)
    still = replace(
        case,
        inputs=dict(zip(scene.inputs, inputs.tolist(), strict=True)),
        q=rest.coordinates,
        u=np.zeros_like(case.u),
    )
    dynamics, y, interval = dynamics_of(still)
    size, parts = dynamics.size, len(scene.coordinates)
    acceleration = dynamics.rate(0.0, y, interval)[size : 2 * size]
    by_q = dynamics.jacobian(0.0, y, interval)[size : 2 * size, :size]
    step = np.linalg.solve(by_q, acceleration) / np.tile([1.0, scene.arm.rest_length][:parts], len(case.q))
    assert np.abs(step).max() < 1e-10  # rad, or of the segment's length
