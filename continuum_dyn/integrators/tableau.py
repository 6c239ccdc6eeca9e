"""The Runge-Kutta methods of the chain, as numbers.

The first stage is the start of a step and the last one its end. The implicit ones have one diagonal element
and are L-stable; an explicit one is the same with a zero there.
"""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np


@dataclass(frozen=True)
class Tableau:
    """Butcher's coefficients; ``error_weights`` is the difference to the embedded method's weights.

    The error of a step goes with its size to the power ``order``.
    """

    name: str
    source: str
    order: int
    a: np.ndarray
    error_weights: np.ndarray

    @cached_property
    def c(self) -> np.ndarray:
        """Times of the stages in units of the step."""
        return self.a.sum(axis=1)

    @property
    def explicit(self) -> bool:
        """Whether no stage depends on itself."""
        return not self.a.diagonal().any()

    @cached_property
    def predictor(self) -> np.ndarray:
        """Weights that extrapolate a stage's acceleration from those before it, shape (stages, stages).

        Lagrange's polynomial through the last three stages of the method itself.
        """
        weights = np.zeros_like(self.a)
        first = 0 if self.a[:, 0].any() else 1
        for i in range(1, len(self.c)):
            known = range(max(first, i - 3), i)
            for j in known:
                others = [k for k in known if k != j]
                weights[i, j] = np.prod([(self.c[i] - self.c[k]) / (self.c[j] - self.c[k]) for k in others])
        return weights


def _lower(rows: list[list[float]], diagonal: float) -> np.ndarray:
    """A square matrix from its rows without diagonal elements; the first stage is explicit."""
    a = np.zeros((len(rows), len(rows)))
    for number, row in enumerate(rows[1:], start=1):
        a[number, : len(row)] = row
        a[number, number] = diagonal
    return a


_WEIGHTS = [
    -872700587467 / 9133579230613,
    0.0,
    0.0,
    22348218063261 / 9555858737531,
    -1143369518992 / 8141816002931,
    -39379526789629 / 19018526304540,
    32727382324388 / 42900044865799,
]
_EMBEDDED = [
    -975461918565 / 9796059967033,
    0.0,
    0.0,
    78070527104295 / 32432590147079,
    -548382580838 / 3424219808633,
    -33438840321285 / 15594753105479,
    3629800801594 / 4656183773603,
    4035322873751 / 18575991585200,
]
ESDIRK5 = Tableau(
    name="ESDIRK5(4)8L[2]SA",
    source="Kennedy and Carpenter 2003, Appl. Numer. Math. 44, implicit part of ARK5(4)8L[2]SA",
    order=5,
    a=_lower(
        [
            [],
            [41 / 200],
            [41 / 400, -567603406766 / 11931857230679],
            [683785636431 / 9252920307686, 0.0, -110385047103 / 1367015193373],
            [
                3016520224154 / 10081342136671,
                0.0,
                30586259806659 / 12414158314087,
                -22760509404356 / 11113319521817,
            ],
            [
                218866479029 / 1489978393911,
                0.0,
                638256894668 / 5436446318841,
                -1179710474555 / 5321154724896,
                -60928119172 / 8023461067671,
            ],
            [
                1020004230633 / 5715676835656,
                0.0,
                25762820946817 / 25263940353407,
                -2161375909145 / 9755907335909,
                -211217309593 / 5846859502534,
                -4269925059573 / 7827059040749,
            ],
            _WEIGHTS,
        ],
        41 / 200,
    ),
    error_weights=np.array([*_WEIGHTS, 41 / 200]) - np.array(_EMBEDDED),
)
SDIRK4 = Tableau(
    name="SDIRK4(3)",
    source="Hairer and Wanner 1996, Solving ODEs II, table IV.6.5; here its five stages follow an unused one",
    order=4,
    a=_lower(
        [
            [],
            [0.0],
            [0.0, 1 / 2],
            [0.0, 17 / 50, -1 / 25],
            [0.0, 371 / 1360, -137 / 2720, 15 / 544],
            [0.0, 25 / 24, -49 / 48, 125 / 16, -85 / 12],
        ],
        1 / 4,
    ),
    error_weights=np.array([0.0, 25 / 24, -49 / 48, 125 / 16, -85 / 12, 1 / 4])
    - np.array([0.0, 59 / 48, -17 / 96, 225 / 32, -85 / 12, 0.0]),
)
"""It needs no acceleration to start from."""


def _ends_in_weights(a: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """An explicit method's coefficients with the end of the step as its last stage."""
    count = len(weights)
    whole = np.zeros((count + 1, count + 1))
    whole[:count, :count], whole[count, :count] = a[:count, :count], weights
    return whole


@cache
def dopri8() -> Tableau:
    """The method of order eight; its error estimate, by which steps are chosen, is that of order five."""
    from scipy.integrate import DOP853

    return Tableau(
        name="DOP853",
        source="Hairer, Norsett and Wanner 1993, Solving ODEs I, sec. II.5; the coefficients are SciPy's",
        order=6,
        a=_ends_in_weights(DOP853.A, DOP853.B),
        error_weights=DOP853.E5,
    )
