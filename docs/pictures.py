"""Make the pictures of the README and the documentation: ``python docs/pictures.py``."""

from pathlib import Path
from tempfile import TemporaryDirectory

from continuum_dyn import load_scenario, simulate
from continuum_dyn.cost import measure
from continuum_dyn.record import read_log, write_log
from continuum_dyn.reproduce import reproduce
from continuum_dyn.views import log_plots, plots

HERE = Path(__file__).parent


def main() -> None:
    """Draw the step response, what its accuracy costs, a path with folds, and the paper computed again."""
    scenario = load_scenario(HERE.parent / "scenarios" / "step_response.toml")
    with TemporaryDirectory() as folder:
        log = Path(folder) / "step_response.h5"
        write_log(simulate(scenario), log)
        path = Path(folder) / "snap_through.h5"
        write_log(simulate(load_scenario(HERE.parent / "scenarios" / "snap_through.toml")), path)
        figures = {
            "step_response.png": log_plots.picture(read_log(log)),
            "snap_through.png": log_plots.picture(read_log(path), ["tip"]),
            "cost.png": plots.cost(measure(scenario)),
            "rone2012.png": plots.rone2012(reproduce("rone2012")),
        }
    for name, figure in figures.items():
        figure.savefig(HERE / name, dpi=130)
        print(HERE / name)


if __name__ == "__main__":
    main()
