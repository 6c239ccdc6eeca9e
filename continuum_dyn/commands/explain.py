"""``continuum-dyn explain``: the equations that a scenario simulates."""

from collections.abc import Callable
from textwrap import fill
from typing import Annotated, Any

import typer

from continuum_dyn.commands.terminal.arguments import Overrides, ScenarioFile
from continuum_dyn.commands.terminal.output import say
from continuum_dyn.commands.terminal.show import with_status
from statics.errors import InputError
from statics.quantities import QUANTITIES

ARM_NUMBERS = (
    *("disk_spacing", "youngs_modulus", "area", "second_moment"),
    *("core_density", "disk_mass", "disk_inertia", "reference_curvature"),
)
"""Numbers of an arm to show, in this order."""
_DISK_LETTERS = {
    "velocity_x": "v_x",
    "velocity_y": "v_y",
    "angular_velocity": "omega",
    "acceleration_x": "a_x",
    "acceleration_y": "a_y",
    "angular_acceleration": "alpha",
}


def explain(
    file: ScenarioFile,
    overrides: Overrides = None,
    latex: Annotated[bool, typer.Option("--latex", help="Equations as LaTeX.")] = False,
    measure: Annotated[bool, typer.Option("--measure", help="Measure what can be left out.")] = False,
) -> None:
    """Show what each effect adds, the modes at rest, and the equations.

    With --measure the motion is run without each effect in turn, to show which effects can be left out at
    the requested accuracy, and the time that they cost. The first time this compiles a scene for each effect,
    which takes some ten seconds in all.
    """
    from continuum_dyn.commands.terminal.effect_tables import (
        show_additions,
        show_modes,
        show_what_to_leave_out,
    )
    from continuum_dyn.scenario_files.reading import load_scenario

    scenario = load_scenario(file, overrides or ())
    scene = scenario.scene
    say(f"{scenario.title}\n")
    per_segment = len(scene.coordinates)
    say(
        f"{scene.arm.segments} segments, {per_segment * scene.arm.segments} coordinates: "
        f"{' and '.join(scene.coordinates)} of each segment.\n"
    )
    _print_numbers(scene)
    if scene.arm.base is not None:
        _print_base(scene.arm)
    say("Effects")
    width = max((len(effect.name) for effect in scene.effects), default=0)
    for effect in scene.effects:
        line = f"  {effect.name:<{width}} on each {effect.site:<8} {effect.source}"
        say(fill(line, 79, subsequent_indent=" " * (width + 20)))
    found = with_status(scenario.title, lambda progress: _modes(scenario, progress))
    show_additions(scenario, None if isinstance(found, InputError) else found)
    _print_method(scenario)
    if isinstance(found, InputError):
        say("\n" + fill(f"No modes: {found}", 79))
    else:
        show_modes(found)
    _print_equations(scene, latex)
    if measure:
        show_what_to_leave_out(scenario)
    else:
        say("\nTo measure which effects can be left out, add --measure.")


def _print_numbers(scene: Any) -> None:
    """Numbers of the arm and of its effects, in SI units, whatever the file describes them by."""
    arm = scene.arm
    known = [name for name in ARM_NUMBERS if arm.has(name)]
    numbers = {name: getattr(arm.each, name, None) or getattr(arm, name) for name in known}
    for effect in scene.effects:
        numbers |= {name: getattr(effect, name) for name in effect.quantities if hasattr(effect, name)}
    say(f"Numbers of {arm.disks} disks on {arm.total_length:g} m of core")
    for name, value in numbers.items():
        unit = QUANTITIES[name].unit
        shown = ", ".join(f"{each:.6g}" for each in (value if isinstance(value, tuple) else (value,)))
        say(fill(f"  {name} = {shown}" + (f" {unit}" if unit != "1" else ""), 79, subsequent_indent="    "))
    say()


def _print_base(arm: Any) -> None:
    x, y, angle = arm.base_pose
    where = f"at x = {x:g} m, y = {y:g} m, at an angle of {angle:g} rad"
    say(f"The base {'moves, and starts' if arm.base_moves else 'is'} {where}.\n")


def _modes(scenario: Any, progress: Callable[[str], None]) -> Any:
    """The modes at rest, or the reason why there are none."""
    from continuum_dyn.modes import modes_at_rest

    progress("modes at rest")
    try:
        return modes_at_rest(scenario)
    except InputError as reason:
        return reason


def _print_method(scenario: Any) -> None:
    from continuum_dyn.simulation import Motion

    if scenario.study.motion is None or not scenario.solver.chooses_method:
        return
    choice = with_status(scenario.title, lambda progress: _choose(Motion(scenario), progress))
    say("\n" + fill(f"Method {choice.method}: {choice.reason}.", 79))


def _choose(motion: Any, progress: Callable[[str], None]) -> Any:
    progress("choice of the method")
    return motion.choose_method()


def _derive(structure: Any, progress: Callable[[str], None]) -> Any:
    from continuum_dyn.equations.virtual_power import derive_dynamics

    progress("equations")
    return derive_dynamics(structure)


def _print_equations(scene: Any, latex: bool) -> None:
    from statics.derivation.virtual_work import collect

    structure = scene.structure
    forces = with_status("explain", lambda progress: _derive(structure, progress))
    write = _latex if latex else _text
    used: set[str] = set()
    say("\nOne segment: position of its far end relative to its near disk (Eq. 11)")
    for name, value in zip("xy", forces.segment.displacement, strict=True):
        say(write(name, value, used))
    for where, places, at in (
        ("segment", ("segment",), forces.segment),
        ("span, disk to disk", ("span",), forces.span or forces.segment),
        ("disk", ("disk", "mass"), forces.disk),
        *(("point of the core", ("mass",), point) for point in forces.core[:1]),
    ):
        groups = [(effect, pairs) for effect, pairs in collect(structure.forms, places, at) if pairs]
        if not groups:
            continue
        say(f"\nOne {where}: loads P and the displacements r they work along (Eq. 1)")
        for effect, pairs in groups:
            say(f"  {effect.name}")
            for pair in pairs:
                say(write("P", pair.load, used))
                say(write("r", pair.displacement, used))
    _print_cable_laws(forces.coupled, used)
    say("\nGeneralized forces of one segment, its own loads: Q = sum of P . dr'/du (Eq. 5)")
    for coordinate, value in zip(forces.segment.coordinates, forces.on_segment.force, strict=True):
        say(write(f"Q_{_letter(coordinate.name)}", value, used))
    say(
        "\nMotion: the sum of P . dr'/du over all of these is zero for each rate u; what"
        "\nacts beyond a segment reaches it through the chain. At rest: the same"
        "\nwith dr/dq."
    )
    _print_letters(used)


def _print_cable_laws(cables: Any, used: set[str]) -> None:
    """Equations of the tensions that couple all segments that a cable passes."""
    if not cables:
        return
    say("\nTensions along a cable; Lambda: its length from a hole to its anchor")
    for cable in cables:
        c = cable.number
        if cable.kind.driven_by_length:
            used |= {"cable_stiffness", "cable_rest_length", "cable_displacement", "length_beyond"}
            say(f"    tau_{c} = k_c_{c}*max(0, Lambda_{c} - Lambda_0_{c} + delta_{c}), at the base")
        if cable.kind.rubs:
            used |= {"friction", "slip_speed", "slip_length", "length_beyond"}
            say(f"    tension_lost_{c} = tau_{c} - T_{c}, where at each hole that turns it by beta")
            say(f"    T_{c} becomes T_{c}*exp(-mu_{c}*|beta|*tanh(s)), s = -Lambda_{c}'/v_s_{c}")
            say("    at rest s = (Lambda before - Lambda)/l_s")


def _print_letters(used: set[str]) -> None:
    say("\nSymbols")
    for name, quantity in QUANTITIES.items():
        if name in used and quantity.letter != name:
            say(_wrap(f"{quantity.letter:<4} {name} ({quantity.unit}): {quantity.meaning}"))
    say(_wrap("h    phi / 2"))
    say(_wrap("sigma_n(h) = j_n(h) / h^n, spherical Bessel functions: sigma_-1 = cos h, sigma_0 = sin(h)/h"))


def _wrap(text: str) -> str:
    return fill(text, 79, initial_indent="  ", subsequent_indent=" " * 7)


def _letter(name: str) -> str:
    if name in _DISK_LETTERS:
        return _DISK_LETTERS[name]
    stem, _, number = name.rpartition("_")
    if number.isdigit() and stem in QUANTITIES:
        return f"{QUANTITIES[stem].letter}_{number}"
    return QUANTITIES[name].letter if name in QUANTITIES else name


def _use_letters(value: Any, used: set[str], sigma: str) -> Any:
    """Expression with the usual symbols; ``sigma`` is the pattern for sigma_n(h), h = phi / 2."""
    import sympy as sp

    from statics.derivation.sigma import Sigma

    if isinstance(value, tuple):
        return tuple(_use_letters(part, used, sigma) for part in value)
    value = sp.sympify(value)
    used |= {s.name if s.name in QUANTITIES else s.name.rpartition("_")[0] for s in value.free_symbols}
    calls = {call: sp.Symbol(sigma.format(n=call.args[0])) for call in value.atoms(Sigma)}
    letters = {s: sp.Symbol(_letter(s.name)) for s in value.free_symbols}
    return value.xreplace(calls).xreplace(letters)


def _text(name: str, value: Any, used: set[str]) -> str:
    from sympy import sstr

    expression = sstr(_use_letters(value, used, "sigma_{n}(h)"))
    return fill(f"{name} = {expression}", 79, initial_indent="    ", subsequent_indent=" " * 8)


def _latex(name: str, value: Any, used: set[str]) -> str:
    import sympy as sp

    rates = {sp.Symbol("phi'"): r"\dot{\phi}", sp.Symbol("e'"): r"\dot{e}"}
    expression = sp.latex(_use_letters(value, used, r"\sigma_{{{n}}}(h)"), symbol_names=rates)
    return f"    {sp.latex(sp.Symbol(name))} = {expression}"
