"""Machine code: LLVM's text compiled for this machine, to be kept and loaded."""

import ctypes
from functools import cache

import llvmlite
import llvmlite.binding as llvm

SPEED = 2
"""LLVM's level of optimization: 1 is hardly faster to compile, 3 no faster to run."""


def compile_text(text: str, multiply_loops: bool = True) -> bytes:
    """Machine code of LLVM's text, as an object file.

    To unroll loops and put them into vectors takes half of the time, and makes no step faster.
    """
    machine = _machine()
    module = llvm.parse_assembly(text)
    module.triple, module.data_layout = machine.triple, str(machine.target_data)
    tuning = llvm.create_pipeline_tuning_options(speed_level=SPEED)
    tuning.loop_unrolling = tuning.loop_vectorization = multiply_loops
    llvm.create_pass_builder(machine, tuning).getModulePassManager().run(
        module, llvm.create_pass_builder(machine, tuning)
    )
    return machine.emit_object(module)


class MachineCode:
    """Functions of an object file, ready to be called; their addresses are valid as long as this lives."""

    def __init__(self, file: bytes) -> None:
        self.engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())
        self.engine.add_object_file(llvm.ObjectFileRef.from_data(file))
        self.engine.finalize_object()

    def address(self, name: str) -> int:
        """Address of a function."""
        return self.engine.get_function_address(name)


@cache
def machine_name() -> str:
    """All that machine code depends on but its text: the compiler's version and the processor."""
    features = llvm.get_host_cpu_features().flatten()
    return f"llvmlite {llvmlite.__version__}, {llvm.get_host_cpu_name()}, {features}, O{SPEED}"


def _machine() -> llvm.TargetMachine:
    """This machine, with all that its processor can do."""
    _initialize()
    features = llvm.get_host_cpu_features().flatten()
    target = llvm.Target.from_default_triple()
    return target.create_target_machine(cpu=llvm.get_host_cpu_name(), features=features, opt=SPEED, jit=True)


@cache
def _initialize() -> None:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    from statics.kernels.lowering import LIBRARY

    library = ctypes.CDLL(None)
    for name in (*LIBRARY, "pow"):
        if llvm.address_of_symbol(name) is None:
            address = ctypes.cast(getattr(library, name), ctypes.c_void_p).value
            llvm.add_symbol(name, address or 0)
