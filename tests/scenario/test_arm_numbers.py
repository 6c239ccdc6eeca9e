"""An arm described by its parts has the numbers that handbooks give for them."""

from math import pi
from typing import Any

import pytest

from continuum_dyn.scenario_files.arm_numbers import arm_numbers
from continuum_dyn.scenario_files.tables import ArmTable
from statics import InputError
from statics.arm import RONE2012
from statics.materials import MATERIALS


def numbers(**table: Any) -> dict[str, Any]:
    return arm_numbers(ArmTable.model_validate({"disks": 4, "disk_spacing": 0.02} | table))


def test_a_tube_is_a_rod_without_the_rod_inside_it() -> None:
    tube = numbers(core_outer_radius=2e-3, core_inner_radius=1.5e-3)
    rod, inside = (numbers(core_radius=radius) for radius in (2e-3, 1.5e-3))
    for name in ("area", "second_moment"):
        assert tube[name] == pytest.approx(rod[name] - inside[name])
    assert numbers(core_outer_radius=2e-3) == rod


def test_a_solid_disk_and_a_thin_ring_have_their_handbook_inertias() -> None:
    measures = {"disk_radius": 0.01, "disk_thickness": 0.002}
    disk = numbers(**measures, disk_density=1000.0)
    assert disk["disk_mass"] == pytest.approx(1000.0 * pi * 0.01**2 * 0.002)
    assert disk["disk_inertia"] == pytest.approx(disk["disk_mass"] * (3 * 0.01**2 + 0.002**2) / 12)
    ring = numbers(**measures | {"disk_thickness": 1e-9}, disk_inner_radius=0.01 * (1 - 1e-9), disk_mass=0.5)
    assert ring["disk_mass"] == 0.5
    assert ring["disk_inertia"] == pytest.approx(0.5 * 0.01**2 / 2)


def test_the_disks_of_the_paper_follow_from_their_measures() -> None:
    """Rone 2012, Table 1; scenarios/step_response_in_water.toml has the measures."""
    mass, inertia = RONE2012["disk_mass"], RONE2012["disk_inertia"]
    found = numbers(disk_radius=0.0095, disk_thickness=0.0065, disk_mass=mass)
    assert found["disk_inertia"] == pytest.approx(inertia, rel=0.01)


@pytest.mark.parametrize("name", MATERIALS)
def test_materials_set_modulus_and_densities_and_name_their_source(name: str) -> None:
    measures = {"disk_radius": 0.01, "disk_thickness": 0.002}
    found = numbers(core_material=name, disk_material=name, **measures)
    known = MATERIALS[name]
    assert (found["youngs_modulus"], found["core_density"]) == (known.youngs_modulus, known.density)
    assert found["disk_mass"] == numbers(disk_density=known.density, **measures)["disk_mass"]
    assert len(known.source) > 10


def test_length_with_disks_sets_their_spacing_and_with_spacing_their_count() -> None:
    assert arm_numbers(ArmTable(disks=8, length=0.1))["disk_spacing"] == 0.1 / 8
    assert arm_numbers(ArmTable(length=0.1, disk_spacing=0.02))["disks"] == 5
    assert numbers(length=0.08) == numbers()
    of_preset = arm_numbers(ArmTable(preset="rone2012", length=0.1))
    assert (of_preset["disks"], of_preset["disk_spacing"]) == (4, 0.025)
    assert arm_numbers(ArmTable(preset="rone2012", length=0.1, disk_spacing=0.02))["disks"] == 5


def test_lists_give_each_disk_its_own() -> None:
    found = numbers(core_outer_radius=[2e-3, 1e-3, 1e-3, 1e-3], core_inner_radius=5e-4)
    assert found["area"] == tuple(pi * (r**2 - 2.5e-7) for r in (2e-3, 1e-3, 1e-3, 1e-3))
    assert numbers(disk_radius=0.01, disk_thickness=[1e-3, 2e-3, 3e-3, 4e-3], disk_density=1e3)[
        "disk_mass"
    ] == pytest.approx([0.1 * pi * h for h in (1e-3, 2e-3, 3e-3, 4e-3)])


DISK = {"disk_radius": 0.01, "disk_thickness": 0.002}


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"length": 0.1}, "length = 0.1 m, but 4 disks with the given disk_spacing make 0.08 m"),
        ({"length": 0.1, "disk_spacing": [0.01, 0.02, 0.02, 0.02]}, "make 0.07 m"),
        ({"core_radius": 1e-3, "area": 1e-6}, "core_radius already sets area"),
        ({"core_outer_radius": 1e-3, "second_moment": 1e-13}, "core_outer_radius already sets second_moment"),
        ({"core_radius": 1e-3, "core_inner_radius": 5e-4}, "core_radius beside the radii of a tube"),
        ({"core_inner_radius": 5e-4}, "core_inner_radius without core_outer_radius"),
        ({"core_outer_radius": 5e-4, "core_inner_radius": 5e-4}, "core_inner_radius must be less than"),
        ({"core_material": "steel", "youngs_modulus": 2e11}, "core_material already sets youngs_modulus"),
        ({"core_material": "steel", "core_density": 7e3}, "core_material already sets core_density"),
        ({"core_material": "Nitinol"}, "core_material: unknown material 'Nitinol'. Did you mean 'nitinol'?"),
        ({"disk_material": "pla", "disk_density": 1e3, **DISK}, "disk_material already sets disk_density"),
        ({"disk_density": 1e3, "disk_mass": 1e-3, **DISK}, "disk_density already sets disk_mass"),
        ({"disk_inertia": 1e-8, "disk_mass": 1e-3, **DISK}, "disk_radius already sets disk_inertia"),
        ({"disk_density": 1e3}, "disk_density without disk_radius and disk_thickness"),
        (DISK, "disk_radius without what the disks weigh"),
        ({"disk_inner_radius": 0.02, "disk_mass": 1e-3, **DISK}, "disk_inner_radius must be less than"),
        (
            {"core_outer_radius": [2e-3] * 4, "core_inner_radius": [1e-3] * 3},
            "lists of different lengths: core_inner_radius, core_outer_radius",
        ),
    ],
)
def test_contradictions_are_refused_by_name(table: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=r"^\[arm\] ") as refused:
        numbers(**table)
    assert said in str(refused.value)
