"""``continuum-dyn reproduce``: recompute the results of a paper."""

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from continuum_dyn.commands.terminal.arguments import Folder
from continuum_dyn.commands.terminal.output import console, say
from continuum_dyn.commands.terminal.show import make_folder, plain_table, with_status
from statics.support.interruption import defer_interruption

if TYPE_CHECKING:
    import numpy as np

    from continuum_dyn.experiments.reproduce import Rone2012, Shapes
    from statics.equilibria import Equilibrium


def reproduce(
    paper: Annotated[str, typer.Argument(metavar="PAPER", help="The paper: rone2012.", show_default=False)],
    out: Folder = Path("logs"),
) -> None:
    """Recompute the results of a paper.

    rone2012: its Table 2, Fig. 3 and Fig. 4, by the equations as printed, by the program, and by an exact
    rod between the disks as reference for both. Writes DIR/PAPER_table_2.csv, PAPER_shapes.csv and PAPER.png.
    """
    from continuum_dyn.experiments.reproduce import reproduce as compute
    from continuum_dyn.views.figures import plots

    found = with_status(paper, lambda progress: compute(paper, progress))
    make_folder(out)
    with defer_interruption():
        _write_table_2(found, out / f"{paper}_table_2.csv")
        _write_shapes(found, out / f"{paper}_shapes.csv")
        plots.rone2012(found).savefig(out / f"{paper}.png", dpi=130)
    _show(found)
    say(f"written: {out / paper}_table_2.csv, _shapes.csv, .png")


def _columns_of_table_2(found: "Rone2012") -> dict[str, "np.ndarray"]:
    """Positions of each disk by their source, shape (disks, 2), m."""
    import numpy as np

    from continuum_dyn.experiments.reproduce import TABLE_2_FINITE_ELEMENTS, TABLE_2_VIRTUAL_WORK

    spread = {"core spread": found.core_spread.program, "core spread, exact rod": found.core_spread.rod}
    shapes = {**found.unactuated.by_law, "unrounded": found.unrounded, **spread}
    ours = {name: np.column_stack([shape.disk_x, shape.disk_y]) for name, shape in shapes.items()}
    return {**ours, "paper": TABLE_2_VIRTUAL_WORK, "paper_finite_elements": TABLE_2_FINITE_ELEMENTS}


def _write_table_2(found: "Rone2012", path: Path) -> None:
    columns = _columns_of_table_2(found)
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        names = [name.replace(",", "").replace(" ", "_") for name in columns]
        writer.writerow(["disk", *(f"{axis}_{name}" for name in names for axis in ("disk_x", "disk_y"))])
        for i in range(4):
            writer.writerow([i + 1, *(float(value) for column in columns.values() for value in column[i])])


def _write_shapes(found: "Rone2012", path: Path) -> None:
    """Write every disk under every tension; the rod has no single curvature or length between disks."""
    by_tension = {shapes.tension: shapes for shapes in (*found.ramp, *found.figure_4)}
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["tension", "law", "disk", "disk_x", "disk_y", "disk_theta", "curvature", "length"])
        for tension in sorted(by_tension):
            for law, shape in by_tension[tension].by_law.items():
                names = ("disk_x", "disk_y", "disk_theta", "curvature", "length")
                columns = [getattr(shape, name, [""] * len(shape.disk_x)) for name in names]
                rows = zip(*columns, strict=True)
                writer.writerows([tension, law, i, *row] for i, row in enumerate(rows, start=1))


def _show(found: "Rone2012") -> None:
    screen = console()
    screen.print(_height_table(found))
    screen.print(
        "Virtual work, finite elements: the paper's columns. Unrounded: the program with A and J of a core "
        "radius of 0.4 mm, not Table 1's rounded ones. Percent by which the program's sag is below the "
        f"paper's: {_below(found.unactuated.program)}; unrounded {_below(found.unrounded)}.\n"
    )
    screen.print(_mass_table(found))
    screen.print(
        "Core spread: the same total mass, with the steel core's part of it distributed along the core and "
        "not in the disks; by the program and as an exact rod.\n"
    )
    screen.print(_distance_table(found))
    screen.print(
        "Percent errors of the distance from the base: the paper's own; computed from its digits; the "
        "effect of half a unit in the last digit of x; the program against the exact rod. The paper's own "
        "errors are below its rounding, so its digits cannot give them. Its first x has one digit less.\n"
    )
    screen.print(_tip_table(found))
    for shapes in found.of_opposite_sign:
        screen.print(_sign_of(shapes))
    level = ", ".join(f"{law} {tension:.4f} N" for law, tension in found.level_tension.items())
    screen.print(f"The tip is level with the base at: {level}.\n")
    screen.print(_curvature_table(found))


def _height_table(found: "Rone2012") -> Any:
    columns = _columns_of_table_2(found)
    titles = {"paper": "virtual work", "paper_finite_elements": "finite elements"}
    shown = ("printed", "program", "exact rod", "unrounded", "paper", "paper_finite_elements")
    heights = plain_table(
        "Table 2: y (um) without tension", "disk", *(titles.get(name, name) for name in shown)
    )
    for i in range(4):
        heights.add_row(str(i + 1), *(f"{columns[name][i, 1] * 1e6:.3f}" for name in shown))
    return heights


def _mass_table(found: "Rone2012") -> Any:
    """Sags with the mass in the disks and with the core's part of it along the core."""
    columns = _columns_of_table_2(found)
    by_elements = columns["paper_finite_elements"][:, 1]
    shown = ("paper", "program", "core spread", "exact rod", "core spread, exact rod")
    titles = ("virtual work", "program", "core spread", "exact rod", "rod, spread")
    masses = plain_table("Table 2: y (um), and percent of sag above finite elements", "disk", *titles)
    for i in range(4):
        y = [columns[name][i, 1] for name in shown]
        cells = [f"{1e6 * at:.2f} {100 * (at / by_elements[i] - 1):+.2f}" for at in y]
        masses.add_row(str(i + 1), *cells)
    return masses


def _below(program: "Equilibrium") -> str:
    """Difference of each disk's sag from the paper's, smaller counted positive, in percent."""
    from continuum_dyn.experiments.reproduce import TABLE_2_VIRTUAL_WORK

    return ", ".join(f"{100 * below:.4f}" for below in 1 - program.disk_y / TABLE_2_VIRTUAL_WORK[:, 1])


def _distance_table(found: "Rone2012") -> Any:
    """Each disk's x, and the errors of its distance from the base as the paper defines them."""
    import numpy as np

    from continuum_dyn.experiments.reproduce import TABLE_2_PERCENT_ERROR

    columns = _columns_of_table_2(found)
    away = {name: np.hypot(*column.T) for name, column in columns.items()}
    ours = 100 * (away["program"] / away["exact rod"] - 1)
    digits = 100 * (away["paper"] / away["paper_finite_elements"] - 1)
    resolved = 100 * 0.5e-6 / away["paper"]
    errors = (TABLE_2_PERCENT_ERROR, digits, resolved, ours)
    titles = ("disk", "program", "exact rod", "paper", "% error", "of digits", "rounding", "against rod")
    distances = plain_table("Table 2: x (mm), and percent errors", *titles)
    for i in range(4):
        x = [f"{columns[name][i, 0] * 1e3:.5f}" for name in ("program", "exact rod")]
        paper = f"{columns['paper'][i, 0] * 1e3:.5g}"
        distances.add_row(str(i + 1), *x, paper, *(f"{error[i]:.1e}" for error in errors))
    return distances


def _tip_table(found: "Rone2012") -> Any:
    tips = plain_table(
        "Fig. 3 and 4: y of the tip (mm)", "tension", *found.unactuated.by_law, "printed - rod"
    )
    for shapes in (found.unactuated, *found.figure_4):
        apart = shapes.tip_y["printed"] - shapes.tip_y["exact rod"]
        row = [f"{1e3 * height:.4f}" for height in (*shapes.tip_y.values(), apart)]
        tips.add_row(f"{shapes.tension:g} N", *row)
    return tips


def _sign_of(shapes: "Shapes") -> str:
    heights = ", ".join(f"{law} {1e6 * height:+.1f} um" for law, height in shapes.tip_y.items())
    return f"At {shapes.tension:g} N the results differ in sign: {heights}."


def _curvature_table(found: "Rone2012") -> Any:
    segments = [f"segment {i}" for i in range(1, 5)]
    curvatures = plain_table("Fig. 3 and 4: curvatures (1/m)", "tension", "law", *segments)
    for shapes in (found.unactuated, *found.figure_4):
        for law, shape in (("printed", shapes.printed), ("program", shapes.program)):
            curvatures.add_row(f"{shapes.tension:g} N", law, *(f"{k:.3f}" for k in shape.curvature))
    return curvatures
