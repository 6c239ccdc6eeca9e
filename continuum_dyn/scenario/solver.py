"""The integrator of a motion, its tolerances and its budgets."""

from dataclasses import replace
from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass

from statics.errors import InputError
from statics.support.checked import STRICT, Positive

Method = Literal["auto", "chain", "explicit", "midpoint", "RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA"]
FIXED_STEP: tuple[Method, ...] = ("midpoint",)
"""Methods that take steps of equal size: they have a ``step`` in place of tolerances."""


@dataclass(frozen=True, config=STRICT)
class Solver:
    """Integrator and its local error tolerances.

    "chain" is the arm's own implicit method and "explicit" its like for motions that are not stiff: a step's
    error may displace no node by more than ``rtol`` + ``atol`` times the arm's length. "midpoint" keeps the
    energy of a scene without damping; it has no tolerances but a ``step`` (s), by default a twentieth of the
    shortest period of the arm at the start or of its drive. "auto" decides between them by the motion's own
    modes. For SciPy's methods ``rtol`` is relative and ``atol`` in rad for bend angles; elongations use it
    times the segment's rest length, rates the same times the arm's natural frequency, energies times its
    bending stiffness over that length. ``max_steps`` bounds what a motion may cost,
    ``max_seconds`` what a motion or a ramp may.
    """

    method: Method = "auto"
    rtol: Annotated[float, Field(ge=1e-14, lt=1)] = 1e-7
    atol: Annotated[Positive, Field(description="absolute tolerance of an integrator")] = 1e-9
    step: Positive | None = None
    max_steps: Annotated[int, Field(ge=1, description="largest number of steps of a motion")] = 10_000_000
    max_seconds: Annotated[Positive, Field(description="longest computing time of a motion or a ramp, s")] = (
        3600.0
    )

    def __post_init__(self) -> None:
        if self.step is not None and not self.has_fixed_step:
            raise InputError(
                f'[solver] step belongs to method = "midpoint"; "{self.method}" chooses its steps by rtol '
                "and atol. Give those, or that method."
            )

    @property
    def chooses_method(self) -> bool:
        """Whether the program chooses the method."""
        return self.method == "auto"

    @property
    def has_fixed_step(self) -> bool:
        """Whether the method takes a ``step``; otherwise it has tolerances."""
        return self.method in FIXED_STEP

    def tolerance(self, length: float) -> float:
        """Largest displacement (m) of any node by the error of one step, in an arm of that length (m)."""
        return (self.rtol + self.atol) * length

    def with_rtol(self, rtol: float) -> "Solver":
        """These settings with another relative tolerance, and an absolute one in proportion."""
        return replace(self, rtol=rtol, atol=1e-3 * rtol)

    @property
    def settings(self) -> dict[str, str | float]:
        """The method with its tolerances or its step, by name."""
        if self.has_fixed_step:
            return {"method": self.method} | ({} if self.step is None else {"step": self.step})
        return {"method": self.method, "rtol": self.rtol, "atol": self.atol}


@dataclass(frozen=True, config=STRICT)
class Accuracy:
    """Largest distance of the tip from the exact motion of the same segments.

    The program chooses the tolerances, and checks. If it chooses the segments, too, the error is measured
    against the continuous arm.
    """

    tip: Annotated[Positive, Field(description="largest error of the tip over the samples, m")]
