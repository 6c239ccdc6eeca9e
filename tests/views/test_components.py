"""What is sent to rerun's core is named and typed as rerun's own Python layer would."""

from importlib import import_module
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
import rerun as rr

from continuum_dyn.views.rerun_core.components import COMPONENTS, TIMES, arrow, moments, parts

NAMES = [(kind, name) for kind, columns in COMPONENTS.items() for name in columns]


@pytest.mark.parametrize(("kind", "name"), NAMES)
def test_components_are_those_of_rerun(kind: str, name: str) -> None:
    module, _, short = kind.rpartition(".")
    archetype: Any = getattr(import_module(f"rerun.{module}"), short)
    (field,) = (field for field in archetype.__attrs_attrs__ if field.name == name)
    batch = field.converter.__self__
    component, arrow_type = COMPONENTS[kind][name]
    assert f"rerun.{component}" == batch._COMPONENT_TYPE
    assert arrow_type == batch._ARROW_DATATYPE


@pytest.mark.parametrize(
    ("arrow_type", "values"),
    [
        (pa.utf8(), ["", "tip", "\u03b8 \U0001f41b"]),
        (pa.bool_(), [True, False] * 5),
        (pa.float32(), [0.5, -np.inf]),
        (pa.list_(pa.float64(), 2), [[1.0, 2.0], [3.0, 4.0]]),
        (pa.list_(pa.list_(pa.float32(), 2)), [[[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]]),
        (pa.uint8(), []),
    ],
)
def test_columns_hold_their_values(arrow_type: pa.DataType, values: list[Any]) -> None:
    column = arrow(arrow_type, values)
    column.validate(full=True)
    assert column.equals(pa.array(values, arrow_type))


def test_parts_hold_as_many_as_they_should() -> None:
    column = parts(arrow(pa.float64(), [1.0, 2.0, 3.0]), np.array([2, 0, 1]))
    assert column.to_pylist() == [[1.0, 2.0], [], [3.0]]


def test_times_are_those_of_rerun() -> None:
    seconds = np.array([0.0, 1.5])
    expected = rr.TimeColumn("sim_time", duration=seconds).as_arrow_array()
    assert moments(1e9 * seconds, moves=True).equals(expected)
    range_of_times = arrow(TIMES, {"start": [5], "end": [7]})
    range_of_times.validate(full=True)
    assert range_of_times.to_pylist() == [{"start": 5, "end": 7}]
