"""Golden cases: stored sources and traces, held against what comes out today.

A case is a folder with `job.toml`, `<target>/` with the sources, `reference.csv`, and `trace-<target>.csv`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from difflib import unified_diff
from pathlib import Path

import numpy as np

from plcgen.check.verdict import Check, TargetVerdict
from plcgen.errors import PlcgenError
from plcgen.files import write_files
from plcgen.job import read_job
from plcgen.processes import in_processes
from plcgen.trajectory import Trajectory, disagreements

JOB = "job.toml"
REFERENCE = "reference.csv"
PHASE = "phase"
MAX_ROWS = 1000
"""A stored trace has one row more at most, and two for each change of phase."""
READABLE = ("utf-8", "gbk")
MAX_TRACE_DIFF = 40
NEVER_STORED = frozenset({"Thumbs.db", "desktop.ini"})


@dataclass(frozen=True)
class CaseReport:
    """What was found in one case: findings that make the check fail, files rewritten, or an error of its input.

    `verdicts` has the figures of each target.
    """

    case: str
    findings: tuple[str, ...] = ()
    updated: tuple[str, ...] = ()
    error: str = ""
    verdicts: Mapping[str, TargetVerdict] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        return not self.findings and not self.error


def check_golden(folder: Path, update: bool, done: Callable[[str], None]) -> list[CaseReport]:
    """Check every case of a folder; `done` gets a line after each. Raises PlcgenError when there is none."""
    cases = find_cases(folder)
    longest_first = sorted(cases, key=_stored_rows, reverse=True)
    reports = {}
    checked = in_processes(check_case, longest_first, [update] * len(cases))
    for number, (case, report) in enumerate(zip(longest_first, checked, strict=True), start=1):
        reports[case] = report
        done(f"{number} of {len(cases)} cases checked")
    return [reports[case] for case in cases]


def find_cases(folder: Path) -> list[Path]:
    """Folders with a job below `folder`, or itself where it is a case; also one that has lost its job."""
    if not folder.is_dir():
        raise PlcgenError(f"{folder}: no such folder; plcgen check takes the folder of the golden cases")
    if (folder / JOB).is_file():
        return [folder]
    cases = sorted({file.parent for name in (JOB, REFERENCE) for file in folder.glob(f"*/{name}")})
    if not cases:
        raise PlcgenError(f"{folder}: no case in it; a case is a folder with a {JOB}")
    return cases


def _stored_rows(case: Path) -> int:
    """Of all traces that are stored, as their first lines say: a measure of how long a case takes."""
    return sum(map(_rows_of, case.glob("trace-*.csv")))


def _rows_of(trace: Path) -> int:
    with trace.open("rb") as file:
        head = file.readline().split()
    return int(head[1]) if len(head) > 1 and head[1].isdigit() else 0


# ----------------------------------------------------------------------------------------------------------- case


def check_case(folder: Path, update: bool = False) -> CaseReport:
    """Check one case. With `update` its files are rewritten, if verification holds."""
    try:
        return _checked(folder, update)
    except PlcgenError as error:
        return CaseReport(folder.name, error=str(error))


def _checked(folder: Path, update: bool) -> CaseReport:
    files, verdicts, traces = _regenerate(folder)
    deviations = (*_deviations(folder, verdicts), *disagreements(traces))
    differing = {name: data for name, data in files.items() if _stored(folder / name) != data}
    extra = tuple(f"{folder / name}: is not generated; remove it" for name in _extra(folder, files))
    if update and not deviations:
        write_files(folder, differing)
        return CaseReport(folder.name, extra, tuple(str(folder / name) for name in differing), verdicts=verdicts)
    differences = tuple(_difference(folder / name, data) for name, data in differing.items())
    return CaseReport(folder.name, deviations + differences + extra, verdicts=verdicts)


def _regenerate(folder: Path) -> tuple[dict[str, bytes], dict[str, TargetVerdict], dict[str, Trajectory]]:
    """All files of a case by relative name, and the verdict and the trace of each target."""
    from plcgen import pipeline

    job = read_job(folder / JOB)
    plan = pipeline.prepare(job)
    files = {REFERENCE: stored_text(pipeline.reference(plan)).encode()}
    verdicts: dict[str, TargetVerdict] = {}
    traces: dict[str, Trajectory] = {}
    for target in job.targets:
        sources = pipeline.sources(plan, target)
        verdicts[target] = pipeline.verify(plan, target, sources)
        files |= {f"{target}/{name}": data for name, data in sources.items()}
        traces[target] = pipeline.golden_trace(plan, target, sources)
    files |= {f"trace-{target}.csv": text.encode() for target, text in _stored_texts(traces).items()}
    return files, verdicts, traces


def _stored_texts(traces: Mapping[str, Trajectory]) -> dict[str, str]:
    """Targets mostly agree in every bit, and then their texts do."""
    texts: dict[str, str] = {}
    for target, trace in traces.items():
        same = next((known for known in texts if trace.is_same(traces[known])), None)
        texts[target] = texts[same] if same else stored_text(trace)
    return texts


def _deviations(folder: Path, verdicts: Mapping[str, TargetVerdict]) -> Iterator[str]:
    for target, verdict in verdicts.items():
        yield from (f"{folder / target}: {deviation(check)}" for check in verdict.failed)


def deviation(check: Check) -> str:
    """A failed check in words."""
    side = "below" if check.at_least else "above"
    detail = f" ({check.detail})" if check.detail else ""
    return f"{check.name}: {check.value:.4g} {check.unit} is {side} the bound {check.bound:.4g} {check.unit}{detail}"


def _extra(folder: Path, files: Mapping[str, bytes]) -> list[str]:
    names = (path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    kept = (name for name in names if not name.name.startswith(".") and name.name not in NEVER_STORED)
    return sorted({name.as_posix() for name in kept} - set(files) - {JOB})


def _stored(path: Path) -> bytes | None:
    """A stored file; line ends of a CSV are its own matter, those of a source belong to it."""
    if not path.is_file():
        return None
    data = path.read_bytes()
    return _without_cr(data) if path.suffix == ".csv" else data


def _without_cr(data: bytes) -> bytes:
    return data.replace(b"\r\n", b"\n")


# ---------------------------------------------------------------------------------------------------------- traces


def stored_text(trajectory: Trajectory) -> str:
    """CSV of a trajectory thinned out, behind a line that stands for all of it."""
    return f"# {len(trajectory)} rows, sha256 {trajectory.sha256()}\n{thinned(trajectory).to_csv()}"


def thinned(trajectory: Trajectory) -> Trajectory:
    """Every n-th row, both rows around each change of phase, and the last."""
    count = len(trajectory)
    kept = np.zeros(count, dtype=bool)
    kept[:: max(1, -(-count // MAX_ROWS))] = True
    kept[-1:] = True
    if PHASE in trajectory.columns:
        phase = trajectory[PHASE]
        before = np.flatnonzero(phase[1:] != phase[:-1])
        kept[before] = kept[before + 1] = True
    return trajectory.rows(kept)


# ----------------------------------------------------------------------------------------------------- differences


def _difference(path: Path, new: bytes) -> str:
    old = _stored(path)
    if old is None:
        return f"{path}: is missing; plcgen check --update writes it"
    if _without_cr(old) == _without_cr(new):
        return f"{path}: differs in line ends alone; git leaves them if .gitattributes says: golden/** -text"
    lines = list(unified(old, new, str(path)))
    if path.suffix == ".csv" and len(lines) > MAX_TRACE_DIFF:
        lines[MAX_TRACE_DIFF:] = [f"... {len(lines) - MAX_TRACE_DIFF} more lines"]
    return "\n".join(lines)


def unified(old: bytes, new: bytes, name: str) -> Iterator[str]:
    """A unified diff of two files. CR shows as \\r, a byte order mark as \\ufeff, unless both have them alike."""
    before, after = _decoded(old, new)
    if _all_crlf(before) and _all_crlf(after):
        before, after = before.replace("\r\n", "\n"), after.replace("\r\n", "\n")
    differences = unified_diff(_lines(before), _lines(after), f"{name} (stored)", f"{name} (generated)", lineterm="")
    return (line.replace("\r", "\\r").replace("\ufeff", "\\ufeff") for line in differences)


def _decoded(old: bytes, new: bytes) -> tuple[str, str]:
    """Both in one encoding, so that different bytes never look alike."""
    for codec in READABLE:
        try:
            return old.decode(codec), new.decode(codec)
        except UnicodeDecodeError:
            continue
    return old.decode("latin-1"), new.decode("latin-1")


def _all_crlf(text: str) -> bool:
    return text.count("\n") == text.count("\r\n") == text.count("\r")


def _lines(text: str) -> list[str]:
    """The lines; a missing end of the last one is told as `diff` tells it."""
    lines = text.split("\n")
    return lines[:-1] if not lines[-1] else [*lines, "\\ No newline at end of file"]
