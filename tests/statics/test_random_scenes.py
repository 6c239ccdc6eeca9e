"""Random scenes are the same every time, whatever else is tested and whatever numbers the sources hold."""

import importlib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st


def drawn() -> list[float]:
    numbers: list[float] = []

    @settings(max_examples=200, derandomize=True)
    @given(st.floats(allow_nan=False))
    def keep(number: float) -> None:
        numbers.append(number)

    keep()
    return numbers


def test_draws_do_not_depend_on_the_modules_imported_so_far(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = drawn()
    (tmp_path / "full_of_numbers.py").write_text("\n".join(f"x_{n} = {n}.1234" for n in range(1000)))
    monkeypatch.syspath_prepend(tmp_path)
    importlib.import_module("full_of_numbers")
    assert drawn() == before
