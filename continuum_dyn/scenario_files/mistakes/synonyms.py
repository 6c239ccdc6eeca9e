"""Words that people write in scenario files, and the key that each stands for."""

SYNONYMS: dict[str, dict[str, str]] = {
    "": {
        "[[cables]]": "cable tendon tendons wire wires string strings actuator actuators",
        "[[loads]]": "load force forces",
        "[[payloads]]": "payload mass masses",
        "[arm]": "robot body geometry backbone rod manipulator continuum",
        "[effects]": "effect physics model",
        "[study]": "simulation analysis experiment task run",
        "[solver]": "integrator numerics settings",
        "[accuracy]": "tolerance precision",
        "[base]": "mount pose",
        "title": "name description",
        "duration in [study]": "duration time",
        "gravity = { acceleration = [0.0, -9.81] } in [effects]": "g gravity",
        "material_damping = { retardation_time = ... } in [effects]": "damping",
    },
    "arm": {
        "disks": "n number count n_disks num_disks number_of_disks segments sections",
        "disk_spacing (m), the distance between two disks": "spacing pitch distance l0 segment_length",
        "length (m)": "l total_length arm_length",
        "core_radius (m), or core_outer_radius of a tube: half the diameter": "diameter d core_diameter",
        "core_outer_radius (m) of a tube": "od outer_diameter outer_radius",
        "core_inner_radius (m) of a tube": "id inner_diameter inner_radius bore",
        "core_radius (m)": "radius r rod_radius backbone_radius",
        "youngs_modulus (Pa)": "e modulus young youngs elastic_modulus elasticity stiffness",
        "core_material": "material",
        "core_outer_radius and core_inner_radius (m)": "tube wall wall_thickness",
        "disk_radius (m), half the diameter": "disk_diameter",
        "disk_thickness (m)": "thickness disk_height",
        "youngs_modulus (Pa) and second_moment (m^4), whose product it is": "ei ej bending_stiffness",
        "area (m^2)": "a cross_section",
        "second_moment (m^4)": "i j ixx jxx moment_of_area",
        "disk_mass (kg)": "mass m",
        "disk_inertia (kg m^2)": "inertia moment_of_inertia",
        "core_density (kg/m^3)": "density rho",
        "reference_curvature (1/m)": "curvature kappa precurvature",
        "gravity = { acceleration = [0.0, -9.81] } in [effects]": "g gravity",
        "material_damping = { retardation_time = ... } in [effects]": "damping viscosity",
        "hole_offset (m) of [[cables]]": "hole_offset hole_radius",
        "a table [[cables]] for each": "cables tendons",
    },
    "effects": {
        "gravity": "g weight",
        "bending": "elasticity stiffness flexure",
        "extension": "axial stretch stretching compression",
        "inertia": "mass dynamics",
        "material_damping, mass_damping or linear_drag": "damping viscosity",
        "linear_drag or quadratic_drag": "drag fluid water",
        "friction of [[cables]]": "friction cable_friction",
        "a table [[cables]] for each; they need no effect": "cable cables tendons",
        "a table [[loads]] for each; they need no effect": "load loads force forces",
    },
    "effects.gravity": {"acceleration = [0.0, -9.81]": "g value magnitude direction vector"},
    "effects.material_damping": {
        "retardation_time (s)": "eta viscosity tau time coefficient value",
        "damping_ratio": "zeta damping ratio",
    },
    "cables": {
        "hole_offset (m)": "offset radius r d y distance hole_radius position hole eccentricity",
        "tension (N)": "force pull load f t tau",
        "cable_displacement (m)": "displacement length pulled stroke delta",
        "cable_stiffness (N/m)": "stiffness k ea",
        "friction": "mu friction_coefficient",
        "start": "from begin first_disk sheath",
        "anchor": "end disk last_disk termination",
    },
    "loads": {
        "force = [x, y] (N)": "f fx fy value",
        "moment (N m)": "m torque couple",
        "disk": "position node at location",
        "factor": "profile scale load_factor",
    },
    "payloads": {"mass (kg)": "m weight", "disk": "position node at", "inertia (kg m^2)": "i"},
    "base": {"angle (rad)": "theta rotation orientation"},
    "study": {
        "kind": "type name study",
        "duration (s)": "time t t_end tend t_final end length",
        "samples": "dt n points steps rate sample_rate frames",
        "settled_within (m)": "tolerance settled",
        "tension of [[cables]]": "tension tensions",
    },
    "solver": {
        "rtol": "tol tolerance rel_tol reltol relative_tolerance",
        "atol": "abs_tol abstol absolute_tolerance",
        "method": "integrator type name solver",
        "step (s)": "dt h time_step timestep step_size",
        "max_seconds (s)": "timeout max_time",
    },
    "accuracy": {"tip (m)": "tol tolerance error value"},
    "kinds": {
        "equilibrium": "static statics rest",
        "ramp": "sweep path quasistatic",
        "motion": "dynamic dynamics transient simulation",
        "step_response": "step settle settling",
    },
    "profiles": {
        "constant": "fixed hold",
        "ramp": "linear",
        "smooth_ramp": "smooth cosine s_curve",
        "sine": "sin sinusoid sinusoidal harmonic cos",
        "table": "csv file data",
    },
    "profile": {
        "profile": "type kind",
        "before": "from initial start_value v0",
        "after": "to final end_value target v1",
        "at (s)": "time t t0 delay",
        "frequency (Hz)": "freq f omega",
        "amplitude": "amp a",
        "mean": "offset bias",
        "file": "filename path csv",
    },
}
"""Words by what to write in their place, for each table of a file; "" is the top of it.

"kinds" are those of [study], "profiles" those of a drive, and "profile" has the keys of all of these.
"""


def meant_by(word: str, table: str) -> str:
    """The key meant by a word in a table such as "arm" or "study.ramp"; empty if it is not known."""
    for name in (table, table.partition(".")[0]):
        for instead, words in SYNONYMS.get(name, {}).items():
            if word.lower() in words.split():
                return instead
    return ""
