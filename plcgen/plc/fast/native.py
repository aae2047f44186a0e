"""Programs compiled for the processor, and kept for other runs.

Compiling takes as long as some hundred scans for each row, so that it begins when that many have been run; what is
kept is loaded at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from hashlib import sha256
from typing import Any

import llvmlite
import llvmlite.binding as llvm
import numpy as np

from plcgen.kept import keep, recalled
from plcgen.plc.fast import native_rows
from plcgen.plc.fast.encode import NUMBERS, SITE, Code

SCANS_A_ROW = 30
"""After so many compiling pays, which takes as long as some hundred: what is compiled serves other runs too."""
KIND = "native"
"""Of what is kept."""


@dataclass(frozen=True)
class Native:
    """Code in memory, as long as this lives."""

    address: int
    engine: Any


class Compiler:
    """Makes native code of a program, when it is worth its time."""

    def __init__(self, code: Code, rows: np.ndarray) -> None:
        self._code, self._rows = code, rows
        self._left = SCANS_A_ROW * len(rows)
        self._has_looked = False
        self.native: Native | None = None

    def after(self, scans: int) -> Native | None:
        """Native code, once so many scans more have been run: at once if it was kept."""
        self._left -= scans
        if self.native is None and not self._has_looked:
            self._has_looked = True
            data = recalled(KIND, self._key)
            self.native = _loaded(data) if data else None
        if self.native is None and self._left <= 0:
            self.native = self._compiled()
        return self.native

    def _compiled(self) -> Native:
        data = _object(native_rows.module(self._code))
        keep(KIND, self._key, data)
        return _loaded(data)

    @cached_property
    def _key(self) -> bytes:
        """All that the object depends on beside plcgen itself. Most floats are data, so that jobs share an object."""
        code, digest = self._code, sha256(repr((llvmlite.__version__, *_processor())).encode())
        numbers = set(np.unique(self._rows[:, NUMBERS:SITE]).tolist())
        within = {slot: value for slot, value in code.constants.items() if isinstance(value, int) or slot in numbers}
        starts = sorted(entry.start for entry in code.entries.values())
        digest.update(self._rows.tobytes())
        digest.update(repr((starts, sorted(within.items()))).encode())
        return digest.digest()


def _object(text: str) -> bytes:
    machine = _machine()
    module = _module(text, machine)
    builder = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(speed_level=1))
    builder.getModulePassManager().run(module, builder)
    data: bytes = machine.emit_object(module)
    return data


def _loaded(data: bytes) -> Native:
    machine = _machine()
    engine = llvm.create_mcjit_compiler(_module("", machine), machine)
    engine.add_object_file(llvm.ObjectFileRef.from_data(data))
    engine.finalize_object()
    return Native(engine.get_function_address(native_rows.BEGIN), engine)


def _module(text: str, machine: Any) -> Any:
    """Names and calls as the operating system wants them."""
    module = llvm.parse_assembly(text)
    module.triple, module.data_layout = machine.triple, str(machine.target_data)
    return module


def _machine() -> Any:
    """For this very processor. An engine owns its own."""
    cpu, features = _processor()
    target = llvm.Target.from_triple(llvm.get_process_triple())
    return target.create_target_machine(cpu=cpu, features=features, opt=1, jit=True)


@cache
def _processor() -> tuple[str, str]:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
