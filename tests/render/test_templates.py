"""Templates are PLC files with holes: no program hides in them, and no PLC text hides in Python."""

from __future__ import annotations

import ast
import os
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from jinja2 import DictLoader, StrictUndefined, TemplateSyntaxError, UndefinedError, nodes

from plcgen.render.environment import column, environment, render
from plcgen.render.files import template_folder

ROOT = Path(__file__).parents[2]
TEMPLATES = sorted(path for path in template_folder().rglob("*") if path.is_file())
# Everything else of Jinja's grammar computes: Add, Compare, Concat, Call, CondExpr, Assign, Macro, Test, Getitem ...
ALLOWED = {
    nodes.Template,
    nodes.Output,
    nodes.TemplateData,
    nodes.Name,
    nodes.Getattr,
    nodes.Filter,
    nodes.Const,
    nodes.For,
    nodes.If,
    nodes.Include,
}
FILTERS = {"real", "stl_real", "column"}
# A number with the punctuation that belongs to it, padded as one.
PUNCTUATED = re.compile(r"%s[;,]")
PLC_TEXT = re.compile(
    r":=|=>|\b(END_\w+|VAR_(INPUT|OUTPUT|IN_OUT|TEMP|GLOBAL)|FUNCTION_BLOCK|DATA_BLOCK|ORGANIZATION_BLOCK|NETWORK)\b"
    r"|\b(IF|ELSIF)\b.*\bTHEN\b|\bFOR\b.*\bDO\b|^\s*(L|T|A|O|AN|ON|CALL|JU|JC|JCN) +[#A-Z\"]",
    re.MULTILINE,
)


def own_nodes(tree: nodes.Node) -> list[nodes.Node]:
    return [tree, *tree.find_all(nodes.Node)]


def problems(text: str) -> list[str]:
    """What a template contains beyond text, names, filters, loops, switches and includes."""
    found = []
    for node in own_nodes(environment().parse(text)):
        if type(node) not in ALLOWED:
            found.append(f"{node.lineno}: {type(node).__name__}")
        elif isinstance(node, nodes.If) and not isinstance(node.test, nodes.Name):
            found.append(f"{node.lineno}: if on more than a name")
        elif isinstance(node, nodes.For) and (node.test or node.recursive or node.else_):
            found.append(f"{node.lineno}: for with a condition, else or recursion")
        elif isinstance(node, nodes.Filter) and not harmless(node):
            found.append(f"{node.lineno}: filter {node.name}")
        elif isinstance(node, nodes.Include) and not isinstance(node.template, nodes.Const):
            found.append(f"{node.lineno}: include of a computed name")
    return found


def harmless(node: nodes.Filter) -> bool:
    if node.name == "format":
        return isinstance(node.node, nodes.Const) and bool(PUNCTUATED.fullmatch(str(node.node.value)))
    return node.name in FILTERS


def test_there_are_templates() -> None:
    assert {path.relative_to(template_folder()).parts[0] for path in TEMPLATES} >= {"s7-300-scl", "tia-scl", "jobs"}


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda path: str(path.relative_to(template_folder())))
def test_template_is_text_with_holes(path: Path) -> None:
    raw = path.read_bytes()
    assert b"\r" not in raw
    assert b"\t" not in raw
    assert raw.endswith(b"\n")
    assert problems(raw.decode("utf-8")) == []


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("{{ a + 1 }}", "Add"),
        ("{{ a * 2 }}", "Mul"),
        ("{{ -a }}", "Neg"),
        ("{{ a ~ b }}", "Concat"),
        ("{{ a == b }}", "Compare"),
        ("{{ a(1) }}", "Call"),
        ("{{ a[0] }}", "Getitem"),
        ("{{ a if b else c }}", "CondExpr"),
        ("{% set a = 1 %}", "Assign"),
        ("{% macro m() %}{% endmacro %}", "Macro"),
        ("{% if a.b %}{% endif %}", "if on more than a name"),
        ("{% if not a %}{% endif %}", "if on more than a name"),
        ("{% if a and b %}{% endif %}", "And"),
        ("{% if a is defined %}{% endif %}", "Test"),
        ("{% for a in b if a %}{% endfor %}", "for with a condition, else or recursion"),
        ("{{ a | round }}", "filter round"),
        ("{{ a | format(b) }}", "filter format"),
        ("{{ 'IF %s THEN' | format(b) }}", "filter format"),
        ("{% include a %}", "include of a computed name"),
    ],
)
def test_programs_in_templates_are_found(text: str, problem: str) -> None:
    assert any(found.endswith(f": {problem}") for found in problems(text))


def test_environment_is_strict() -> None:
    templates = environment()
    assert templates.undefined is StrictUndefined
    assert (templates.trim_blocks, templates.lstrip_blocks, templates.keep_trailing_newline) == (True, True, True)
    # In SCL, # begins a local name; as a prefix of statements it would eat lines.
    assert (templates.line_statement_prefix, templates.line_comment_prefix) == (None, None)
    assert templates.from_string("#x := {{ x | real }};\n").render(x=0.1) == "#x := 0.1;\n"


def test_missing_name_is_an_error() -> None:
    with pytest.raises(UndefinedError, match="is undefined"):
        render("s7-300-scl/hoist/source.scl", {"name": "Shaft"})


def test_value_that_is_no_real_stops_the_rendering() -> None:
    with pytest.raises(ValueError, match="nan is out of the range of REAL"):
        environment().from_string("{{ x | real }}").render(x=float("nan"))
    with pytest.raises(TemplateSyntaxError):
        environment().from_string("{% if x %}")


def test_column_pads_and_never_cuts() -> None:
    assert (column("ab", 4), column("abcde", 4), column(7, 3)) == ("ab  ", "abcde", "7  ")


def strings(source: str) -> list[ast.Constant]:
    """String constants that are no docstrings."""
    tree = ast.parse(source)
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    blocks = [node for node in ast.walk(tree) if isinstance(node, documented)]
    first = [block.body[0] for block in blocks if block.body]
    docstrings = {id(statement.value) for statement in first if isinstance(statement, ast.Expr)}
    texts = [node for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    return [text for text in texts if id(text) not in docstrings]


@pytest.mark.parametrize(
    "path",
    sorted([*ROOT.glob("plcgen/render/**/*.py"), *ROOT.glob("plcgen/profile/**/*.py")]),
    ids=lambda path: path.name,
)
def test_no_plc_text_in_python(path: Path) -> None:
    found = [f"{text.lineno}: {text.value!r}" for text in strings(path.read_text("utf-8")) if hidden(text)]
    assert found == []


def hidden(text: ast.Constant) -> bool:
    return bool(PLC_TEXT.search(str(text.value)))


@pytest.mark.parametrize("code", ["'x := 1;'", "f'{n} := 1'", "'IF x THEN'", "'END_IF'", "'VAR_INPUT'", "'      L #x'"])
def test_plc_text_in_python_is_found(code: str) -> None:
    assert any(hidden(text) for text in strings(f"x = {code}"))
    assert not any(hidden(text) for text in strings('"""speed := travel"""'))


def kept_in(folder: Path) -> list[str]:
    return [path.name for path in folder.rglob("plcgen_en_*.cache")]


@pytest.fixture
def fresh(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty folder for temporary files, and no environment made yet."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    environment.cache_clear()
    yield tmp_path
    environment.cache_clear()


def test_compiled_templates_are_kept_and_follow_the_text(fresh: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    texts = {"a": "x := {{ x }};"}
    monkeypatch.setattr("plcgen.render.environment._loader", lambda _language: DictLoader(texts))
    assert render("a", {"x": 1}) == "x := 1;"
    assert len(kept_in(fresh)) == 1
    environment.cache_clear()
    texts["a"] = "y := {{ x }};"
    assert render("a", {"x": 2}) == "y := 2;"


@pytest.mark.parametrize("kept", [0, 4, 20, 40, 60, -1])
def test_a_compiled_template_that_was_cut_off_is_compiled_again(
    fresh: Path, monkeypatch: pytest.MonkeyPatch, kept: int
) -> None:
    monkeypatch.setattr("plcgen.render.environment._loader", lambda _language: DictLoader({"a": "x := {{ x }};"}))
    assert render("a", {"x": 1}) == "x := 1;"
    (file,) = fresh.rglob("plcgen_en_*.cache")
    whole = file.read_bytes()
    file.write_bytes(whole[:kept])
    environment.cache_clear()
    assert render("a", {"x": 2}) == "x := 2;"
    assert file.read_bytes() == whole


def test_a_folder_that_takes_no_files_is_no_obstacle(fresh: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_arguments: object, **_keywords: object) -> None:
        raise OSError(28, "No space left on device")

    template = next(path.relative_to(template_folder()).as_posix() for path in TEMPLATES if path.suffix == ".scl")
    monkeypatch.setattr("tempfile.NamedTemporaryFile", full)
    environment().get_template(template)
    assert not kept_in(fresh)
    environment.cache_clear()
    monkeypatch.setattr("tempfile.tempdir", str(fresh / "missing"))
    environment().get_template(template)
    assert os.name == "nt" or environment().bytecode_cache is None
    assert not (fresh / "missing").exists()
