"""Tables of the command ``explain``: the cost of each effect, and effects that could be left out."""

from math import inf
from textwrap import fill
from typing import TYPE_CHECKING

from continuum_dyn.commands.terminal.output import console, say
from continuum_dyn.commands.terminal.show import duration, length, mode_row, plain_table, with_status

if TYPE_CHECKING:
    from collections.abc import Callable

    from continuum_dyn.experiments.cost import LeftOut
    from continuum_dyn.modes import RestModes
    from continuum_dyn.scenario.scenario import Scenario

LOWEST = 3
"""Largest number of modes shown."""


def show_additions(scenario: "Scenario", found: "RestModes | None") -> None:
    """Print the operations that each effect adds to a segment, and its rates about rest."""
    from continuum_dyn.equations.operations import operations

    scene = scenario.scene
    columns = ("What each adds to a segment", "coordinate", "operations")
    shown = plain_table("", *columns, *([] if found is None else ["rates (1/s) without it"]))
    added, rates_of = with_status(scenario.title, lambda progress: _measure(scenario, found, progress))
    for effect in scene.effects:
        count = added[effect.name]
        rates = rates_of[effect.name]
        operated = "" if count is None else str(count)
        shown.add_row(f"  {effect.name}", ", ".join(effect.coordinates), operated, *rates)
    rates = [] if found is None else [_range(found.rates)]
    shown.add_row("  all of them", str(len(scene.coordinates)), str(operations(scene)), *rates)
    say()
    console().print(shown)
    say("  Operations: arithmetic of one evaluation that is saved without the effect.")


def _measure(
    scenario: "Scenario", found: "RestModes | None", progress: "Callable[[str], None]"
) -> tuple[dict[str, int | None], dict[str, list[str]]]:
    """Operations that each effect adds, and the rates of the motion without it."""
    from continuum_dyn.equations.operations import added_by_each

    progress("what each effect adds")
    added, rates_of = added_by_each(scenario.scene), {}
    for effect in scenario.scene.effects:
        progress(f"rates without {effect.name}")
        rates_of[effect.name] = [] if found is None else [_rates(scenario, effect.name)]
    return added, rates_of


def _rates(scenario: "Scenario", effect: str) -> str:
    from continuum_dyn.modes import FEW_COORDINATES, rates_without

    if effect == "inertia":
        return "no motion"
    if len(scenario.scene.coordinates) * scenario.scene.arm.segments > FEW_COORDINATES:
        return "see --measure"
    rates = rates_without(scenario, effect)
    return "not stable at rest" if rates is None else _range(rates)


def _range(rates: tuple[float, float]) -> str:
    return f"{rates[0]:.3g} to {rates[1]:.3g}"


def show_modes(found: "RestModes") -> None:
    """The lowest modes of the arm at rest."""
    shown = plain_table("", "Modes at rest", "frequency", "damping ratio", "falls to 1/e in")
    for number, mode in enumerate(found.modes[:LOWEST], start=1):
        shown.add_row(f"  {number}", *mode_row(mode))
    say()
    console().print(shown)
    others = len(found.modes) - LOWEST
    more = f"and {others} more, up to {found.modes[-1].frequency:.5g} Hz; " if others > 0 else ""
    say(f"  {more}shapes: continuum-dyn modes FILE")


def show_what_to_leave_out(scenario: "Scenario") -> None:
    """Effects that move the tip by less than the requested accuracy, measured by leaving each out in turn."""
    from continuum_dyn.experiments.cost import effects, prepare_motion

    allowed, said = _allowed(scenario)
    measured = with_status(scenario.title, lambda progress: effects(prepare_motion(scenario), progress))
    columns = ("tip moves by", "time it costs", "fastest rate", f"below {length(allowed)}")
    shown = plain_table("", "Left out", *columns)
    for effect in sorted(measured, key=lambda e: inf if e.tip_shift is None else e.tip_shift):
        shown.add_row(f"  {effect.name}", *_row(effect, allowed))
    say()
    console().print(shown)
    useless = [e.name for e in measured if e.tip_shift is not None and e.tip_shift < allowed]
    advice = f"Can be left out: {', '.join(useless)}" if useless else "Nothing can be left out"
    say("\n" + fill(f"{advice}. Allowed: {length(allowed)}, {said}. Each was left out alone.", 79))


def _row(effect: "LeftOut", allowed: float) -> tuple[str, ...]:
    if effect.tip_shift is None or effect.seconds is None or effect.time_ratio is None:
        return ("no motion",)
    costs = f"{duration(effect.seconds)}, {1.0 - effect.time_ratio:.0%}" if effect.seconds > 0.0 else "none"
    below = "yes" if effect.tip_shift < allowed else "no"
    return length(effect.tip_shift), costs, f"{effect.fastest_rate:.3g} 1/s", below


def _allowed(scenario: "Scenario") -> tuple[float, str]:
    """Largest allowed tip error, m, and the key that sets it."""
    if scenario.accuracy is not None:
        return scenario.accuracy.tip, "[accuracy] tip"
    if getattr(scenario.study, "settled_within", None) is not None:
        return scenario.settled_within, "the study's settled_within"
    return scenario.settled_within, "a thousandth of the arm's length, as no [accuracy] is given"
