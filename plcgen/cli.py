"""The command line: arguments in, text out. What a command needs is imported when it runs, so that help is quick."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from plcgen import __version__, completion, terminal
from plcgen.errors import PlcgenError
from plcgen.options import ENGINE, PATH, TARGET, target_option
from plcgen.outcome import BAD_INPUT, FAILED, Commands
from plcgen.targets import ENGLISH, LANGUAGES

if TYPE_CHECKING:
    from plcgen.check.verdict import Verdict
    from plcgen.job import Job
    from plcgen.plan import Files, Plan

SCHEMA = "plcgen.schema.json"
"""What the first line of an example job names."""


def _fail(message: str) -> NoReturn:
    """The check failed."""
    terminal.tell(f"error: {message}")
    raise click.exceptions.Exit(FAILED)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="plcgen", message="%(prog)s %(version)s")
def main() -> None:
    """Jerk-limited motion source for Siemens PLCs, executed and verified before it is written.

    \b
    Example:
      plcgen new hoist               write hoist.toml, an example job
      plcgen generate hoist.toml     verify it and write the sources
    """


# ----------------------------------------------------------------------------------------------------------- jobs


@main.command()
@click.argument("method", shell_complete=completion.methods)
@click.option("-o", "--output", type=PATH, metavar="JOB", help="File to write; default METHOD.toml.")
@click.option("--language", type=click.Choice(LANGUAGES), default=ENGLISH, help="Of the comments; default en.")
def new(method: str, output: Path | None, language: str) -> None:
    """Write a commented example job, and beside it the schema that editors check it against.

    A job that exists is left alone.

    \b
    Example:
      plcgen new hoist -o shaft.toml
    """
    from plcgen.files import write_files
    from plcgen.job import job_schema
    from plcgen.render.files import example_job

    _require_method(method)
    path = output or Path(f"{method}.toml")
    if path.exists():
        raise PlcgenError(f"{path}: exists already; name another file with -o")
    job = example_job(method, language).read_bytes()
    write_files(path.parent, {path.name: job, SCHEMA: _json(job_schema()).encode()})
    terminal.say(f"wrote {path}\nwrote {path.with_name(SCHEMA)}")


def _require_method(method: str) -> None:
    from plcgen.jobfile import METHODS
    from plcgen.names import nearest, one_of

    if method not in METHODS:
        near = nearest(method, METHODS)
        raise PlcgenError(f'unknown method "{method}"; write {one_of([near] if near else METHODS)}')


@main.command()
def schema() -> None:
    """Print the JSON Schema of the job file, for editors that check while you type.

    \b
    Example:
      plcgen schema > job.schema.json
    """
    from plcgen.job import job_schema

    _print_json(job_schema())


@main.command("completion")
@click.argument("shell", shell_complete=completion.shells)
def completion_script(shell: str) -> None:
    """Print the script that completes commands, options, methods and targets in a shell.

    \b
    Example:
      plcgen completion bash >> ~/.bashrc
      plcgen completion powershell >> $PROFILE
    """
    print(completion.script(main, shell), end="")


@main.command()
@click.argument("job", type=PATH)
@click.option("--json", "as_json", is_flag=True, help="JSON on stdout.")
def derive(job: Path, as_json: bool) -> None:
    """Print the constants of the motion, with the numbers of their equations.

    \b
    Example:
      plcgen derive hoist.toml
    """
    from plcgen import pipeline, tables
    from plcgen.job import read_job

    read = read_job(job)
    plan = pipeline.prepare(read)
    derivation = pipeline.derivation(plan)
    estimates = pipeline.estimates(plan, {name: pipeline.sources(plan, name) for name in read.targets})
    if as_json:
        _print_json({**tables.derivation_json(read, derivation), **tables.estimates_json(estimates)})
        return
    for table in (*tables.derivation_tables(read, derivation), tables.estimates_table(read, estimates)):
        terminal.show(table)
    terminal.say("\n".join(f"{name}: {estimate.origin}" for name, estimate in estimates.items()))


# --------------------------------------------------------------------------------------------------- verification


@main.command()
@click.argument("job", type=PATH)
@click.option("-o", "--output", type=PATH, metavar="DIR", help="Folder to write to; default the name of the job.")
@TARGET
@ENGINE
@click.option("--no-verify", is_flag=True, help="Write without running the sources; their headers say so.")
def generate(job: Path, output: Path | None, target: str | None, no_verify: bool) -> None:
    """Verify the sources of a job and write them to DIR/<target>. Nothing is written unless all of them pass.

    \b
    Example:
      plcgen generate hoist.toml -o sources
    """
    from plcgen import pipeline
    from plcgen.files import check_folder, write_files
    from plcgen.job import read_job

    read = read_job(job)
    folder = output or Path(read.name)
    check_folder(folder)
    plan = pipeline.prepare(read)
    sources = {name: pipeline.sources(plan, name, not no_verify) for name in _targets(read, target)}
    if no_verify:
        terminal.tell("warning: the sources are not verified; their headers say so")
    else:
        _require(_verified(plan, sources))
    files = {f"{name}/{file}": data for name, files in sources.items() for file, data in files.items()}
    write_files(folder, files)
    terminal.say("\n".join(f"wrote {folder / file}" for file in files))


def _require(verdict: Verdict) -> None:
    """Show the verdict; end here when it is not good."""
    from plcgen import tables

    terminal.show(tables.verdict_table(verdict))
    if not verdict.ok:
        _fail(f"{tables.failures(verdict)}; nothing was written")


@main.command()
@click.argument("job", type=PATH)
@click.option("--source", type=PATH, metavar="DIR", help="Verify the files in DIR/<target> or DIR instead.")
@TARGET
@click.option("--json", "as_json", is_flag=True, help="JSON on stdout.")
@click.option("--report", type=PATH, metavar="FILE", help="Write a report as `plcgen report` does.")
@ENGINE
def verify(job: Path, source: Path | None, target: str | None, as_json: bool, report: Path | None) -> None:
    """Execute the sources of a job scan by scan against the reference.

    \b
    Example:
      plcgen verify hoist.toml --source sources
    """
    from plcgen import pipeline, tables
    from plcgen.files import read_sources
    from plcgen.job import read_job

    read = read_job(job)
    targets = _targets(read, target)
    if report:
        _prepare_report(report)
    plan = pipeline.prepare(read)
    sources = read_sources(source, targets) if source else {name: pipeline.sources(plan, name) for name in targets}
    verdict = _verified(plan, sources)
    if report:
        _write_report(plan, sources, verdict, report)
    if as_json:
        _print_json({**verdict.as_json(), **tables.estimates_json(pipeline.estimates(plan, sources))})
    else:
        terminal.show(tables.verdict_table(verdict))
    if not verdict.ok:
        _fail(tables.failures(verdict))


@main.command()
@click.argument("job", type=PATH)
@click.option("-o", "--output", type=PATH, metavar="FILE", help="HTML to write; default the name of the job.")
@click.option("--png", type=PATH, metavar="DIR", help="Write the pictures alone, too.")
@TARGET
@ENGINE
def report(job: Path, output: Path | None, png: Path | None, target: str | None) -> None:
    """Verify a job and write one page that shows it all: verdict, motion, checks, constants, sources.

    \b
    Example:
      plcgen report hoist.toml -o hoist.html --png pictures
    """
    from plcgen import pipeline, tables
    from plcgen.job import read_job

    read = read_job(job)
    path = output or Path(f"{read.name}.html")
    targets = _targets(read, target)
    _prepare_report(path)
    plan = pipeline.prepare(read)
    sources = {name: pipeline.sources(plan, name) for name in targets}
    verdict = _verified(plan, sources)
    _write_report(plan, sources, verdict, path, png)
    if not verdict.ok:
        _fail(tables.failures(verdict))


def _prepare_report(path: Path) -> None:
    """Say what stands in the way of a report before the long work begins."""
    from plcgen.files import check_folder
    from plcgen.report.page import require_libraries

    require_libraries()
    check_folder(path.parent)


def _write_report(
    plan: Plan, sources: Mapping[str, Files], verdict: Verdict, path: Path, png: Path | None = None
) -> None:
    from plcgen.files import write_file, write_files
    from plcgen.report.page import figures_of, page, pictures_of

    figures = figures_of(plan, sources)
    pictures = pictures_of(plan.job.name, figures) if png else {}
    write_file(path, page(plan, sources, verdict, figures).encode())
    if png:
        write_files(png, pictures)
    terminal.tell("\n".join(f"wrote {file}" for file in (path, *(png / name for name in pictures if png))))


def _targets(job: Job, chosen: str | None) -> tuple[str, ...]:
    """The targets to work on. Raises PlcgenError for one that the job does not name."""
    from plcgen.targets import target

    if chosen is None:
        return job.targets
    if target(chosen).name not in job.targets:
        raise job.error("targets", f'does not name "{chosen}"; add it, or choose another --target')
    return (chosen,)


def _verified(plan: Plan, sources: Mapping[str, Mapping[str, bytes]]) -> Verdict:
    from plcgen import pipeline
    from plcgen.check.verdict import Verdict

    verdicts = {}
    with terminal.progress() as progress:
        for name, files in sources.items():
            progress(name)
            verdicts[name] = pipeline.verify(plan, name, files, lambda text, name=name: progress(f"{name}: {text}"))  # type: ignore[misc]
    return Verdict(plan.job.name, verdicts)


@main.command()
@click.argument("job", type=PATH)
@click.option("--moves", default=10_000, show_default=True, type=click.IntRange(1), metavar="N", help="How many.")
@click.option("--seed", default=1, show_default=True, type=int, metavar="S", help="Of the random numbers.")
@ENGINE
def sweep(job: Path, moves: int, seed: int) -> None:
    """Run random moves of a two-axis job with its pulse outputs, on all cores, and count lost pulses.

    \b
    Example:
      plcgen sweep table.toml --moves 1000000 --seed 7
    """
    from plcgen import tables
    from plcgen.check.two_axis_sweep import Sweep
    from plcgen.job import read_job
    from plcgen.sweeps import run_sweep

    found = Sweep()
    with terminal.progress_bar(moves) as progress:
        for found in run_sweep(read_job(job), moves, seed):
            progress(found.moves)
    terminal.show(tables.sweep_table(found))
    if not found.ok:
        _fail(found.finding)


@main.command()
@click.argument("folder", type=PATH, metavar="[DIR]", default="golden")
@click.option("--update", is_flag=True, help="Rewrite sources and traces of every case that verifies.")
@ENGINE
def check(folder: Path, update: bool) -> None:
    """Compare golden cases, DIR/<case>/job.toml, with what comes out today. Default DIR: golden.
    One case alone: the folder of its job.toml.

    \b
    Example:
      plcgen check golden --update
    """
    from plcgen.golden import check_golden

    with terminal.progress() as progress:
        reports = check_golden(folder, update, progress)
    for report in reports:
        terminal.say(f"{report.case}: {terminal.OK if report.ok else terminal.FAILED}")
        for text in (*(f"updated {path}" for path in report.updated), *report.findings):
            terminal.say(text)
        if report.error:
            terminal.tell(f"error: {report.case}: {report.error}")
    if any(report.error for report in reports):
        raise click.exceptions.Exit(BAD_INPUT)
    if not all(report.ok for report in reports):
        _fail(f"{sum(not report.ok for report in reports)} of {len(reports)} cases failed")


# --------------------------------------------------------------------------------------------------------- sources


@main.command()
@click.argument("files", type=PATH, metavar="FILE...", nargs=-1, required=True)
@target_option("Import rules of this target; default what the text looks like.")
def lint(files: tuple[Path, ...], target: str | None) -> None:
    """Check SCL, S7-300 STL and S7-200 SMART sources: syntax, types, what STEP 7, TIA and Micro/WIN refuse at import.

    Blocks may use blocks of other FILEs.

    \b
    Example:
      plcgen lint motor.scl main.scl --target s7-300-scl
      plcgen lint MAIN.awl SBR_0.awl INT_0.awl
    """
    from plcgen.lint import lint_files
    from plcgen.targets import target as row

    findings = lint_files(files, row(target).name if target else None)
    for finding in findings:
        excerpt = finding.location.excerpt()
        terminal.say(f"{finding}\n{excerpt}" if excerpt else str(finding))
    errors = sum(finding.severity == "error" for finding in findings)
    counts = (len(files), "file"), (errors, "error"), (len(findings) - errors, "warning")
    terminal.tell(", ".join(f"{count} {word}{'' if count == 1 else 's'}" for count, word in counts))
    if errors:
        raise click.exceptions.Exit(FAILED)


@main.command()
@click.argument("file", type=PATH)
@click.option("--block", required=True, metavar="NAME", help="FB, FC, OB, SBR or INT to call once a scan.")
@click.option("--scans", required=True, type=click.IntRange(1), metavar="N", help="Number of scans.")
@click.option("--period", required=True, metavar="TIME", help="From scan to scan: 10ms, 0.01s, 1s.")
@click.option("--set", "inputs", multiple=True, metavar="NAME=VALUE", help="Set a variable before the first scan.")
@click.option("--watch", multiple=True, metavar="NAME,...", help="Variables to record; default all outputs.")
@click.option("-o", "--output", type=PATH, metavar="CSV", help="File for the rows; default stdout.")
@ENGINE
def run(
    file: Path,
    block: str,
    scans: int,
    period: str,
    inputs: tuple[str, ...],
    watch: tuple[str, ...],
    output: Path | None,
) -> None:
    """Execute any block of an SCL, S7-300 STL or S7-200 SMART source and print its variables as CSV, one row a scan.

    An FB runs on the instance that FILE declares for it, else on a fresh one. Inputs keep their value.
    M0.0, MW10 and members of data blocks can be set and watched too, V memory of a SMART as VD100 or VD100:REAL.

    \b
    Example:
      plcgen run ramp.scl --block FB1 --scans 100 --period 10ms --set enable=true --watch speed
      plcgen run axis.awl --block MAIN --scans 100 --period 10ms --set VD100=5 --watch VD100,Q0.0
    """
    from plcgen.files import write_file
    from plcgen.run import Order, parse_period, run_file

    watched = [name.strip() for names in watch for name in names.split(",") if name.strip()]
    order = Order(file, block, scans, parse_period(period), [_assignment(text) for text in inputs], watched)
    with terminal.progress() as progress:
        outcome = run_file(order, progress)
    text = outcome.trace.to_csv()
    if output is None:
        sys.stdout.write(text)
    else:
        write_file(output, text.encode())
    for fault in outcome.faults:
        terminal.tell(f"fault: {fault}")
    if outcome.faults:
        raise click.exceptions.Exit(FAILED)


def _assignment(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name.strip() or not value.strip():
        raise PlcgenError(f"--set {text}: no assignment; write NAME=VALUE, such as enable=true")
    return name.strip(), value.strip()


def _print_json(data: object) -> None:
    print(_json(data), end="")


def _json(data: object) -> str:
    """In ASCII, so that no console and no code page can spoil it."""
    return json.dumps(data, indent=2) + "\n"
