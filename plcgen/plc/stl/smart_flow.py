"""Program control of the S7-200 SMART: jumps, loops, calls, interrupts, what the CPU does."""

from __future__ import annotations

from collections.abc import Callable

from plcgen.plc.core import Cell, Literal, Operand
from plcgen.plc.operators import Operator, move
from plcgen.plc.stl import syntax
from plcgen.plc.stl.lowering_interface import Local, locals_of
from plcgen.plc.stl.smart_operators import ATCH
from plcgen.plc.stl.smart_rung import FALSE, TRUE, Loop, Rung, Step
from plcgen.plc.stl.smart_slots import block
from plcgen.plc.stl.syntax import BlockKind
from plcgen.plc.types import BOOL, INT

ONE = Literal(1, INT)

# ---------------------------------------------------------------------------------------------------------- jumps


def label_name(number: int) -> str:
    return f"LBL{number}"


def jump(rung: Rung, number: int) -> None:
    """JMP n: to LBL n of the same block when the top is 1."""
    if number not in labels_of(rung.block):
        raise rung.error(f"no LBL {number} in {rung.block.shown}; a jump stays in its block")
    rung.builder.branch(rung.top, label_name(number), when=True)


def label(rung: Rung, number: int) -> None:
    """LBL n"""
    if number in rung.labels:
        raise rung.error(f"LBL {number} stands twice in {rung.block.shown}; give one another number")
    rung.labels.add(number)
    rung.builder.place(label_name(number))


def labels_of(block: syntax.Block) -> set[int]:
    """Numbers of the LBL of a block."""
    statements = (statement for network in block.networks for statement in network.statements)
    operands = (item.operands[0] for item in statements if item.mnemonic == "LBL" and item.operands)
    return {int(item.value) for item in operands if isinstance(item, syntax.Constant)}


def leave(rung: Rung) -> None:
    """CRET, CRETI, END: the block ends here when the top is 1."""
    rung.open_guard()
    rung.builder.leave()
    rung.close_guard()


# ---------------------------------------------------------------------------------------------------------- loops


def begin_loop(rung: Rung, index: Cell, first: Operand, last: Operand) -> None:
    """FOR INDX, INIT, FINAL: up to NEXT, for each number; not at all when INIT is above FINAL."""
    builder = rung.builder
    loop = Loop(rung.statement, index, builder.label(), builder.label())
    builder.branch(rung.top, loop.leave, when=False)
    builder.move(index, first)
    builder.place(loop.repeat)
    builder.branch(rung.compute(">", index, last), loop.leave, when=True)
    rung.loops.append(loop)


def end_loop(rung: Rung) -> None:
    """NEXT"""
    if not rung.loops:
        raise rung.error("NEXT without FOR; write FOR above it")
    loop = rung.loops.pop()
    rung.builder.move(loop.index, rung.compute("+", loop.index, ONE))
    rung.builder.jump(loop.repeat)
    rung.builder.place(loop.leave)


# ------------------------------------------------------------------------------------------------ sequence control


def begin_step(rung: Rung, bit: Cell) -> None:
    """LSCR S bit: up to SCRE the program runs only while the bit is 1."""
    if rung.step is not None:
        raise rung.error("LSCR inside a step; write SCRE above it")
    rung.step = Step(rung.statement, bit, rung.builder.label())
    rung.builder.branch(bit, rung.step.leave, when=False)


def _step(rung: Rung) -> Step:
    if rung.step is None:
        raise rung.error(f"{rung.statement.mnemonic} outside a step; write LSCR above it")
    return rung.step


def next_step(rung: Rung, bit: Cell) -> None:
    """SCRT S bit: that step begins, the running one ends with the scan."""
    rung.assign(_step(rung).bit, move(BOOL), FALSE)
    rung.assign(bit, move(BOOL), TRUE)


def leave_step(rung: Rung) -> None:
    """CSCRE: the rest of the step is skipped."""
    rung.builder.branch(rung.top, _step(rung).leave, when=True)


def end_step(rung: Rung) -> None:
    """SCRE"""
    rung.builder.place(_step(rung).leave)
    rung.step = None


# ---------------------------------------------------------------------------------------------------------- calls


def call(rung: Rung, *operands: syntax.Operand) -> None:
    """CALL SBR, parameters in the order of their declaration."""
    if not operands:
        raise rung.error("CALL of what? write the name of a subroutine")
    name = block(BlockKind.SUBROUTINE)(rung, operands[0])
    assert isinstance(name, str)
    callee = rung.names.blocks[name]
    parameters = [local for local in locals_of(callee) if local.is_parameter]
    if len(parameters) != len(operands) - 1:
        wanted = ", ".join(f"{local.declaration.name} {local.type}" for local in parameters) or "none"
        message = f"{callee.shown} has {len(parameters)} parameters, {len(operands) - 1} are given; write {wanted}"
        raise rung.error(message)
    bound = list(zip(parameters, operands[1:], strict=True))
    given = tuple(_argument(rung, local, operand) for local, operand in bound if local.is_given)
    taken = tuple(rung.write(operand, local.type) for local, operand in bound if local.is_returned)
    rung.builder.call(name, arguments=given, results=taken)


def _argument(rung: Rung, local: Local, operand: syntax.Operand) -> Operand:
    read = rung.write if local.is_returned else rung.read
    return read(operand, local.type)


# ----------------------------------------------------------------------------------------------------- the system


def attach(rung: Rung, routine: str, event: int) -> None:
    """ATCH INT, EVNT"""
    rung.result(ATCH, Literal(int(routine.removeprefix(BlockKind.INTERRUPT.value)), INT), Literal(event, INT))


def served(operator: Operator) -> Callable[..., None]:
    """What the CPU does: ENI, PLS n and the like."""
    return lambda rung, *numbers: rung.result(operator, *(Literal(number, INT) for number in numbers))


def nothing(_rung: Rung, _number: int) -> None:
    """NOP n"""
