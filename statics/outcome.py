"""Outcomes of a computation: one enumeration for logs, JSON and exit statuses."""

from enum import StrEnum


class Outcome(StrEnum):
    """The named endings; the text is what logs and JSON carry."""

    COMPLETED = "completed"
    SETTLED = "settled"
    NOT_SETTLED = "not_settled"
    UNSTABLE_EQUILIBRIUM = "unstable_equilibrium"
    NO_EQUILIBRIUM = "no_equilibrium"
    GEOMETRY_LIMIT = "geometry_limit"
    DIVERGED = "diverged"
    BUDGET_EXCEEDED = "budget_exceeded"
    INTERRUPTED = "interrupted"

    @property
    def answered(self) -> bool:
        """Whether the question was answered: "not settled" is an answer, too."""
        return self in (Outcome.COMPLETED, Outcome.SETTLED, Outcome.NOT_SETTLED)

    @property
    def exit_status(self) -> int:
        """0 answered, 1 not answered, 130 interrupted."""
        if self is Outcome.INTERRUPTED:
            return 130
        return 0 if self.answered else 1
