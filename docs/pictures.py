"""Make the pictures of the README and the documentation: ``python docs/pictures.py``."""

from pathlib import Path
from tempfile import TemporaryDirectory

from matplotlib.figure import Figure
from playback_pictures import playback_pictures

from continuum_dyn import load_scenario, simulate
from continuum_dyn.answers.ramp import ramp_answers
from continuum_dyn.answers.settling import settling
from continuum_dyn.experiments.cost import measure
from continuum_dyn.experiments.reproduce import reproduce
from continuum_dyn.record import read_log, write_log
from continuum_dyn.views.figures import log_plots, plots, ramp_plot, settling_plot

HERE = Path(__file__).parent
SCENARIOS = HERE.parent / "scenarios"
MOMENTS = (0.0, 0.01, 0.022, 0.044, 0.1, 1.0)
"""Of the step response, s: at rest, rising, at its highest, back, ringing, settled."""


def main() -> None:
    """Draw every picture that a page shows."""
    with TemporaryDirectory() as folder:
        for name, figure in figures(Path(folder)).items():
            figure.savefig(HERE / "images" / name, dpi=130)
            print(HERE / "images" / name)


def figures(folder: Path) -> dict[str, Figure]:
    """The pictures by the names of their files."""
    step = logged("step_response", folder)
    playback, window = playback_pictures(step, MOMENTS)
    log, slow = read_log(step), read_log(logged("slow_ramp", folder))
    return {
        "step_response.png": log_plots.picture(log),
        "settling.png": settling_plot.settling(log.title, settling(log)),
        "playback.png": playback,
        "playback_window.png": window,
        "tension_ramp.png": log_plots.picture(read_log(logged("tension_ramp", folder)), ["shapes"]),
        "slow_ramp.png": ramp_plot.ramp(slow.title, ramp_answers(slow, error=1e-4)),
        "snap_through.png": log_plots.picture(read_log(logged("snap_through", folder)), ["tip"]),
        "cost.png": plots.cost(measure(load_scenario(SCENARIOS / "step_response.toml"))),
        "rone2012.png": plots.rone2012(reproduce("rone2012")),
    }


def logged(name: str, folder: Path) -> Path:
    """The log of the scenario of that name."""
    path = folder / f"{name}.h5"
    write_log(simulate(load_scenario(SCENARIOS / f"{name}.toml")), path)
    return path


if __name__ == "__main__":
    main()
