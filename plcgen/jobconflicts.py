"""Keys that are right alone and wrong together."""

from __future__ import annotations

from collections.abc import Iterator

from plcgen.jobfile import AnyFile, CosineFile, HoistFile, HoistLimits
from plcgen.jobfile_cosine import CENTRED, HALF_SINE, MOVE_KEYS, RAMP_KEYS, CosineLimits, CosineMove
from plcgen.jobfile_two_axis import LONGEST_MOVE, LONGEST_TIMED_INTERRUPT, TwoAxisLimits
from plcgen.names import one_of
from plcgen.targets import SMART, TARGETS, Target
from plcgen.tomlfile import TomlFile


def conflicts(keys: AnyFile, text: TomlFile) -> Iterator[tuple[str, str]]:
    """Each key with the end of the sentence that it begins."""
    yield from _target_conflicts(keys)
    if isinstance(keys, HoistFile):
        yield from _hoist_conflicts(keys.hoist)
    if isinstance(keys, CosineFile):
        yield from _cosine_conflicts(keys)
    if isinstance(keys, HoistFile | CosineFile):
        yield from _mnemonic_conflicts(keys, text)
        yield from _symbol_conflicts(keys, text)
    else:
        yield from _two_axis_conflicts(keys.two_axis)


def _hoist_conflicts(hoist: HoistLimits) -> Iterator[tuple[str, str]]:
    if hoist.creep_velocity > hoist.max_velocity / 2:
        limit = f"{hoist.max_velocity:g}"
        yield (
            "hoist.creep_velocity",
            f"is above half of max_velocity = {limit}; write at most {hoist.max_velocity / 2:g}",
        )
    if hoist.creep_acceleration > hoist.acceleration:
        limit = f"{hoist.acceleration:g}"
        yield "hoist.creep_acceleration", f"is above acceleration = {limit}; write at most {limit}"


def _two_axis_conflicts(limits: TwoAxisLimits) -> Iterator[tuple[str, str]]:
    """Also what no choice of other keys could mend."""
    for index, output in enumerate(limits.direction_outputs):
        if output in limits.outputs:
            yield f"two-axis.direction_outputs[{index}]", "is a pulse output; write another output"
    if not limits.moves:
        yield "two-axis.moves", "holds no move for verification; write [[two-axis.moves]] with x and y below"
    for index, move in enumerate(limits.moves):
        pulses = [abs(d) * ppu for d, ppu in zip((move.x, move.y), limits.pulses_per_unit, strict=True)]
        if max(pulses) < max(1, limits.ignore_below):
            yield f"two-axis.moves[{index}]", "is no move: both components count as zero; write a longer one"
        for axis, count in zip("xy", pulses, strict=True):
            if count > LONGEST_MOVE:
                most = f"{LONGEST_MOVE} are the most"
                yield f"two-axis.moves[{index}].{axis}", f"is {count:.0f} pulses; {most}; divide the move"


def _mnemonic_conflicts(keys: HoistFile | CosineFile, text: TomlFile) -> Iterator[tuple[str, str]]:
    stl = "s7-300-stl"
    if text.spelling(("mnemonics",)) and stl not in keys.targets:
        yield "mnemonics", f'concerns the target "{stl}" alone; add it to targets, or remove the key'


def _cosine_conflicts(keys: CosineFile) -> Iterator[tuple[str, str]]:
    limits = keys.cosine
    if SMART.name in keys.targets and keys.sample_period > LONGEST_TIMED_INTERRUPT:
        yield (
            "sample_period",
            f"is too long for the timed interrupt of {SMART.name}; write at most {LONGEST_TIMED_INTERRUPT}",
        )
    if limits.shape == HALF_SINE and limits.filter_length == 1:
        yield (
            "cosine.filter_length",
            "keeps no jerk limit: the acceleration of a half-sine jumps at both ends, and only the average spreads "
            'it; write 2 or more, or shape = "centred"',
        )
    if not limits.moves:
        wanted = " and ".join(_wanted_keys(limits))
        yield "cosine.moves", f"holds no move for verification; write [[cosine.moves]] with {wanted} below"
    for index, move in enumerate(limits.moves):
        yield from _cosine_move_conflicts(limits, move, f"cosine.moves[{index}]")


def _wanted_keys(limits: CosineLimits) -> tuple[str, ...]:
    return RAMP_KEYS if limits.shape == CENTRED else MOVE_KEYS


def _cosine_move_conflicts(limits: CosineLimits, move: CosineMove, place: str) -> Iterator[tuple[str, str]]:
    given = {(field.alias or name): getattr(move, name) for name, field in CosineMove.model_fields.items()}
    wanted = _wanted_keys(limits)
    missing = [key for key in wanted if given[key] is None]
    if missing:
        yield place, f'lacks {" and ".join(missing)}; shape = "{limits.shape}" wants {" and ".join(wanted)}'
    optional = ("then", "after") if limits.shape == CENTRED else ()
    for key in (key for key, value in given.items() if value is not None and key not in (*wanted, *optional)):
        yield f"{place}.{key}", f'does not belong to shape = "{limits.shape}", which wants {" and ".join(wanted)}'
    if limits.shape == CENTRED and (move.then_velocity is None) != (move.after is None):
        yield place, "gives only one of then and after; write both, the other speed and when it is ordered, or none"
    for key in ("from", "to", "then"):
        if given[key] is not None and abs(given[key]) > limits.max_velocity:
            yield f"{place}.{key}", f"is above max_velocity = {limits.max_velocity:g}; write at most that"
    if move.distance == 0.0:
        yield f"{place}.distance", "is no move; write how far to go"


def _target_conflicts(keys: AnyFile) -> Iterator[tuple[str, str]]:
    serving = [name for name, target in TARGETS.items() if keys.method in target.methods]
    way_out = "remove it" if set(serving) & set(keys.targets) else f"write {one_of(serving)}"
    if not keys.targets:
        yield "targets", f'names no target; write one or more, such as ["{serving[0]}"]'
    for index, name in enumerate(keys.targets):
        if name in keys.targets[:index]:
            yield f"targets[{index}]", "is listed twice; keep one"
        if keys.method not in TARGETS[name].methods:
            yield f"targets[{index}]", f'does not serve the method "{keys.method}"; {way_out}'


def _symbol_conflicts(keys: HoistFile | CosineFile, text: TomlFile) -> Iterator[tuple[str, str]]:
    """Names of blocks that are too long for a target, or equal to a compiler, which ignores case."""
    blocks = keys.blocks
    base = "blocks.fb_name" if text.spelling(("blocks", "fb_name")) else "name"
    data = "blocks.db_name" if text.spelling(("blocks", "db_name")) else base
    rows = (TARGETS[name] for name in keys.targets if name != SMART.name)
    tightest = min(rows, key=lambda target: target.max_identifier, default=None)
    if tightest:
        yield from _too_long(base, blocks.fb_name, blocks.longest_name, tightest)
        if base != "name":
            yield from _too_long("name", keys.name, keys.name, tightest)
        if data != base:
            yield from _too_long(data, blocks.db_name, blocks.db_name, tightest)
    same = [name for name in blocks.code_names if name.upper() == blocks.db_name.upper()]
    if same:
        yield data, f"names another block too, {same[0]}; write another name"


def _too_long(key: str, name: str, longest: str, target: Target) -> Iterator[tuple[str, str]]:
    excess = len(longest) - target.max_identifier
    if excess > 0:
        derived = f", for {longest} comes of it" if longest != name else ""
        yield key, f"has {len(name)} characters; {target.name} takes {len(name) - excess}{derived}"
