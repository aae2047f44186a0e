"""Programs compiled for the processor, and kept where Numba keeps its own code.

Compiling takes as long as some hundred scans for each row, so that it begins when that many have been run; what is
kept is loaded at once.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property
from hashlib import sha256
from pathlib import Path
from typing import Any
from uuid import uuid4

import llvmlite
import llvmlite.binding as llvm
import numpy as np

from plcgen.plc.fast import native_bodies, native_rows, vm
from plcgen.plc.fast.encode import NUMBERS, SITE, Code

SCANS_A_ROW = 30
"""After so many compiling pays, which takes as long as some hundred: what is compiled serves other runs too."""
MOST_KEPT = 256
DIGEST = 32
"""Bytes before an object that stand for all others."""


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
            self.native = _kept(self._path)
        if self.native is None and self._left <= 0:
            self.native = _compiled(self._code, self._path)
        return self.native

    @cached_property
    def _path(self) -> Path:
        """Named by all that the object depends on. Most floats are data, so that jobs share an object."""
        code, digest = self._code, sha256(_writers())
        numbers = set(np.unique(self._rows[:, NUMBERS:SITE]).tolist())
        within = {slot: value for slot, value in code.constants.items() if isinstance(value, int) or slot in numbers}
        starts = sorted(entry.start for entry in code.entries.values())
        digest.update(self._rows.tobytes())
        digest.update(repr((starts, sorted(within.items()))).encode())
        return _folder() / f"native-{digest.hexdigest()[:32]}.o"


def _kept(path: Path) -> Native | None:
    """What an earlier run has compiled."""
    try:
        data = path.read_bytes()
    except OSError:
        return None
    if sha256(data[DIGEST:]).digest() != data[:DIGEST]:
        return None
    with suppress(OSError):
        path.touch()
    return _loaded(data[DIGEST:])


def _compiled(code: Code, path: Path) -> Native:
    """Compile a program, and keep it for other runs."""
    data = _object(native_rows.module(code))
    with suppress(OSError):
        _keep(path, sha256(data).digest() + data)
    return _loaded(data)


def _object(text: str) -> bytes:
    module, machine = llvm.parse_assembly(text), _machine()
    builder = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(speed_level=1))
    builder.getModulePassManager().run(module, builder)
    data: bytes = machine.emit_object(module)
    return data


def _loaded(data: bytes) -> Native:
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())
    engine.add_object_file(llvm.ObjectFileRef.from_data(data))
    engine.finalize_object()
    return Native(engine.get_function_address(native_rows.BEGIN), engine)


def _machine() -> Any:
    """For this very processor. An engine owns its own."""
    cpu, features = _processor()
    return llvm.Target.from_default_triple().create_target_machine(cpu=cpu, features=features, opt=1, jit=True)


@cache
def _processor() -> tuple[str, str]:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


# ------------------------------------------------------------------------------------------------------------- files


@cache
def _folder() -> Path:
    return Path(str(vm.enter.stats.cache_path))


@cache
def _writers() -> bytes:
    """Whatever the text of a module, and its code, depends on beside the program."""
    texts = [Path(str(module.__file__)).read_bytes() for module in (native_bodies, native_rows, vm)]
    return b"".join([*texts, repr((llvmlite.__version__, *_processor())).encode()])


def _keep(path: Path, data: bytes) -> None:
    """Whole or not at all. What was not used for the longest time makes room."""
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_name(f"{path.stem}-{uuid4().hex}.tmp")
    try:
        draft.write_bytes(data)
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)
    by_age = sorted(path.parent.glob("native-*.o"), key=lambda entry: entry.stat().st_mtime)
    for old in by_age[:-MOST_KEPT]:
        old.unlink(missing_ok=True)
