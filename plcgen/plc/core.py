"""The core: the small, flat, typed language that every PLC language lowers to and every engine runs.

A function is a list of instructions over places. Memory is bytes: `Cell` views some bits of an area as a type, so
overlapping views cost nothing. A `Register` has a value and no address.

An area is a data block by its name, or one of `Area`: no name that a source gives a block can be one of those.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

from plcgen.plc.operators import Operator
from plcgen.plc.source import SourceText, Span
from plcgen.plc.types import BIT_STRINGS, BYTE_BITS, Elementary, Structure, Type, Value

# --------------------------------------------------------------------------------------------------------- places


class Area(Enum):
    """Memory outside data blocks. FRAME is that of the running function, INSTANCE the data of the running FB."""

    INPUTS = "I"
    OUTPUTS = "Q"
    MEMORY = "M"
    PERIPHERAL_INPUTS = "PI"
    PERIPHERAL_OUTPUTS = "PQ"
    FRAME = "L"
    INSTANCE = "D"

    def __str__(self) -> str:
        return self.value


FRAME, INSTANCE = Area.FRAME, Area.INSTANCE
GLOBAL_AREAS = tuple(area for area in Area if area not in (FRAME, INSTANCE))


@dataclass(frozen=True)
class Register:
    """A value without an address; `name` is for readers only."""

    number: int
    type: Elementary
    name: str = ""

    def __str__(self) -> str:
        return f"#{self.name}" if self.name else f"%{self.number}"


@dataclass(frozen=True)
class Cell:
    """Bits of memory viewed as a type; `index` is a DINT register with further bits, known at run time only."""

    area: Area | str
    bit: int
    type: Type
    index: Register | None = None

    def __str__(self) -> str:
        index = f" + {self.index}" if self.index else ""
        return f"{self.area}[{self.bit // BYTE_BITS}.{self.bit % BYTE_BITS}{index}]"


@dataclass(frozen=True)
class Literal:
    value: Value
    type: Type

    def __str__(self) -> str:
        return f"16#{int(self.value):X}" if self.type in BIT_STRINGS else repr(self.value)


Place = Register | Cell
Operand = Register | Cell | Literal

# --------------------------------------------------------------------------------------------------- instructions


@dataclass(frozen=True)
class Compute:
    """target := operator(operands)"""

    span: Span
    target: Place
    operator: Operator
    operands: tuple[Operand, ...]


@dataclass(frozen=True)
class Label:
    span: Span
    name: str


@dataclass(frozen=True)
class Jump:
    """Go on at the label. `passes`: how often at the most before a loop ends, where the text says so."""

    span: Span
    label: str
    passes: int | None = None


@dataclass(frozen=True)
class Branch:
    """Jump to the label when the BOOL condition equals `when`."""

    span: Span
    condition: Operand
    label: str
    when: bool = True


@dataclass(frozen=True)
class Call:
    """Run a function; `instance` is the data of an FB, `results` take what an FC returns."""

    span: Span
    function: str
    instance: Cell | None = None
    arguments: tuple[Operand, ...] = ()
    results: tuple[Place, ...] = ()


@dataclass(frozen=True)
class Return:
    span: Span


Instruction = Compute | Label | Jump | Branch | Call | Return

# ------------------------------------------------------------------------------------------------------- programs


@dataclass(frozen=True)
class Function:
    """One executable block.

    `parameters` take the arguments and `results` are handed back, both in order. `temporaries` and the frame of
    `frame_bytes` hold a fill pattern at entry. A function with `frame_given` gets its frame from its caller (an OB,
    whose first bytes the operating system writes).
    """

    name: str
    source: SourceText = field(repr=False)
    body: tuple[Instruction, ...]
    span: Span
    instance: Structure | None = None
    parameters: tuple[Place, ...] = ()
    results: tuple[Place, ...] = ()
    temporaries: tuple[Register, ...] = ()
    frame_bytes: int = 0
    frame_given: bool = False


@dataclass(frozen=True)
class DataBlock:
    """`initial` is its memory at a cold start; `function` the FB it belongs to, if any."""

    name: str
    type: Structure
    initial: bytes = field(repr=False)
    function: str | None = None


@dataclass(frozen=True)
class Program:
    """Functions and data blocks by absolute name; `symbols` (in lower case) stand for such names or addresses."""

    functions: Mapping[str, Function]
    data_blocks: Mapping[str, DataBlock] = field(default_factory=dict)
    symbols: Mapping[str, str] = field(default_factory=dict)


# -------------------------------------------------------------------------------------------------------- printer


INFIX = frozenset(["+", "-", "*", "/", "**", "MOD", "DIV", "=", "<>", "<", "<=", ">", ">=", "AND", "OR", "XOR"])


def print_program(program: Program) -> str:
    """The whole program as text, one paragraph for each function."""
    return "\n\n".join(print_function(function) for function in program.functions.values())


def print_function(function: Function) -> str:
    """One function as readable text."""
    signature = f"({_typed(function.parameters)}) -> ({_typed(function.results)})"
    head = f"{function.name}{signature if function.parameters or function.results else ''}:"
    return "\n".join([head, *(print_instruction(instruction) for instruction in function.body)])


def print_instruction(instruction: Instruction) -> str:
    """One instruction as text: labels at the margin, everything else indented."""
    match instruction:
        case Label(name=name):
            return f"{name}:"
        case Compute(target=target, operator=operator, operands=operands):
            return f"    {target}:{target.type} := {_expression(operator, operands)}"
        case Jump(label=label):
            return f"    jump {label}"
        case Branch(condition=condition, label=label, when=when):
            return f"    if {'' if when else 'not '}{condition} jump {label}"
        case Call(function=name, instance=instance, arguments=arguments, results=results):
            received = f"{_listed(results)} := " if results else ""
            return f"    {received}call {name}{f' on {instance}' if instance else ''}({_listed(arguments)})"
        case Return():
            return "    return"


def _expression(operator: Operator, operands: tuple[Operand, ...]) -> str:
    if operator.name == "MOVE":
        return str(operands[0])
    if operator.name in INFIX and len(operands) == 2:
        return f"{operands[0]} {operator.name} {operands[1]}"
    return f"{operator.name}({_listed(operands)})"


def _listed(operands: tuple[Operand, ...]) -> str:
    return ", ".join(map(str, operands))


def _typed(places: tuple[Place, ...]) -> str:
    return ", ".join(f"{place}:{place.type}" for place in places)
