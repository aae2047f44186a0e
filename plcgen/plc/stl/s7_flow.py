"""Jumps, the end of a block, data blocks and address registers of the S7-300."""

from __future__ import annotations

from collections.abc import Callable

from plcgen.plc.core import Literal, Operand, Register
from plcgen.plc.scl.syntax import BlockKind
from plcgen.plc.scl.syntax import Scope as Spelling
from plcgen.plc.stl import s7_syntax as syntax
from plcgen.plc.stl.s7_arithmetic import put_low
from plcgen.plc.stl.s7_code import Code
from plcgen.plc.stl.s7_operators import CONDITIONS, MOVE_POINTER, QUIET_SUM, STATUS_BITS, STATUS_CODES, row
from plcgen.plc.stl.s7_places import ADDRESS_REGISTERS, place_of, pointer_to, value_of, word_place
from plcgen.plc.stl.s7_registers import ACCU1, AR1, AR2, BR, CC, FALSE, FC, OR, OS, OV, RLO, TRUE
from plcgen.plc.stl.s7_selection import jump_list
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import BYTE, DINT, DWORD, INT, WORD, Elementary

Jump = Callable[[Code, str], None]

# ----------------------------------------------------------------------------------------------------------- labels


def core_label(name: str) -> str:
    """With a point, so that none of ours is the same."""
    return f".{name}"


def label_of(code: Code, operand: syntax.Operand) -> str:
    """Where a jump goes: a label of the same block."""
    assert isinstance(operand, syntax.LabelName)
    names = [statement.label.name for statement in code.block.statements if statement.label]
    if operand.name not in names:
        hint = did_you_mean(operand.name, names) or f"; write {operand.name}: before an instruction"
        other_case = next((name for name in names if name.casefold() == operand.name.casefold()), None)
        hint = f"; {other_case} is another, case counts" if other_case else hint
        raise code.error(f"no label {operand.name} in {code.block.name}{hint}", operand)
    return core_label(operand.name)


# ------------------------------------------------------------------------------------------------------------ jumps


def jump(code: Code, label: str) -> None:
    """JU"""
    code.builder.jump(label)


def on_rlo(when: bool, saves: bool = False) -> Jump:
    """JC, JCN; JCB and JNB copy the RLO to BR. Behind any of them the RLO is 1."""

    def emit(code: Code, label: str) -> None:
        rlo = code.taken(RLO)
        if saves:
            code.put(BR, rlo)
        code.put(RLO, TRUE)
        code.end_of_logic()
        code.builder.branch(rlo, label, when)

    return emit


def on_br(when: bool) -> Jump:
    """JBI, JNBI"""

    def emit(code: Code, label: str) -> None:
        code.end_of_logic()
        code.builder.branch(BR, label, when)

    return emit


def on_overflow(code: Code, label: str) -> None:
    """JO"""
    code.builder.branch(OV, label, True)


def on_stored_overflow(code: Code, label: str) -> None:
    """JOS: OS is 0 behind it."""
    stored = code.taken(OS)
    code.put(OS, FALSE)
    code.builder.branch(stored, label, True)


def on_codes(condition: str) -> Jump:
    """JZ, JN, JP, JM, JPZ, JMZ, JUO"""
    return lambda code, label: code.builder.branch(code.compute(CONDITIONS[condition], CC), label, True)


def distribute(code: Code, label: str) -> None:
    """JL: ACCU1-LL says which of the JU behind it is taken; beyond them the jump goes to the label."""
    number = code.view(BYTE)
    listed = jump_list(code.block.statements, code.block.statements.index(code.statement))
    for place, statement in enumerate(listed):
        if place > BYTE.maximum or not statement.operands:
            break
        chosen = code.compute(row("=", BYTE, BYTE), number, Literal(place, BYTE))
        code.builder.branch(chosen, label_of(code, statement.operands[0]), True)
    code.builder.jump(label)


def loop(code: Code, label: str) -> None:
    """LOOP: ACCU1-L counts down; the jump is taken until it is 0."""
    left = code.compute(QUIET_SUM[INT], code.view(INT), Literal(-1, INT))
    put_low(code, left)
    code.builder.branch(code.compute(row("=", INT, INT), left, Literal(0, INT)), label, False)


# ------------------------------------------------------------------------------------------------------ end of block


def leave(code: Code) -> None:
    """BE, BEU"""
    code.builder.jump(code.end)


def leave_if(code: Code) -> None:
    """BEC"""
    on_rlo(True)(code, code.end)


# -------------------------------------------------------------------------------------------------------- transport


def load(code: Code, operand: syntax.Operand) -> None:
    """L: the value into ACCU1, the old ACCU1 into ACCU2"""
    code.load(value_of(code, operand))


def transfer(code: Code, operand: syntax.Operand) -> None:
    """T: what the operand holds of ACCU1"""
    if isinstance(operand, syntax.Status) and operand.name == "STW":
        _transfer_status(code)
        return
    if isinstance(operand, syntax.Constant | syntax.Text):
        raise code.error(f"{code.text(operand)} is a constant; T writes to a variable or an address", operand)
    target = word_place(code, operand)
    assert isinstance(target.type, Elementary)
    code.put(target, code.view(target.type))


def _transfer_status(code: Code) -> None:
    """T STW: all bits at once"""
    word = code.view(WORD)
    for name, register in {"FC": FC, "RLO": RLO, "OR": OR, "OS": OS, "OV": OV, "BR": BR}.items():
        code.put(register, code.compute(STATUS_BITS[name], word))
    code.put(CC, code.compute(STATUS_CODES, word))


# ------------------------------------------------------------------------------------------------ address registers


def load_pointer(register: Register) -> Callable[..., None]:
    """LAR1, LAR2: from ACCU1, the other register, a pointer or a double word"""

    def emit(code: Code, operand: syntax.Operand | None = None) -> None:
        _check_register(code, register)
        code.put(register, ACCU1 if operand is None else _pointer_value(code, operand))

    return emit


def _pointer_value(code: Code, operand: syntax.Operand) -> Operand:
    if isinstance(operand, syntax.RegisterName) and operand.name in ADDRESS_REGISTERS:
        _check_register(code, ADDRESS_REGISTERS[operand.name])
        return ADDRESS_REGISTERS[operand.name]
    if isinstance(operand, syntax.PointerTo):
        return pointer_to(code, operand)
    value = value_of(code, operand)
    if value.type.bits != DWORD.bits:
        raise code.error(f"{code.text(operand)} is {value.type}; a pointer is a DWORD, such as P#M 0.0", operand)
    return code.bits(code.taken(value))


def store_pointer(register: Register) -> Callable[..., None]:
    """TAR1, TAR2: to ACCU1, the other register or a double word"""

    def emit(code: Code, operand: syntax.Operand | None = None) -> None:
        _check_register(code, register)
        if operand is None:
            code.load(register)
        elif isinstance(operand, syntax.RegisterName) and operand.name in ADDRESS_REGISTERS:
            _check_register(code, ADDRESS_REGISTERS[operand.name])
            code.put(ADDRESS_REGISTERS[operand.name], register)
        else:
            _store_to_memory(code, operand, register)

    return emit


def _store_to_memory(code: Code, operand: syntax.Operand, register: Register) -> None:
    target = place_of(code, operand)
    if not isinstance(target.type, Elementary) or target.type.bits != DWORD.bits:
        raise code.error(f"{code.text(operand)} is {target.type}; a pointer is a DWORD", operand)
    code.put(target, code.view(target.type, register))


def move_pointer(register: Register) -> Callable[..., None]:
    """+AR1, +AR2: by ACCU1-L or a constant; the area stays"""

    def emit(code: Code, operand: syntax.Operand | None = None) -> None:
        _check_register(code, register)
        if operand is None:
            offset: Operand = code.compute(row("INT_TO_DINT", INT), code.view(INT))
        elif isinstance(operand, syntax.Constant) and operand.kind is DWORD and not int(operand.value) >> 24:
            offset = Literal(int(operand.value), DINT)
        else:
            raise code.error(f"{code.text(operand)}: {code.statement.word} takes P#byte.bit, such as P#2.0", operand)
        code.put(register, code.compute(MOVE_POINTER, register, offset))

    return emit


def swap_pointers(code: Code) -> None:
    """CAR"""
    _check_register(code, AR2)
    first = code.taken(AR1)
    code.put(AR1, AR2)
    code.put(AR2, first)


def _check_register(code: Code, register: Register) -> None:
    """The instance of an FB is found through AR2."""
    if register is AR2 and code.scope.interface.kind is BlockKind.FB:
        raise code.error("AR2 holds the place of the instance in a FUNCTION_BLOCK; use AR1")


# ------------------------------------------------------------------------------------------------------ data blocks


def open_block(code: Code, operand: syntax.Operand) -> None:
    """OPN: which block that is was found out before; it is only checked here."""
    name = operand.name if isinstance(operand, syntax.BlockName | syntax.Variable) else ""
    local = isinstance(operand, syntax.Variable) and operand.scope is Spelling.LOCAL
    is_block = not (isinstance(operand, syntax.BlockName) and operand.kind not in ("DB", "DI"))
    if not name or local or not is_block:
        message = f"{code.text(operand)}: which block is opened must be known here; write OPN DB 1 or OPN DI 1"
        raise code.error(message, operand)
    if isinstance(operand, syntax.BlockName) and operand.kind == "DI":
        _keep_instance(code)
    if code.catalogue.data_block(name) is None:
        known = [block for block in code.catalogue.names() if code.catalogue.find(block, BlockKind.DB)]
        raise code.error(f"{name} is no data block of this source{did_you_mean(name, known)}", operand)


def swap_blocks(code: Code) -> None:
    """CDB"""
    _keep_instance(code)


def _keep_instance(code: Code) -> None:
    if code.scope.interface.kind is BlockKind.FB:
        raise code.error("the register DI holds the instance in a FUNCTION_BLOCK; use OPN DB")


def nothing(_code: Code, _operand: syntax.Operand) -> None:
    """NOP, BLD"""
