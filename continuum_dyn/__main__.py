"""Entry point of ``continuum-dyn`` and ``python -m continuum_dyn``, which handles Ctrl-C from the start."""

import os
import signal
import time

INTERRUPTED = 130


def _end_at_once(_signal: int, _frame: object) -> None:
    os.write(2, b"interrupted\n")
    os._exit(INTERRUPTED)


def main() -> None:
    """Load the command line, and run it.

    Until it is loaded there is nothing to keep, and Ctrl-C ends the program at once: raised within the import
    of a library, it might come out as anything.
    """
    begun = time.perf_counter()
    signal.signal(signal.SIGINT, _end_at_once)
    from continuum_dyn.cli import main
    from continuum_dyn.commands.terminal.clock import program_begun

    program_begun(begun)
    main()


if __name__ == "__main__":
    main()
