"""CALL, UC and CC of the S7-300."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from plcgen.plc.core import Cell, Literal, Operand, Place, Register
from plcgen.plc.scl.lowering_declarations import Interface, Parameter
from plcgen.plc.scl.syntax import BlockKind, SectionKind
from plcgen.plc.scl.syntax import Scope as Spelling
from plcgen.plc.stl import s7_syntax as syntax
from plcgen.plc.stl.s7_code import Code
from plcgen.plc.stl.s7_places import place_of, pointer_to
from plcgen.plc.stl.s7_registers import CELLS, FALSE, KEPT, OS, RLO, TRUE
from plcgen.plc.stl.s7_scope import RESULT
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import BOOL, BYTE, CHAR, DINT, INT, REAL, Elementary, String, Type

INPUT, OUTPUT, IN_OUT = SectionKind.INPUT, SectionKind.OUTPUT, SectionKind.IN_OUT
_SYSTEM = ("SFC", "SFB")


@dataclass
class Handovers:
    """Which registers each block reads that another one set: at its start, and callers behind it."""

    entry: defaultdict[str, set[Register]] = field(default_factory=lambda: defaultdict(set))
    exit: defaultdict[str, set[Register]] = field(default_factory=lambda: defaultdict(set))


Bound = list[tuple[Parameter, syntax.Argument]]


@dataclass(frozen=True)
class Calls:
    """Writes calls of one block."""

    code: Code
    handovers: Handovers

    # ------------------------------------------------------------------------------------------------- instructions

    def call(self) -> None:
        """CALL"""
        operands = self.code.statement.operands
        if not operands:
            raise self.code.error("CALL of what? write CALL FB 1, DB 1 or CALL FC 1")
        instance = self._multi_instance(operands[0])
        if instance is not None:
            self._refuse_instance(operands[1:])
            self._call_instance(self._owner(operands[0], instance), instance)
            return
        interface = self._interface(operands[0])
        if interface.kind is BlockKind.FB:
            self._call_instance(interface, self._instance(interface, operands))
        else:
            self._refuse_instance(operands[1:])
            self._call_function(interface)

    def plain(self, operand: syntax.Operand) -> None:
        """UC"""
        interface = self._interface(operand)
        if interface.kind is not BlockKind.FC or interface.parameters or interface.result:
            word = self.code.statement.word
            message = f"{word} takes an FC without parameters, {interface.name} is none; write CALL {interface.name}"
            raise self.code.error(message, operand)
        self._run(interface.name)

    def conditional(self, operand: syntax.Operand) -> None:
        """CC: when the RLO is 1. OS and RLO are set whether it is or not."""
        code = self.code
        rlo, behind = code.taken(RLO), code.builder.label()
        code.put(RLO, TRUE)
        code.put(OS, FALSE)
        code.end_of_logic()
        code.builder.branch(rlo, behind, False)
        self.plain(operand)
        code.builder.place(behind)

    # ------------------------------------------------------------------------------------------------------- blocks

    def _interface(self, operand: syntax.Operand) -> Interface:
        code = self.code
        if isinstance(operand, syntax.BlockName) and operand.kind in _SYSTEM:
            message = f"{code.text(operand)} is not supported; a block of your own in the source can stand in for it"
            raise code.error(message, operand)
        name = operand.name if isinstance(operand, syntax.BlockName | syntax.Variable) else code.text(operand)
        block = code.catalogue.find(name, BlockKind.FB, BlockKind.FC)
        if block is None:
            raise code.error(f"no FB or FC {name}{did_you_mean(name, code.catalogue.names())}", operand)
        return code.catalogue.interface(block)

    def _multi_instance(self, operand: syntax.Operand) -> Cell | None:
        if not isinstance(operand, syntax.Variable) or operand.scope is Spelling.GLOBAL:
            return None
        place = self.code.scope.place(operand)
        if place is None and operand.scope is Spelling.LOCAL:
            raise self.code.error(self.code.scope.unknown(operand), operand)
        return place if isinstance(place, Cell) else None

    def _owner(self, operand: syntax.Operand, instance: Cell) -> Interface:
        interface = self.code.catalogue.instance_interface(instance.type)
        if interface is None:
            raise self.code.error(f"{self.code.text(operand)} is {instance.type}; it cannot be called", operand)
        return interface

    def _refuse_instance(self, operands: Sequence[syntax.Operand]) -> None:
        if operands:
            raise self.code.error("only an FB takes a data block; remove it", operands[0])

    def _instance(self, interface: Interface, operands: Sequence[syntax.Operand]) -> Cell:
        code = self.code
        name = operands[1].name if len(operands) > 1 and hasattr(operands[1], "name") else None
        if name is None:
            raise code.error(f"{interface.name} is an FB; call it with an instance, as CALL {interface.name}, DB 1")
        data = code.catalogue.create_instance(name, interface)
        if data.type != interface.instance:
            raise code.error(f"{data.name} is no instance of {interface.name}", operands[1])
        return Cell(data.name, 0, data.type)

    # -------------------------------------------------------------------------------------------------------- calls

    def _run(
        self,
        function: str,
        instance: Cell | None = None,
        arguments: tuple[Operand, ...] = (),
        results: tuple[Place, ...] = (),
    ) -> None:
        """The call itself; what both sides read of each other's registers goes through memory."""
        code = self.code
        for register in sorted(self.handovers.entry[function], key=KEPT.index):
            code.put(CELLS[register], register)
        code.builder.call(function, instance, arguments, results)
        for register in KEPT:
            code.put(register, CELLS[register])
        code.put(OS, FALSE)
        code.end_of_logic()

    def _call_instance(self, interface: Interface, instance: Cell) -> None:
        bound = self._bind(interface)
        for parameter, argument in bound:
            if parameter.kind is not OUTPUT:
                self.code.put(_member(instance, parameter), self._input(parameter, argument))
        self._run(interface.name, instance)
        for parameter, argument in bound:
            if parameter.kind is not INPUT:
                self.code.put(self._output(parameter, argument), _member(instance, parameter))

    def _call_function(self, interface: Interface) -> None:
        result = (Parameter(RESULT, OUTPUT, interface.result),) if interface.result else ()
        complete = replace(interface, parameters=(*result, *interface.parameters))
        given = {parameter.name: argument for parameter, argument in self._bind(complete)}
        missing = [parameter.name for parameter in complete.parameters if parameter.name not in given]
        if missing:
            raise self.code.error(f"{interface.name} needs parameter {missing[0]}")
        ordered = (*result, *complete.of_kinds(INPUT), *interface.of_kinds(OUTPUT), *complete.of_kinds(IN_OUT))
        arguments = tuple(
            self._input(p, given[p.name]) if p.kind is INPUT else self._output(p, given[p.name]) for p in ordered
        )
        results = tuple(place for p, place in zip(ordered, arguments, strict=True) if p.kind is not INPUT)
        self._run(interface.name, None, arguments, results)  # type: ignore[arg-type]

    # -------------------------------------------------------------------------------------------------- parameters

    def _bind(self, interface: Interface) -> Bound:
        bound: Bound = []
        for argument in self.code.statement.arguments:
            parameter = interface.parameter(argument.name)
            if parameter is None:
                hint = did_you_mean(argument.name, [p.name for p in interface.parameters])
                raise self.code.error(f"{interface.name} has no parameter {argument.name}{hint}", argument.span)
            if any(parameter is other for other, _ in bound):
                raise self.code.error(f"{argument.name} is given twice", argument.span)
            bound.append((parameter, argument))
        return bound

    def _input(self, parameter: Parameter, argument: syntax.Argument) -> Operand:
        operand = argument.operand
        if isinstance(operand, syntax.Constant | syntax.Text) and parameter.kind is INPUT:
            return self._constant(parameter, operand)
        if isinstance(operand, syntax.PointerTo) and parameter.kind is INPUT:
            return pointer_to(self.code, operand)
        return self._output(parameter, argument)

    def _constant(self, parameter: Parameter, operand: syntax.Constant | syntax.Text) -> Operand:
        code, kind = self.code, parameter.type
        text = code.text(operand)
        if isinstance(kind, String) and text.startswith("'"):
            return Literal(kind.encode(text[1:-1]), kind)
        if isinstance(operand, syntax.Constant) and (operand.kind is kind or (operand.kind, kind) == (BYTE, CHAR)):
            return Literal(operand.value, kind)
        message = f"{text} is no {kind}, which {parameter.name} takes{_way_out(kind, operand)}"
        raise code.error(message, operand)

    def _output(self, parameter: Parameter, argument: syntax.Argument) -> Place:
        """The variable of a parameter; an address is of any type of its width."""
        code, operand = self.code, argument.operand
        if isinstance(operand, syntax.Constant | syntax.Text | syntax.PointerTo):
            raise code.error(f"{parameter.name} is written; give it a variable", operand)
        place = place_of(code, operand)
        if place.type == parameter.type:
            return place
        bare = isinstance(operand, syntax.Absolute | syntax.Indirect | syntax.RegisterIndirect)
        if bare and isinstance(place, Cell) and place.type.bits == parameter.type.bits:
            return replace(place, type=parameter.type)
        message = f"{code.text(operand)} is {place.type}, {parameter.name} takes {parameter.type}"
        raise code.error(message, operand)


def _way_out(kind: Type, operand: syntax.Constant | syntax.Text) -> str:
    value = operand.value
    if kind is BOOL:
        return "; write TRUE or FALSE"
    if kind is DINT and isinstance(value, int):
        return f"; write L#{value}"
    if kind is REAL and isinstance(value, int):
        return f"; write {value}.0"
    if kind is INT and isinstance(value, float):
        return f"; write {value:.0f}"
    examples = {"WORD": "W#16#0", "DWORD": "DW#16#0", "BYTE": "B#16#0", "TIME": "T#1s", "S5TIME": "S5T#1s"}
    example = examples.get(str(kind)) if isinstance(kind, Elementary) else None
    return f"; write it like {example}" if example else ""


def _member(instance: Cell, parameter: Parameter) -> Cell:
    member = instance.type.member(parameter.name)  # type: ignore[union-attr]
    assert member is not None
    return replace(instance, bit=instance.bit + member.bit, type=member.type)
