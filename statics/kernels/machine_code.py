"""Machine code of the passes: LLVM's text compiled for this machine, in this process."""

import ctypes
from collections.abc import Iterable
from functools import cache

import llvmlite.binding as llvm

SPEED = 2
"""LLVM's level of optimization: 1 is hardly faster to compile, 3 no faster to run."""


class MachineCode:
    """Compiled functions and their addresses, which are valid as long as this lives."""

    def __init__(self, text: str, names: Iterable[str]) -> None:
        machine = _machine()
        module = llvm.parse_assembly(text)
        module.triple, module.data_layout = machine.triple, str(machine.target_data)
        tuning = llvm.create_pipeline_tuning_options(speed_level=SPEED)
        llvm.create_pass_builder(machine, tuning).getModulePassManager().run(
            module, llvm.create_pass_builder(machine, tuning)
        )
        self.engine = llvm.create_mcjit_compiler(module, machine)
        self.engine.finalize_object()
        self.addresses = {name: self.engine.get_function_address(name) for name in names}


def _machine() -> llvm.TargetMachine:
    """This machine, with all that its processor can do."""
    _initialize()
    features = llvm.get_host_cpu_features().flatten()
    target = llvm.Target.from_default_triple()
    return target.create_target_machine(cpu=llvm.get_host_cpu_name(), features=features, opt=SPEED)


@cache
def _initialize() -> None:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    from statics.kernels.lowering import LIBRARY

    library = ctypes.CDLL(None)
    for name in LIBRARY:
        if llvm.address_of_symbol(name) is None:
            address = ctypes.cast(getattr(library, name), ctypes.c_void_p).value
            llvm.add_symbol(name, address or 0)
