"""From what validation found to sentences for the user, each at its place in the job file."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, get_args, get_origin

from pydantic import BaseModel, ValidationError

from plcgen.errors import Location
from plcgen.jobrules import UNITS_PER_METRE, Quantity, kind_of
from plcgen.names import nearest
from plcgen.tomlfile import KeyPath, TomlFile, spelled_path

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo
    from pydantic_core import ErrorDetails

Tables = dict[KeyPath, type[BaseModel]]


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong, and where."""

    location: Location
    message: str
    is_absence: bool = False

    @property
    def order(self) -> tuple[bool, int, int]:
        """What is written comes first: a key that seems to be missing may be one that is written wrong."""
        return self.is_absence, self.location.line, self.location.column

    @classmethod
    def at_value(cls, text: TomlFile, path: KeyPath, words: str) -> Problem:
        """`words` end the sentence that key and value begin."""
        value = text.spelling(path)
        subject = spelled_path(path) if value is None else f"{spelled_path(path)} = {value}"
        return cls(text.value_location(path), f"{subject} {words}")


def problems_of(error: ValidationError, model: type[BaseModel], text: TomlFile) -> list[Problem]:
    """Every problem of a file. A key that was only misspelt or misplaced is not missing as well."""
    tables = dict(_tables(model, ()))
    found = error.errors(include_url=False)
    unknown = {item["loc"]: meant(item["loc"], tables) for item in found if item["type"] == "extra_forbidden"}
    intended = set(unknown.values())
    problems = [_unknown(text, path, place, tables) for path, place in unknown.items()]
    for item in found:
        path = item["loc"]
        if item["type"] == "missing" and not {_unnumbered(path), _unnumbered(path[:-1])} & intended:
            problems.append(_missing(text, path, tables))
        elif item["type"] not in _HANDLED and _is_written(text.data, path):
            problems.append(Problem.at_value(text, path, _words(item, path, tables)))
    return problems


# The last: a default that follows another key, which is wrong itself.
_HANDLED = ("missing", "extra_forbidden", "default_factory_not_called")


def meant(path: KeyPath, tables: Tables) -> KeyPath | None:
    """The key that an unknown one most likely means: the same word elsewhere, else a near one here, else elsewhere."""
    table, word = _unnumbered(path[:-1]), str(path[-1])
    same = (other for other, model in tables.items() if word in _keys(model))
    elsewhere = next(same, None)
    if elsewhere is not None:
        return (*elsewhere, word)
    for candidate in (table, *tables):
        near = nearest(word, _keys(tables[candidate])) if candidate in tables else None
        if near:
            return (*candidate, near)
    return None


def _unknown(text: TomlFile, path: KeyPath, place: KeyPath | None, tables: Tables) -> Problem:
    is_table = isinstance(_value(text.data, path), dict)
    what = f"unknown table [{spelled_path(path)}]" if is_table else f"unknown key {spelled_path(path)}"
    return Problem(text.key_location(path), f"{what}; {_way_out(path, place, tables)}")


def _way_out(path: KeyPath, place: KeyPath | None, tables: Tables) -> str:
    if place is None:
        return f"known here: {', '.join(_keys(tables[_unnumbered(path[:-1])]))}"
    if place in tables:
        return f"did you mean [{spelled_path(place)}]?"
    if place[:-1] == _unnumbered(path[:-1]):
        return f"did you mean {place[-1]}?"
    return f"{place[-1]} belongs {_where(place[:-1])}"


def _where(table: KeyPath) -> str:
    return f"in [{spelled_path(table)}]" if table else "at the top of the file, above the first [table]"


def _missing(text: TomlFile, path: KeyPath, tables: Tables) -> Problem:
    owner = f"[{spelled_path(path[:-1])}]" if path[:-1] else "the job"
    if path in tables and _is_list(path, tables):
        keys = " and ".join(key for key in _keys(tables[path]) if _field(tables[path], key).is_required())
        below = f", and {keys} below each" if keys else f"; `plcgen new {path[0]}` writes an example"
        words = f"{owner} lacks [[{spelled_path(path)}]]; write one or more{below}"
    elif path in tables:
        words = f"{owner} lacks the table [{spelled_path(path)}]; `plcgen new {path[-1]}` writes an example"
    else:
        field = _field(tables[_unnumbered(path[:-1])], str(path[-1]))
        example = json.dumps(_example(field, text.data.get("length_unit")))
        words = f"{owner} lacks {path[-1]}; add a line such as {path[-1]} = {example}"
    return Problem(text.key_location(path), words, is_absence=True)


def _example(field: FieldInfo, length_unit: Any) -> Any:
    example = (field.examples or [None])[0]
    rules = [rule for rule in field.metadata if isinstance(rule, Quantity)]
    return example * rules[0].scale(length_unit) if rules and length_unit in (*UNITS_PER_METRE,) else example


def _words(item: ErrorDetails, path: KeyPath, tables: Tables) -> str:
    if item["type"] == "job":
        return item["msg"]
    place = _unnumbered(path)
    if place in tables and _is_list(place, tables):
        keys = " and ".join(_keys(tables[place]))
        return f"is {kind_of(item['input'])}; write [[{spelled_path(place)}]] for each, and {keys} below"
    if item["type"] == "tuple_type":
        example = (_field(tables[place[:-1]], str(place[-1])).examples or [[]])[0]
        return f"is {kind_of(item['input'])}; write a list, such as {json.dumps(example[:1])}"
    return f"is {kind_of(item['input'])}; write a table, [{spelled_path(path)}] and its keys below"


def _tables(model: type[BaseModel], above: KeyPath) -> Iterator[tuple[KeyPath, type[BaseModel]]]:
    """Every table by its path; a list of tables as if it were one."""
    yield above, model
    for key, field in model.model_fields.items():
        for kind in (field.annotation, *get_args(field.annotation)):
            if isinstance(kind, type) and issubclass(kind, BaseModel):
                yield from _tables(kind, (*above, field.alias or key))


def _unnumbered(path: KeyPath) -> KeyPath:
    """The path of a table in a list without its number."""
    return tuple(part for part in path if isinstance(part, str))


def _is_list(place: KeyPath, tables: Tables) -> bool:
    """Whether a table may be there many times."""
    return bool(place) and get_origin(_field(tables[place[:-1]], str(place[-1])).annotation) is tuple


def _keys(table: type[BaseModel]) -> list[str]:
    """The keys of a table as a file spells them."""
    return [field.alias or name for name, field in table.model_fields.items()]


def _field(table: type[BaseModel], key: str) -> FieldInfo:
    return next(field for name, field in table.model_fields.items() if key in (name, field.alias))


def _is_written(data: Any, path: Iterable[str | int]) -> bool:
    return _value(data, path) is not None


def _value(data: Any, path: Iterable[str | int]) -> Any:
    """What the file holds under a path; None when it holds nothing there."""
    for part in path:
        try:
            data = data[part]
        except (KeyError, IndexError, TypeError):
            return None
    return data
