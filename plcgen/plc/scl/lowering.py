"""From the syntax tree of SCL to the core."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from plcgen.plc.core import Function, Program
from plcgen.plc.scl.dialects import Dialect
from plcgen.plc.scl.lowering_declarations import CALLABLE, Catalogue
from plcgen.plc.scl.lowering_statements import Statements
from plcgen.plc.scl.syntax import Block, BlockKind
from plcgen.plc.verifier import verify

NO_SYMBOLS: Mapping[str, str] = MappingProxyType({})


def lower(blocks: Sequence[Block], dialect: Dialect, symbols: Mapping[str, str] = NO_SYMBOLS) -> Program:
    """A verified program. `symbols` maps quoted names to absolute ones such as FB100 or M0.0.

    Raises SourceError for whatever cannot be typed or is not supported.
    """
    catalogue = Catalogue(blocks, symbols)
    for block in blocks:
        if block.kind is BlockKind.DB:
            catalogue.data_block(block.name)
        elif block.kind is BlockKind.UDT:
            catalogue.structure_of(block)
    functions = [_function(block, catalogue, dialect) for block in blocks if block.kind in CALLABLE]
    data_blocks = {block.name: block for block in catalogue.created.values()}
    return verify(Program({function.name: function for function in functions}, data_blocks, catalogue.symbols))


def _function(block: Block, catalogue: Catalogue, dialect: Dialect) -> Function:
    lowering = Statements(block, catalogue, dialect)
    lowering.body()
    return Function(
        name=lowering.interface.name,
        source=block.source,
        body=tuple(lowering.builder.body),
        span=block.span,
        instance=lowering.interface.instance,
        parameters=tuple(lowering.scope.parameters),
        results=tuple(lowering.scope.results),
        temporaries=tuple(lowering.builder.temporaries),
        frame_bytes=lowering.builder.frame_bytes,
        frame_given=block.kind is BlockKind.OB,
    )
