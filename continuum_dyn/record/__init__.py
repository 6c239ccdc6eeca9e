"""Runs come in, HDF5 logs go out, and from these what is needed to plot, repeat or resume a run."""

from continuum_dyn.record.log import Log
from continuum_dyn.record.log_format import FORMAT_VERSION
from continuum_dyn.record.reading import read_log
from continuum_dyn.record.streaming import StreamedLog
from continuum_dyn.record.writing import write_log

__all__ = ["FORMAT_VERSION", "Log", "StreamedLog", "read_log", "write_log"]
