"""Make the pictures of the README and the documentation: ``python docs/pictures.py``."""

from pathlib import Path
from tempfile import TemporaryDirectory

from continuum_dyn import load_scenario, simulate
from continuum_dyn.record import read_log, write_log
from continuum_dyn.views import plots

HERE = Path(__file__).parent


def main() -> None:
    """Run the step response and draw it."""
    with TemporaryDirectory() as folder:
        log = Path(folder) / "step_response.h5"
        write_log(simulate(load_scenario(HERE.parent / "scenarios" / "step_response.toml")), log)
        picture = HERE / "step_response.png"
        plots.step_response(read_log(log)).savefig(picture, dpi=130)
        print(picture)


if __name__ == "__main__":
    main()
