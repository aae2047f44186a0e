"""Calls of FCs, FB instances and multi-instances."""

from __future__ import annotations

from dataclasses import replace

from plcgen.plc.core import Cell, Operand, Place, Register
from plcgen.plc.scl import syntax
from plcgen.plc.scl.functions import FUNCTIONS, is_absent
from plcgen.plc.scl.lowering_declarations import Interface, Parameter
from plcgen.plc.scl.lowering_expressions import Expressions, calls_block
from plcgen.plc.scl.lowering_places import FLAG_HINTS, flag_refusal
from plcgen.plc.scl.lowering_values import Value, expect
from plcgen.plc.scl.syntax import BlockKind, SectionKind
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import Elementary, Type

INPUT, OUTPUT, IN_OUT = SectionKind.INPUT, SectionKind.OUTPUT, SectionKind.IN_OUT
Bound = list[tuple[Parameter, syntax.Argument]]


class Calls(Expressions):
    """Lowers calls. IN_OUT is copied in and out."""

    def block_call(self, node: syntax.Call) -> Value | None:
        instance = self._multi_instance(node.callee)
        if instance is None:
            return self._global_call(node)
        interface = self.catalogue.instance_interface(instance.type)
        if interface is None:
            raise self.source.error(f"{node.callee.name} is {instance.type}; it cannot be called", node.callee.span)
        self._call_instance(node, interface, instance)
        return None

    def _multi_instance(self, callee: syntax.Variable) -> Cell | None:
        local = self.local(callee)
        if local is None or self._is_own_name(callee):
            return None
        place = self.place(callee)
        if isinstance(place, Cell):
            return place
        raise self.source.error(f"{callee.name} is {place.type}; it cannot be called", callee.span)

    def _is_own_name(self, callee: syntax.Variable) -> bool:
        """Inside an FC its name is the result as well as the block."""
        return self.catalogue.find(callee.name, BlockKind.FC) is self.block

    def _global_call(self, node: syntax.Call) -> Value | None:
        function = self.catalogue.find(node.callee.name, BlockKind.FC)
        if function is not None and node.callee.scope is not syntax.Scope.LOCAL:
            return self._call_function(node, self.catalogue.interface(function))
        interface, instance = self._named_instance(node.callee)
        self._call_instance(node, interface, instance)
        return None

    def _named_instance(self, callee: syntax.Variable) -> tuple[Interface, Cell]:
        """The FB and its data behind `FB100.DB100` or the name of an instance DB."""
        local = callee.scope is syntax.Scope.LOCAL
        block = None if local else self.catalogue.find(callee.name, BlockKind.FB)
        if block is not None:
            interface = self.catalogue.interface(block)
            return interface, self._data_block_of(callee, interface)
        data = None if local else self.catalogue.data_block(callee.name)
        owner = self.catalogue.instance_interface(data.type) if data else None
        if data is None or owner is None:
            raise self.source.error(self._unknown_callee(callee.name), callee.span)
        return owner, Cell(data.name, 0, data.type)

    def _unknown_callee(self, name: str) -> str:
        if is_absent(name):
            return f"{name} is not supported yet; a block {name} in your source can stand in for it"
        return f"unknown block or function {name}{did_you_mean(name, [*FUNCTIONS, *self.catalogue.names()])}"

    # ------------------------------------------------------------------------------------------------- FB instances

    def _data_block_of(self, callee: syntax.Variable, interface: Interface) -> Cell:
        """`FB100.DB100( )`; the data block is made when nobody declared it."""
        match callee.selectors:
            case (syntax.Member(name=name),):
                data = self.catalogue.create_instance(name, interface)
            case _:
                message = f"{callee.name} is an FB; call it with an instance, as {callee.name}.DB1( )"
                raise self.source.error(message, callee.span)
        if data.type != interface.instance:
            raise self.source.error(f"{data.name} is no instance of {interface.name}", callee.span)
        return Cell(data.name, 0, data.type)

    def _call_instance(self, node: syntax.Call, interface: Interface, instance: Cell) -> None:
        bound = self._bind(node, interface)
        places = self._places(bound)
        for parameter, argument in bound:
            if parameter.kind is not OUTPUT:
                value = places.get(parameter.name) or self._input(parameter, argument)
                self.builder.span = argument.span
                self.builder.move(self._member(instance, parameter), value)
        self.builder.span = node.span
        self.builder.call(interface.name, instance)
        for parameter, argument in bound:
            if parameter.name in places:
                self._deliver(argument, self._member(instance, parameter), places[parameter.name])

    @staticmethod
    def _member(instance: Cell, parameter: Parameter) -> Cell:
        member = instance.type.member(parameter.name)  # type: ignore[union-attr]
        assert member is not None
        return replace(instance, bit=instance.bit + member.bit, type=member.type)

    # ---------------------------------------------------------------------------------------------------------- FCs

    def _call_function(self, node: syntax.Call, interface: Interface) -> Value | None:
        bound = self._bind(node, interface)
        given = {parameter.name: argument for parameter, argument in bound}
        missing = [parameter.name for parameter in interface.parameters if parameter.name not in given]
        if missing:
            raise self.source.error(f"{interface.name} needs parameter {missing[0]}", node.span)
        places = self._places(bound)
        values = {**places, **self._inputs(bound)}
        arguments = tuple(values[parameter.name] for parameter in interface.of_kinds(INPUT, IN_OUT))
        outputs = interface.of_kinds(OUTPUT, IN_OUT)
        received = [self._receiver(parameter.type) for parameter in outputs]
        result = [self._receiver(interface.result)] if interface.result is not None else []
        self.builder.span = node.span
        self.builder.call(interface.name, None, arguments, (*result, *received))
        for parameter, place in zip(outputs, received, strict=True):
            self._deliver(given[parameter.name], place, places[parameter.name])
        return result[0] if result else None

    def _receiver(self, kind: Type) -> Place:
        return self.builder.register(kind) if isinstance(kind, Elementary) else self.builder.frame(kind)

    # --------------------------------------------------------------------------------------------------- arguments

    def _bind(self, node: syntax.Call, interface: Interface) -> Bound:
        """Each argument with its parameter."""
        arguments, parameters = node.arguments, interface.parameters
        if len(arguments) == len(parameters) == 1 and arguments[0].name is None and parameters[0].kind is not OUTPUT:
            return [(parameters[0], arguments[0])]
        bound = [(self._parameter(interface, argument), argument) for argument in arguments]
        names = [parameter.name for parameter, _ in bound]
        for number, name in enumerate(names):
            if name in names[:number]:
                raise self.source.error(f"{name} is given twice", arguments[number].span)
        return bound

    def _parameter(self, interface: Interface, argument: syntax.Argument) -> Parameter:
        if argument.name is None:
            raise self.source.error(f"name the parameter of {interface.name}, as in `x := ...`", argument.span)
        parameter = interface.parameter(argument.name)
        if parameter is None and argument.name.upper() in FLAG_HINTS:
            raise self.source.error(flag_refusal(argument.name), argument.span)
        if parameter is None:
            hint = did_you_mean(argument.name, [parameter.name for parameter in interface.parameters])
            raise self.source.error(f"{interface.name} has no parameter {argument.name}{hint}", argument.span)
        self._check_arrow(interface, parameter, argument)
        return parameter

    def _check_arrow(self, interface: Interface, parameter: Parameter, argument: syntax.Argument) -> None:
        name, output = parameter.name, parameter.kind is OUTPUT
        if argument.is_output and not output:
            raise self.source.error(f"{name} is no output of {interface.name}; write {name} := ...", argument.span)
        if output and not argument.is_output and self.dialect.output_arrow:
            raise self.source.error(f"{name} is an output of {interface.name}; write {name} => ...", argument.span)
        if output and interface.kind is BlockKind.FB and not self.dialect.output_arrow:
            message = f"{name} is an output of {interface.name}; read it from the instance after the call"
            raise self.source.error(message, argument.span)

    def _places(self, bound: Bound) -> dict[str, Place]:
        """Where the call writes to, by parameter: found before it runs, since it may change an index."""
        return {parameter.name: self._place(parameter, given) for parameter, given in bound if parameter.kind != INPUT}

    def _place(self, parameter: Parameter, argument: syntax.Argument) -> Place:
        node = argument.value
        found = self.read(node) if isinstance(node, syntax.Variable | syntax.Address) else None
        if parameter.kind is IN_OUT and (not isinstance(found, Cell | Register) or found.type != parameter.type):
            message = f"{parameter.name} is read and written; give it a variable of type {parameter.type}"
            raise self.source.error(message, node.span)
        if isinstance(found, Cell | Register):
            return found
        raise self.source.error(f"{parameter.name} is an output; give it a variable to write to", node.span)

    def _inputs(self, bound: Bound) -> dict[str, Operand]:
        """Input values from left to right; one that a later call could change is taken before that call."""
        inputs: dict[str, Operand] = {}
        for number, (parameter, argument) in enumerate(bound):
            if parameter.kind is INPUT:
                value = self._input(parameter, argument)
                later = [given.value for _, given in bound[number + 1 :]]
                inputs[parameter.name] = self.taken(value) if calls_block(later) else value
        return inputs

    def _input(self, parameter: Parameter, argument: syntax.Argument) -> Operand:
        value = self.value(argument.value)
        return expect(self.source, self.builder, value, parameter.type, argument.value.span)

    def _deliver(self, argument: syntax.Argument, source: Operand, target: Place) -> None:
        """Copy what a block hands back into the variable of the call."""
        value = expect(self.source, self.builder, source, target.type, argument.value.span)
        self.builder.span = argument.span
        self.builder.move(target, value)
