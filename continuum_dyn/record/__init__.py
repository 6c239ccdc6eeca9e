"""Logs: HDF5 files that hold a run, and what is needed to understand and to repeat it."""

from continuum_dyn.record.log import Log
from continuum_dyn.record.log_format import FORMAT_VERSION
from continuum_dyn.record.reading import read_log
from continuum_dyn.record.streaming import StreamedLog
from continuum_dyn.record.writing import write_log

__all__ = ["FORMAT_VERSION", "Log", "StreamedLog", "read_log", "write_log"]
