"""Operations of the generated steps: counted in their text, and what of them goes with an effect."""

import ast

from conftest import moving, rone2012

from continuum_dyn.equations.operations import added_by_each, count, operations


def test_arithmetic_and_calls_count_and_numbers_do_not() -> None:
    text = "def step(i, carried, q):\n    y = (1/2)*q[i, 0] - carried**2\n    return (y, -3/4, sin(y))\n"
    assert count(ast.parse(text)) == 4  # *, -, ** and the call


def test_gravity_is_two_products_and_two_sums_a_segment() -> None:
    assert added_by_each(moving(rone2012()))["gravity"] == 4


def test_every_effect_but_inertia_has_its_operations() -> None:
    scene = moving(rone2012())
    added = added_by_each(scene)
    assert added.pop("inertia") is None
    assert set(added) == {effect.name for effect in scene.effects} - {"inertia"}
    assert all(number is not None and number > 0 for number in added.values())
    assert max(added, key=lambda name: added[name] or 0) == "extension"  # a second coordinate


def test_scene_at_rest_has_fewer_operations_than_in_motion() -> None:
    assert operations(rone2012()) < operations(moving(rone2012()))
