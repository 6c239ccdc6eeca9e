"""The glossary: every quantity's name, unit and meaning.

One word for one thing, in scenario files, sympy symbols, generated kernels, HDF5 files and plots.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """A named physical quantity; ``unit`` is SI, "1" if there is none.

    ``letter`` stands for it in printed equations; it is the name itself if there is no customary one.
    """

    name: str
    letter: str
    unit: str
    meaning: str

    @property
    def label(self) -> str:
        """Axis label for plots, e.g. "bend angle (rad)"."""
        words = self.name.replace("_", " ")
        return words if self.unit == "1" else f"{words} ({self.unit})"


_TABLE = """
disks                | n     | 1      | number of disks
disk_spacing         | -     | m      | undeformed distance between neighbouring disks, along the core
youngs_modulus       | E     | Pa     | Young's modulus E of the core
core_radius          | -     | m      | radius of a round core; sets area and second_moment
core_outer_radius    | -     | m      | outer radius of a tube that is the core; sets area and second_moment
core_inner_radius    | -     | m      | inner radius of that tube
core_material        | -     | 1      | material of the core; sets youngs_modulus and core_density
area                 | A     | m^2    | cross-section area A of the core
second_moment        | J     | m^4    | second moment of area J of the core about the bending axis
disk_mass            | -     | kg     | mass of a disk, with the core around it unless core_density is given
disk_inertia         | -     | kg m^2 | moment of inertia of a disk about an in-plane diameter
disk_radius          | -     | m      | radius of a disk; sets its inertia, and its mass with disk_density
disk_inner_radius    | -     | m      | radius of a disk's central hole
disk_thickness       | -     | m      | thickness of a disk, along the core
disk_density         | -     | kg/m^3 | density of a disk
disk_material        | -     | 1      | material of the disks; sets disk_density
core_density         | -     | kg/m^3 | density of the core, which then has its own distributed mass
subsegments          | -     | 1      | number of segments from disk to disk
reference_curvature  | k_0   | 1/m    | curvature of the unloaded core

mass                 | -     | kg     | mass of a payload
inertia              | -     | kg m^2 | moment of inertia of a payload about its own centre
offset               | -     | m      | payload's centre from the disk's: along the core, along the disk
payload_mass         | m_p   | kg     | mass of a disk's payload
payload_inertia      | I_p   | kg m^2 | moment of inertia of a disk's payload about its own centre
payload_offset_x     | d_x   | m      | payload's centre from the disk's, along the core's tangent
payload_offset_y     | d_y   | m      | payload's centre from the disk's, along the disk's y axis

x                    | -     | m      | x of the base
y                    | -     | m      | y of the base
angle                | -     | rad    | direction of the core at the base, relative to the x axis
base_x               | x_b   | m      | x of the base
base_y               | y_b   | m      | y of the base
base_theta           | theta_b | rad  | angle of the base's normal relative to the x axis
base_velocity_x      | v_bx  | m/s    | velocity of the base along x
base_velocity_y      | v_by  | m/s    | velocity of the base along y
base_angular_velocity | omega_b | rad/s | angular velocity of the base
base_acceleration_x  | a_bx  | m/s^2  | acceleration of the base along x
base_acceleration_y  | a_by  | m/s^2  | acceleration of the base along y
base_angular_acceleration | alpha_b | rad/s^2 | angular acceleration of the base

rest_length          | L_0   | m      | undeformed length L0 of a segment
node_mass            | m     | kg     | mass at a segment's end: the disk's, if any, and the core's share
core_point_mass      | m_c   | kg     | mass of the core at either of two points along a segment
node_inertia         | I     | kg m^2 | moment of inertia at a segment's end
span_start           | -     | 1      | 1 on segments that start at a disk or the base
bending_stiffness    | EJ    | N m^2  | E J of the core
axial_stiffness      | EA    | N      | E A of the core
hole_offset          | r     | m      | position of a cable's hole along the disk's y axis
near_hole_offset     | r'    | m      | hole offset of the same cable at the disk before
hole                 | -     | 1      | number of the disk that a hole is in, 0 for the base
anchor               | -     | 1      | number of the disk where a cable ends
start                | -     | 1      | number of the disk where a cable leaves its sheath, 0 for the base
cable_passes         | b     | 1      | 1 on segments whose end has a hole of a bare cable, 0 elsewhere
tension              | tau   | N      | tension of a cable
cable_length         | l     | m      | length of a cable from hole to hole
cable_displacement   | delta | m      | length of a cable drawn in at the base, against the unloaded arm
cable_displacement_rate | delta' | m/s | speed at which a cable is drawn in at the base
cable_stiffness      | k_c   | N/m    | tension of a length-driven cable over its stretch
cable_rest_length    | Lambda_0 | m   | length of a cable from first hole to anchor in the unloaded arm
friction             | mu    | 1      | coefficient of friction of a cable at its holes
slip_speed           | v_s   | m/s    | slip speed at which friction is three quarters of its maximum
slip_length          | l_s   | m      | slip from rest at which friction is three quarters of its maximum
length_beyond        | Lambda | m     | length of a cable from a hole to its anchor
length_before        | Lambda' | m    | length beyond in the equilibrium that the arm comes from
tension_lost         | -     | N      | tension of a cable lost to friction between the base and here
acceleration         | -     | m/s^2  | acceleration of gravity, a vector in the plane
gravity_x            | g_x   | m/s^2  | acceleration of gravity along x
gravity_y            | g_y   | m/s^2  | acceleration of gravity along y
force                | -     | N      | force on a disk, a vector; in the disk's axes if it follows
follower             | -     | 1      | whether a force turns with its disk
moment               | -     | N m    | moment on a disk, positive counter-clockwise
load_force_x         | F_x   | N      | sum of the dead forces on a disk, along x
load_force_y         | F_y   | N      | sum of the dead forces on a disk, along y
load_moment          | M     | N m    | sum of the moments on a disk
follower_force_x     | F_t   | N      | sum of the follower forces on a disk, along the core's tangent there
follower_force_y     | F_n   | N      | sum of the follower forces on a disk, along the disk's y axis
load_factor          | f     | 1      | factor on a load that changes in time
factor               | f     | 1      | factor on a load that changes in time
driven_force_x       | F_x   | N      | force under a load factor, along x; of a follower, along the core
driven_force_y       | F_y   | N      | force under a load factor, along y; of a follower, along the disk
driven_moment        | M     | N m    | moment under a load factor
load                 | -     | 1      | number of a load that changes in time
retardation_time     | t_r   | s      | Kelvin-Voigt viscosity over Young's modulus, eta / E
mass_damping_rate    | alpha_m | 1/s  | damping force over mass and speed (Rayleigh's alpha)
drag_per_speed       | c     | N s/m  | linear drag on a disk over its speed
rotary_drag_per_speed | c_r  | N m s  | moment of linear drag over angular speed
drag_per_speed_squared | c_2 | N s^2/m^2 | quadratic drag on a disk over its speed squared
rotary_drag_per_speed_squared | c_r2 | N m s^2 | moment of quadratic drag over angular speed squared

time                 | -     | s      | time
segment              | -     | 1      | number of a segment, from the base
disk                 | -     | 1      | number of a disk, from the base
cable                | -     | 1      | name of a cable
point                | -     | 1      | number of an equilibrium in its sequence
bend_angle           | phi   | rad    | angle between the two ends of a segment, curvature times length
elongation           | e     | m      | length of a segment less its undeformed length
bend_angle_rate      | phi'  | rad/s  | time derivative of the bend angle
elongation_rate      | e'    | m/s    | time derivative of the elongation
curvature            | k     | 1/m    | curvature k of a segment
length               | L     | m      | length L of a segment
disk_x               | -     | m      | x of a disk's centre
disk_y               | -     | m      | y of a disk's centre
disk_theta           | -     | rad    | angle of a disk's normal relative to the x axis
stable               | -     | 1      | 1 if the equilibrium is stable
unstable_directions  | -     | 1      | number of independent directions in which an equilibrium is unstable
critical             | -     | 1      | 1 at a fold of a path of equilibria, 2 at a branching, else 0
jumped               | -     | 1      | 1 if no path of stable equilibria leads here from a ramp's last one
residual             | -     | N      | largest unbalanced generalized force, N or N m
kinetic_energy       | -     | J      | kinetic energy of the masses
elastic_energy       | -     | J      | energy stored in elastic parts, such as the core and stretched cables
gravity_energy       | -     | J      | potential energy of the masses, zero at the origin
input_power          | -     | W      | power of cables, of loads on disks and of a moving base
dissipated_power     | -     | W      | power lost to damping and friction
input_work           | -     | J      | time integral of the input power since the start
mode                 | -     | 1      | number of a mode of small motion, the lowest first
frequency            | f     | Hz     | undamped frequency of a mode
damping_ratio        | zeta  | 1      | mean decay rate of a mode over 2 pi times its frequency
decay_rate           | -     | 1/s    | rate at which a mode dies away in the long run
fast_decay_rate      | -     | 1/s    | rate of the other exponential of an overdamped mode
shape_x              | -     | 1      | displacement of a disk in a mode, along x, over the largest
shape_y              | -     | 1      | displacement of a disk in a mode, along y, over the largest
shape_theta          | -     | rad/m  | rotation of a disk in a mode, over the largest displacement
price                | -     | 1      | number of a setting in a table of costs
method               | -     | 1      | name of an integrator
rtol                 | -     | 1      | relative tolerance of an integrator
step                 | h     | s      | step of an integrator with equal steps
step_size            | -     | s      | integration step that contains a sample, zero if it has none
tip_error            | -     | m      | largest distance of the tip from its exact position, over the samples
angle_error          | -     | rad    | error of the angle of the tip
solve_time           | -     | s      | time of the solving
steps                | -     | 1      | number of accepted integration steps
segment_evaluations  | -     | 1      | work: one segment's part of an evaluation of the equations
dissipated_energy    | -     | J      | time integral of the dissipated power since the start
travel               | -     | m      | distance of the tip from rest at the last change of the inputs
rise_time            | -     | s      | time from 10 % of the travel, first reached, to 90 %
overshoot            | -     | 1      | largest distance of the tip beyond its rest position, over the travel
settling_time_5      | -     | s      | time after which the tip stays within 5 % of its travel from rest
settling_time_2      | -     | s      | time after which the tip stays within 2 % of its travel from rest
settling_time_1      | -     | s      | time after which the tip stays within 1 % of its travel from rest
ramp_rate            | -     | N/s    | largest rate of a ramped tension; m/s of a cable, 1/s of a load factor
tip_lag              | -     | m      | largest distance of the tip from its equilibrium under the same inputs
delay                | -     | s      | delay of the tip on its static path
quasistatic_error    | -     | m      | largest lag with which a ramp still counts as quasistatic
quasistatic_rate     | -     | N/s    | ramp rate at which the lag reaches that error, if proportional
measured_quasistatic_rate | - | N/s  | ramp rate at which the lag reaches that error, measured by runs
hysteresis_area      | -     | J      | work of the cables once around the hysteresis loop, in motion
tip_hysteresis       | -     | m      | largest tip distance of two branches at the same input, in motion
static_hysteresis_area | -   | J      | work of the cables once around the hysteresis loop, at rest
static_tip_hysteresis | -    | m      | largest tip distance of two branches at the same input, at rest
ring_down_misfit     | -     | 1      | part of a ring-down that its fitted damped sinusoid does not explain
mode_frequency       | -     | Hz     | frequency of the mode nearest to a ring-down's frequency
mode_damping_ratio   | -     | 1      | damping ratio of that mode
static_gap           | -     | m      | distance of the tip at the end from its rest position
"""

QUANTITIES: dict[str, Quantity] = {
    name: Quantity(name, name if letter == "-" else letter, unit, meaning)
    for name, letter, unit, meaning in (
        (cell.strip() for cell in line.split("|")) for line in _TABLE.splitlines() if line.strip()
    )
}
