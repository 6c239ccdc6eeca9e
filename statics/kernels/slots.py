"""Numbers that a pass is given or returns, each at a slot of its name in one array, ``scalars``."""

SLOTS = {
    name: slot
    for slot, name in enumerate(
        (
            "damping_weight",
            "stiffness_weight",
            "slowing",
            "keep_sign",
            "negative_pivots",
            "potential",
            "potential_scale",
            "clearance",
            "force_x",
            "force_y",
            "torque",
            "largest",
            "kinetic_energy",
            "elastic_energy",
            "gravity_energy",
            "input_power",
            "dissipated_power",
            "transport_energy",
            "input_power_change",
            "dissipated_power_change",
        )
    )
}
"""The place of everything that a pass is given or returns."""

SCALARS = len(SLOTS)
DAMPING_WEIGHT, STIFFNESS_WEIGHT = SLOTS["damping_weight"], SLOTS["stiffness_weight"]
SLOWING, KEEP_SIGN = SLOTS["slowing"], SLOTS["keep_sign"]
NEGATIVE_PIVOTS, CLEARANCE = SLOTS["negative_pivots"], SLOTS["clearance"]
POTENTIAL, POTENTIAL_SCALE = SLOTS["potential"], SLOTS["potential_scale"]
WRENCH = SLOTS["force_x"]
"""Force x, y and torque of the base on the arm stand here, one after the other."""
LARGEST = SLOTS["largest"]
LEDGER = SLOTS["kinetic_energy"]
"""Energies and powers stand here, one after the other."""
ELASTIC_ENERGY, GRAVITY_ENERGY = SLOTS["elastic_energy"], SLOTS["gravity_energy"]
INPUT_POWER, DISSIPATED_POWER = SLOTS["input_power"], SLOTS["dissipated_power"]
INPUT_POWER_CHANGE = SLOTS["input_power_change"]
DISSIPATED_POWER_CHANGE = SLOTS["dissipated_power_change"]
