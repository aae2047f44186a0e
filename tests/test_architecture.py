"""The shape of the package: who may import whom, what stays unloaded, what every module owes its reader."""

from __future__ import annotations

import ast
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "plcgen"
MODULES = sorted(PACKAGE.rglob("*.py"))

# Who may lean on whom. The version may be read by anyone. A module without a row belongs to the command line: it sees
# all, and since it stands in no row, nothing of these sees it.
JOB = {
    "job",
    "jobconflicts",
    "jobfile",
    "jobfile_cosine",
    "jobfile_two_axis",
    "jobproblems",
    "jobrules",
    "tomlfile",
    "names",
    "targets",
}
MAY_IMPORT = {
    "errors": set[str](),
    "trajectory": set[str](),
    "kept": set[str](),
    **dict.fromkeys(JOB, JOB | {"errors"}),
    "profile": {"profile", "job", "trajectory", "errors"},
    "render": {"render", "profile", "targets", "job", "errors"},
    # An interpreter or a check that could read the intended answer would be no oracle.
    "plc": {"plc", "errors", "kept"},
    "check": {"check", "plc", "job", "trajectory", "errors"},
}
SUBPACKAGES = {
    "profile",
    "render",
    "plc",
    "plc.scl",
    "plc.stl",
    "plc.cpu",
    "plc.effort",
    "plc.fast",
    "plc.importrules",
    "check",
    "report",
}
HEAVY = ("numpy", "pydantic", "tree_sitter", "jinja2", "rich")


def part(path: Path) -> str:
    """First name below the package: `profile` for plcgen/profile/cubic.py, `job` for plcgen/job.py."""
    return path.relative_to(PACKAGE).with_suffix("").parts[0]


def name_of(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).with_suffix("").parts)


def imports(path: Path) -> set[str]:
    """Dotted names of every import, those in functions and under TYPE_CHECKING too."""
    package = name_of(path).split(".")[:-1]
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        if isinstance(node, ast.ImportFrom):
            base = (
                ".".join([*package[: len(package) - node.level + 1], node.module or ""]) if node.level else node.module
            )
            found |= {f"{(base or '').rstrip('.')}.{alias.name}" for alias in node.names}
    return found


def own_imports(path: Path) -> set[str]:
    """Parts of the package that a module imports; `plcgen.__version__` is none."""
    names = {name.split(".")[1] for name in imports(path) if name.startswith("plcgen.")}
    return names - {"__version__"}


@pytest.mark.parametrize("path", MODULES, ids=name_of)
def test_imports_run_one_way(path: Path) -> None:
    own = part(path)
    seen = own_imports(path)
    assert "cli" not in seen or own == "__main__"
    assert seen <= MAY_IMPORT.get(own, seen)


def test_every_part_is_where_the_layout_says() -> None:
    assert {part(path) for path in MODULES} >= {
        "errors",
        "job",
        "targets",
        "trajectory",
        "profile",
        "render",
        "plc",
        "check",
    }
    packages = {".".join(path.parent.relative_to(PACKAGE).parts) for path in MODULES if path.parent != PACKAGE}
    assert packages <= SUBPACKAGES
    assert all((PACKAGE / package.replace(".", "/") / "__init__.py").exists() for package in packages)


@pytest.mark.parametrize("path", MODULES, ids=name_of)
def test_every_module_says_what_it_is_for(path: Path) -> None:
    tree = ast.parse(path.read_text("utf-8"))
    assert not tree.body or ast.get_docstring(tree)
    assert path.stem == path.stem.lower()


@pytest.mark.parametrize("path", MODULES, ids=name_of)
def test_no_module_is_too_long_to_read(path: Path) -> None:
    if "Written by `generate.py`" in path.read_text("utf-8")[:200]:
        return
    assert len(path.read_text("utf-8").splitlines()) <= 450


def loaded_after(code: str, watched: tuple[str, ...] = HEAVY) -> set[str]:
    """Packages and modules among the watched ones that a fresh interpreter has loaded after some code."""
    report = f"import sys\n{code}\nprint('loaded:', *[name for name in {watched} if name in sys.modules])"
    run = subprocess.run([sys.executable, "-c", report], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(run.stdout.split("loaded:")[-1].split())


@pytest.mark.parametrize(
    "code",
    [
        "import plcgen.cli",
        "from click.testing import CliRunner\nfrom plcgen.cli import main\n"
        "assert CliRunner().invoke(main, ['--help']).exit_code == 0",
    ],
    ids=["import", "help"],
)
def test_command_line_starts_light(code: str) -> None:
    if find_spec("plcgen.cli") is None:
        pytest.skip("there is no plcgen.cli yet")
    assert loaded_after(code) == set()


SIMULATION = ("numba", "plcgen.plc.machine", "plcgen.plc.cpu", "plcgen.check.rig", "plcgen.check.binary_result")


@pytest.mark.parametrize("case", ["main-shaft", "ramps", "table-1"])
def test_sources_that_are_not_run_load_no_simulation(case: str, tmp_path: Path) -> None:
    arguments = ["generate", f"golden/{case}/job.toml", "--no-verify", "-o", str(tmp_path)]
    code = (
        f"from click.testing import CliRunner\nfrom plcgen.cli import main\n"
        f"assert CliRunner().invoke(main, {arguments}).exit_code == 0"
    )
    assert loaded_after(code, SIMULATION) == set()


# Spelled in pieces, or this file would be its own finding.
WORKPLACE = tuple(
    "/".join(parts) for parts in (("", "work", ""), ("", "tmp", "venv"), ("", "tmp", "plan"), ("..", "shared"))
)
SHIPPED = (
    "plcgen",
    "templates",
    "tests",
    "golden",
    "docs",
    ".ci",
    "README.md",
    "README.zh.md",
    "CHANGELOG.md",
    "LICENSE",
    "pyproject.toml",
)


def shipped_files() -> list[Path]:
    found = [path for name in SHIPPED for path in (ROOT / name, *(ROOT / name).rglob("*")) if path.is_file()]
    return [path for path in found if "__pycache__" not in path.parts]


def test_no_file_names_the_place_where_it_was_made() -> None:
    files = shipped_files()
    assert len(files) > len(MODULES)
    texts = {path: path.read_bytes().decode("utf-8", "replace") for path in files}
    assert [path for path, text in texts.items() if any(place in text for place in WORKPLACE)] == []
