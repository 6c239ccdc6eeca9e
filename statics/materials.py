"""Materials by name: Young's modulus and density, each with where the figures are from.

Figures are typical ones at room temperature. A wire, a print or a casting of one's own differs: by a few
percent for metals, by tens of percent for plastics and rubbers. Measured numbers are better.
"""

from typing import NamedTuple

from statics.errors import InputError, did_you_mean


class Material(NamedTuple):
    """Young's modulus (Pa) and density (kg/m^3) of a material, and their source."""

    youngs_modulus: float
    density: float
    source: str


MATERIALS = {
    "steel": Material(
        2.10e11, 7850.0, "EN 1993-1-1:2005, 3.2.6; density: EN 1991-1-1:2002, Table A.4, 77.0 kN/m^3"
    ),
    "stainless_steel": Material(2.00e11, 7900.0, "EN 10088-1, physical properties of 1.4301 (AISI 304)"),
    "aluminium": Material(7.0e10, 2700.0, "EN 1999-1-1:2007, 3.2.5"),
    "nitinol": Material(
        8.3e10, 6450.0, "austenite, below some 1 % of strain: Selected Properties of NiTi, SMA Inc. (2003)"
    ),
    "peek": Material(4.0e9, 1300.0, "Victrex PEEK 450G data sheet, ISO 527 at 23 C and ISO 1183"),
    "pla": Material(3.6e9, 1240.0, "NatureWorks Ingeo 4043D data sheet, ASTM D882 and D792, before printing"),
    "pa12": Material(1.65e9, 930.0, "EOS PA 2200 data sheet, laser-sintered, ISO 527"),
    "silicone": Material(
        5.9e5, 1080.0, "Smooth-On Dragon Skin 30 bulletin, stress at 100 % of strain (86 psi), ASTM D412"
    ),
}


def material(name: str) -> Material:
    """The material with that name. Raises ``InputError`` for an unknown one, with the nearest."""
    if name not in MATERIALS:
        raise InputError(f"unknown material '{name}'.{did_you_mean(name.lower(), MATERIALS)}")
    return MATERIALS[name]
