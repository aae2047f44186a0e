"""Rows of the virtual machine as a module of LLVM, a function for each function of the program.

Slots stay in the room: where a row needs more than a processor can do, an event above all, its number is noted and
the virtual machine goes on from it. `fast.generate` says what a row does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from struct import calcsize

from plcgen.plc.fast import encode, vm
from plcgen.plc.fast.bodies import Body
from plcgen.plc.fast.encode import BASE, ZERO, Code
from plcgen.plc.fast.native_bodies import (
    BOOL,
    INT,
    REAL,
    BeyondError,
    Expression,
    Text,
    Value,
    bits_of,
    parsed,
    real_number,
    rounded,
    whole_number,
)

BEGIN = "begin"
"""The function that is called: room, memory, first row."""
HEAD = """\
declare double @llvm.fabs.f64(double)
declare double @llvm.sqrt.f64(double)
declare double @llvm.rint.f64(double)
declare double @llvm.trunc.f64(double)
declare double @llvm.ceil.f64(double)
declare double @llvm.floor.f64(double)
declare i16 @llvm.bswap.i16(i16)
declare i32 @llvm.bswap.i32(i32)
declare i64 @llvm.bswap.i64(i64)
declare void @llvm.memmove.p0.p0.i64(ptr, ptr, i64, i1)
declare void @llvm.memset.p0.i64(ptr, i8, i64, i1)
"""
PARAMETERS = "ptr noalias %room, ptr noalias %memory"
JUMPS = frozenset({encode.BACK, encode.GO, encode.IF, encode.UNLESS})


def module(code: Code) -> str:
    """The text of a module for the code of a program. Whole numbers that never change stand in it as such."""
    starts = sorted({entry.start for entry in code.entries.values()})
    ends = [*starts[1:], len(code.rows)]
    functions = [_Function(code, start, end).written() for start, end in zip(starts, ends, strict=True)]
    return "\n".join([HEAD, *functions, *_begin(starts)])


def _begin(starts: list[int]) -> Iterator[str]:
    yield f"define i64 @{BEGIN}({PARAMETERS}, i64 %start) {{"
    yield "entry:"
    yield "  switch i64 %start, label %other [" + " ".join(f"i64 {row}, label %f{row}" for row in starts) + "]"
    for row in starts:
        yield f"f{row}:"
        yield f"  %e{row} = call i64 @f{row}(ptr %room, ptr %memory)"
        yield f"  ret i64 %e{row}"
    yield f"other:\n  ret i64 {vm.HANDED_OVER}\n}}"


class _Function:
    """The rows of one function. What is known of slots saves loads between two labels."""

    def __init__(self, code: Code, start: int, end: int) -> None:
        self.code, self.start, self.end = code, start, end
        self.text = Text(block="body")
        self.known: dict[tuple[int, str], Value] = {}
        self.places: dict[int, str] = {}
        self.base = Value("%base", INT)
        rows = code.rows[start:end]
        self.labels = {row[1] for row in rows if row[0] in JUMPS}

    def written(self) -> str:
        for number in range(self.start, self.end):
            self._begin_row(number)
            self._row(self.code.rows[number])
        text = self.text
        text.row = self.end
        text.leave()
        head = [f"define internal i64 @f{self.start}({PARAMETERS}) {{", "entry:"]
        places = [
            f"  {name} = getelementptr i64, ptr %room, i64 {vm.SLOTS + slot}" for slot, name in self.places.items()
        ]
        base = [f"  %base = load i64, ptr {self._place(BASE)}"] if BASE in self.places else []
        phi = ", ".join(f"[ {row}, %{block} ]" for row, block in text.exits)
        leave = [
            "leave:", f"  %row = phi i64 {phi}", f"  %at = getelementptr i64, ptr %room, i64 {vm.START}",
            "  store i64 %row, ptr %at", f"  ret i64 {vm.HANDED_OVER}", "}",
        ]  # fmt: skip
        return "\n".join([*head, *places, *base, "  br label %body", "body:", *text.lines, "  unreachable", *leave])

    def _begin_row(self, number: int) -> None:
        self.text.row = number
        if number in self.labels:
            self.text.lines += [f"  br label %r{number}", f"r{number}:"]
            self.text.block = f"r{number}"
            self.known.clear()

    def _row(self, row: list[int]) -> None:
        write = ROWS.get(row[0])
        if write is not None:
            write(self, row)
            return
        body = self.code.bodies.get(row[0])
        if body is None:
            self.text.leave()
            return
        try:
            self._body(body, row)
        except BeyondError:
            self.text.leave()

    # ------------------------------------------------------------------------------------------------------- slots

    def _place(self, slot: int) -> str:
        return self.places.setdefault(slot, f"%s{slot}")

    def integer(self, slot: int) -> Value:
        constant = 0 if slot == ZERO else self.code.constants.get(slot)
        if isinstance(constant, int):
            return whole_number(int(constant))
        if slot == BASE:
            self._place(BASE)
            return self.base
        return self._loaded(slot, INT)

    def real(self, slot: int) -> Value:
        return self._loaded(slot, REAL)

    def _loaded(self, slot: int, kind: str) -> Value:
        found = self.known.get((slot, kind))
        if found is None:
            found = self.known[slot, kind] = self.text.value(kind, f"load {kind}, ptr {self._place(slot)}")
        return found

    def put(self, slot: int, value: Value) -> None:
        if value.kind == BOOL:
            value = self.text.value(INT, f"zext i1 {value.name} to i64")
        self.text.lines.append(f"  store {value.kind} {value.name}, ptr {self._place(slot)}")
        self.known[slot, value.kind] = value
        self.known.pop((slot, REAL if value.kind == INT else INT), None)

    # ------------------------------------------------------------------------------------------------------ bodies

    def _body(self, body: Body, row: list[int]) -> None:
        names = {
            letter: self.real(slot) if kind == "f" else self.integer(slot)
            for letter, kind, slot in zip("ABCD", body.kinds[:-1], row[2:6], strict=False)
        }
        for place, slot in enumerate(row[encode.NUMBERS : encode.SITE]):
            constant = self.code.constants.get(slot)
            if isinstance(constant, float):
                names[f"G{place}"] = real_number(constant)
            elif constant is not None:
                names[f"K{place}"] = whole_number(constant)
        expression = Expression(self.text, names, self._count)
        found = expression.of(parsed(body.expression))
        result = {"f": REAL, "i": INT, "b": BOOL}[body.kinds[-1]]
        found = expression.as_kind(found, result)
        if body.rounds:
            found = rounded(self.text, found)
        if body.check:
            expression.names["R"] = found
            self.text.leave_if(expression.truth(expression.of(parsed(body.check))))
        self.put(row[1], found)

    def _count(self, kind: Value) -> None:
        text = self.text
        if not kind.name.isdecimal():
            raise BeyondError
        place = self._field(vm.COUNTS + int(kind.name))
        before = text.value(INT, f"load i64, ptr {place.name}")
        after = text.value(INT, f"add i64 {before.name}, 1")
        text.lines.append(f"  store i64 {after.name}, ptr {place.name}")

    # ----------------------------------------------------------------------------------------------------- control

    def _field(self, field: int) -> Value:
        return self.text.value("ptr", f"getelementptr i64, ptr %room, i64 {field}")

    def _spend(self) -> None:
        """A unit of the budget; where none is left, the virtual machine says so."""
        place = self._field(vm.BUDGET)
        left = self.text.value(INT, f"load i64, ptr {place.name}")
        self.text.leave_if(self.text.value(BOOL, f"icmp slt i64 {left.name}, 1"))
        less = self.text.value(INT, f"sub i64 {left.name}, 1")
        self.text.lines.append(f"  store i64 {less.name}, ptr {place.name}")

    def _jump_to(self, row: int) -> None:
        self.text.lines.append(f"  br label %r{row}")
        self._dead()

    def _dead(self) -> None:
        self.text.names += 1
        self.text.block = f"n{self.text.names}"
        self.text.lines.append(f"{self.text.block}:")

    def back(self, row: list[int]) -> None:
        self._spend()
        self._jump_to(row[1])

    def go(self, row: list[int]) -> None:
        self._jump_to(row[1])

    def when(self, row: list[int]) -> None:
        compare = "ne" if row[0] == encode.IF else "eq"
        test = self.text.value(BOOL, f"icmp {compare} i64 {self.integer(row[2]).name}, 0")
        self.text.names += 1
        self.text.lines.append(f"  br i1 {test.name}, label %r{row[1]}, label %n{self.text.names}")
        self.text.block = f"n{self.text.names}"
        self.text.lines.append(f"{self.text.block}:")

    def call(self, row: list[int]) -> None:
        self._spend()
        text, calls = self.text, self._field(vm.CALLS)
        depth = text.value(INT, f"load i64, ptr {calls.name}")
        self._place(BASE)
        for offset, value in ((vm.STACK, str(self.text.row)), (vm.STACK + 1, "%base")):
            index = text.value(INT, f"add i64 {depth.name}, {offset}")
            place = text.value("ptr", f"getelementptr i64, ptr %room, i64 {index.name}")
            text.lines.append(f"  store i64 {value}, ptr {place.name}")
        deeper = text.value(INT, f"add i64 {depth.name}, 2")
        text.lines.append(f"  store i64 {deeper.name}, ptr {calls.name}")
        base = text.value(INT, f"add i64 {self.integer(row[2]).name}, {row[3]}")
        text.lines.append(f"  store i64 {base.name}, ptr {self._place(BASE)}")
        ended = text.value(INT, f"call i64 @f{row[1]}(ptr %room, ptr %memory)")
        self._return_if_over(ended)
        text.lines.append(f"  store i64 {depth.name}, ptr {calls.name}")
        text.lines.append(f"  store i64 %base, ptr {self._place(BASE)}")
        self.known.clear()

    def _return_if_over(self, ended: Value) -> None:
        text = self.text
        test = text.value(BOOL, f"icmp ne i64 {ended.name}, 0")
        text.names += 1
        over, on = f"o{text.names}", f"n{text.names}"
        text.lines += [f"  br i1 {test.name}, label %{over}, label %{on}", f"{over}:", f"  ret i64 {ended.name}"]
        text.lines.append(f"{on}:")
        text.block = on

    def back_to_caller(self, _row: list[int]) -> None:
        self.text.lines.append(f"  ret i64 {vm.DONE}")
        self._dead()

    def move(self, row: list[int]) -> None:
        real = self.known.get((row[2], REAL))
        self.put(row[1], real if real is not None else self.integer(row[2]))

    # ------------------------------------------------------------------------------------------------------ memory

    def address(self, offset: int, bytes_: int, bits: int) -> Value:
        text = self.text
        sum_ = whole_number(offset)
        if bytes_ != ZERO:
            sum_ = text.value(INT, f"add i64 {self.integer(bytes_).name}, {offset}")
        if bits != ZERO:
            whole = text.value(INT, f"ashr i64 {self.integer(bits).name}, 3")
            sum_ = text.value(INT, f"add i64 {sum_.name}, {whole.name}")
        return text.value("ptr", f"getelementptr i8, ptr %memory, i64 {sum_.name}")

    def _loaded_word(self, place: Value, size: int) -> Value:
        kind = f"i{8 * size}"
        word = self.text.value(kind, f"load {kind}, ptr {place.name}, align 1")
        return self.text.value(kind, f"call {kind} @llvm.bswap.{kind}({kind} {word.name})") if size > 1 else word

    def load(self, row: list[int]) -> None:
        size, extends = LOADED[row[0]]
        word = self._loaded_word(self.address(row[2], row[3], row[4]), size)
        if size < 8:
            word = self.text.value(INT, f"{extends} {word.kind} {word.name} to i64")
        self.put(row[1], Value(word.name, INT))

    def load_real(self, row: list[int]) -> None:
        word = self._loaded_word(self.address(row[2], row[3], row[4]), 4)
        short = self.text.value("float", f"bitcast i32 {word.name} to float")
        self.put(row[1], self.text.value(REAL, f"fpext float {short.name} to double"))

    def load_bit(self, row: list[int]) -> None:
        byte, bit = self._bit(row[2], row[3], row[4])
        whole = self.text.value(INT, f"zext i8 {self.text.value('i8', f'load i8, ptr {byte.name}').name} to i64")
        shifted = self.text.value(INT, f"lshr i64 {whole.name}, {bit.name}")
        self.put(row[1], self.text.value(INT, f"and i64 {shifted.name}, 1"))

    def _bit(self, offset: int, bytes_: int, bits: int) -> tuple[Value, Value]:
        """The address of its byte, and its number there."""
        text = self.text
        if bits == ZERO:
            return self.address(offset >> 3, bytes_, ZERO), whole_number(offset & 7)
        index = text.value(INT, f"add i64 {self.integer(bits).name}, {offset}")
        byte = text.value(INT, f"ashr i64 {index.name}, 3")
        sum_ = text.value(INT, f"add i64 {byte.name}, {self.integer(bytes_).name}")
        place = text.value("ptr", f"getelementptr i8, ptr %memory, i64 {sum_.name}")
        return place, text.value(INT, f"and i64 {index.name}, 7")

    def store_bit(self, row: list[int]) -> None:
        text = self.text
        byte, bit = self._bit(row[1], row[3], row[4])
        mask = text.value("i8", f"trunc i64 {text.value(INT, f'shl i64 1, {bit.name}').name} to i8")
        before = text.value("i8", f"load i8, ptr {byte.name}")
        others = text.value("i8", f"and i8 {before.name}, {text.value('i8', f'xor i8 {mask.name}, -1').name}")
        with_it = text.value("i8", f"or i8 {before.name}, {mask.name}")
        test = text.value(BOOL, f"icmp ne i64 {self.integer(row[5]).name}, 0")
        after = text.value("i8", f"select i1 {test.name}, i8 {with_it.name}, i8 {others.name}")
        text.lines.append(f"  store i8 {after.name}, ptr {byte.name}")

    def store(self, row: list[int]) -> None:
        self._store(row, self.integer(row[5]), STORED[row[0]])

    def store_real(self, row: list[int]) -> None:
        self._store(row, bits_of(self.text, self.real(row[5])), 4)

    def _store(self, row: list[int], value: Value, size: int) -> None:
        text, kind = self.text, f"i{8 * size}"
        place = self.address(row[1], row[3], row[4])
        word = value if size == 8 else text.value(kind, f"trunc i64 {value.name} to {kind}")
        if size > 1:
            word = text.value(kind, f"call {kind} @llvm.bswap.{kind}({kind} {word.name})")
        text.lines.append(f"  store {kind} {word.name}, ptr {place.name}, align 1")

    def find(self, row: list[int]) -> None:
        text = self.text
        index, low, high, stride = (self.integer(slot).name for slot in row[2:6])
        text.leave_if(text.value(BOOL, f"icmp slt i64 {index}, {low}"))
        text.leave_if(text.value(BOOL, f"icmp sgt i64 {index}, {high}"))
        steps = text.value(INT, f"sub i64 {index}, {low}")
        self.put(row[1], text.value(INT, f"mul i64 {steps.name}, {stride}"))

    def fill(self, row: list[int]) -> None:
        place = self.address(row[1], ZERO, ZERO)
        byte = self.text.value("i8", f"trunc i64 {self.integer(row[4]).name} to i8")
        self.text.lines.append(
            f"  call void @llvm.memset.p0.i64(ptr {place.name}, i8 {byte.name}, i64 {row[3]}, i1 false)"
        )

    def copy(self, row: list[int]) -> None:
        target, source = self.address(row[1], row[2], row[3]), self.address(row[4], row[5], row[7])
        self._moved(target.name, source.name, row[6])

    def spread(self, row: list[int]) -> None:
        self._moved(self._place(row[1]), self._place(row[2]), 8 * row[3])
        for slot in range(row[1], row[1] + row[3]):
            for kind in (INT, REAL):
                self.known.pop((slot, kind), None)

    def _moved(self, target: str, source: str, size: int) -> None:
        self.text.lines.append(f"  call void @llvm.memmove.p0.p0.i64(ptr {target}, ptr {source}, i64 {size}, i1 false)")


LOADED: Mapping[int, tuple[int, str]] = {
    number: (calcsize(">" + code), "sext" if code.islower() else "zext")
    for code, number in encode.LOADS.items()
    if code != "f"
}
STORED: Mapping[int, int] = {number: calcsize(">" + code) for code, number in encode.STORES.items() if code != "f"}
ROWS: Mapping[int, Callable[[_Function, list[int]], None]] = {
    encode.BACK: _Function.back,
    encode.GO: _Function.go,
    encode.IF: _Function.when,
    encode.UNLESS: _Function.when,
    encode.CALL: _Function.call,
    encode.RETURN: _Function.back_to_caller,
    encode.MOVE: _Function.move,
    encode.FILL: _Function.fill,
    encode.COPY: _Function.copy,
    encode.LOAD_BIT: _Function.load_bit,
    encode.LOADS["f"]: _Function.load_real,
    **dict.fromkeys(LOADED, _Function.load),
    encode.STORE_BIT: _Function.store_bit,
    encode.STORES["f"]: _Function.store_real,
    **dict.fromkeys(STORED, _Function.store),
    encode.FIND: _Function.find,
    encode.SPREAD: _Function.spread,
}  # fmt: skip
