"""The integrator of a motion, its tolerances and its budgets."""

from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass

from statics.checked import STRICT, Positive
from statics.errors import InputError

Method = Literal["auto", "chain", "explicit", "midpoint", "RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA"]


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
    max_steps: Annotated[int, Field(ge=1, description="most steps that a motion may take")] = 10_000_000
    max_seconds: Annotated[
        Positive, Field(description="longest time that a motion may take to compute, s")
    ] = 3600.0

    def __post_init__(self) -> None:
        if self.step is not None and self.method != "midpoint":
            raise InputError(
                f'[solver] step belongs to method = "midpoint"; "{self.method}" chooses its steps by rtol '
                "and atol. Give those, or that method."
            )

    @property
    def settings(self) -> dict[str, str | float]:
        """The method and what it goes by, by name."""
        if self.method == "midpoint":
            return {"method": self.method} | ({} if self.step is None else {"step": self.step})
        return {"method": self.method, "rtol": self.rtol, "atol": self.atol}


@dataclass(frozen=True, config=STRICT)
class Accuracy:
    """Largest error of the tip against the exact motion of the same segments.

    The program chooses the tolerances, and checks. If it chooses the segments, too, the error is that
    against the continuous arm.
    """

    tip: Annotated[Positive, Field(description="largest error of the tip over the samples, m")]
