"""Many programs on a cluster of Ray (https://ray.io): checks, tests, mutants, proofs and searches.

Each program, test file or part of a test file is a task, which runs the command `rungc` on a worker. Its files travel
with it, so workers need nothing but the wheel of the same version. Results come in the order of the paths, and are
those of one machine; tasks of lost workers run again elsewhere.

    import rungc.ray

    for result in rungc.ray.run("test", ["machines"], cache="verdicts"):
        print(result.path, result.code)

Without a cluster, `ray.init()` starts one on this machine.
"""

from __future__ import annotations

import collections
import dataclasses
import hashlib
import io
import json
import os
import pathlib
import shutil
import subprocess
import sysconfig
import tempfile
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import ray

from ._rungc import __version__

__all__ = ["Result", "run"]

_TESTS = ".plctest.toml"
_PROGRAMS = {".csv", ".gxw", ".il", ".st", ".wpg"}
_SETTINGS = "rungc.toml"
# Results that say something of a program: success, findings, not decided.
_LASTING = {0, 1, 3}
# Size of the files of a task, in bytes.
_MOST_BYTES = 256 << 20
# Commands of this worker that have the version of this module.
_checked: set[str] = set()


@dataclasses.dataclass(frozen=True)
class Result:
    """Result of a command on one program, test file, or part of one."""

    #: Path, from the root.
    path: str
    #: The part of a test file, `2/4`; None if it is not divided.
    part: str | None
    #: Exit code of the command: 0, 1 for findings, 2 for unusable input, 3 for what is not decided.
    code: int
    #: What the command has printed.
    output: str
    #: What it has printed on standard error.
    errors: str
    #: True if it was there before.
    cached: bool

    @property
    def report(self) -> Any:
        """What was printed as JSON, which `check`, `test`, `verify` and `explore` print.

        Raises ValueError if it is not JSON.
        """
        return json.loads(self.output)


@dataclasses.dataclass(frozen=True)
class _Task:
    path: str
    part: str | None
    arguments: tuple[str, ...]
    # The folder or file that travels, from the root.
    unit: str
    # Identifies the files and the arguments.
    key: str


def run(
    command: str,
    paths: Iterable[str | os.PathLike[str]],
    options: Sequence[str] = (),
    *,
    root: str | os.PathLike[str] = ".",
    parts: int = 1,
    cache: str | os.PathLike[str] | None = None,
    at_once: int = 256,
    retries: int = 3,
    executable: str | None = None,
) -> Iterator[Result]:
    """Runs a command of rungc on many programs or test files.

    `paths` are below `root`, from which a task sees them. Of a folder, all programs in it and below are taken, and for
    `test` all test files. With a program travels what belongs to it: the folder of its rungc.toml; without one, of a
    test file its folder, else the program alone. `parts` divides each test file by `--shard`.

    `cache` is a folder for results: a task whose files, arguments and version are those of an earlier one is not run
    again. Options with a time limit give results that depend on the machine, and are better left out then.

    `at_once` limits the tasks that are given to Ray before the first result is taken, `retries` the attempts after the
    loss of a worker. `executable` is the command on the workers; default: that of the wheel.

    Raises ValueError for a path that is not below the root, or has no program; RuntimeError for a worker with another
    version of rungc; and what Ray raises when a task is lost too often.
    """
    if parts < 1 or parts > 1 and command != "test":
        raise ValueError("only test files are divided, into at least one part")
    if not ray.is_initialized():
        ray.init(log_to_driver=False)
    base = pathlib.Path(root).resolve()
    work = ray.remote(max_retries=retries)(_work)
    units: dict[str, tuple[str, Any]] = {}
    folder = None if cache is None else pathlib.Path(cache)
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    pending: collections.deque[tuple[_Task, Any]] = collections.deque()
    for path in _files(command, paths, base):
        unit = _unit(path, base)
        if unit not in units:
            files = _pack(base, unit)
            units[unit] = (hashlib.sha256(files).hexdigest(), ray.put(files))
        digest, files = units[unit]
        for part in range(1, parts + 1):
            task = _task(command, path, options, unit, digest, (part, parts))
            known = _known(folder, task)
            waits = known if known is not None else work.remote(files, task, executable)
            pending.append((task, waits))
            if len(pending) >= at_once:
                yield _result(*pending.popleft(), folder)
    while pending:
        yield _result(*pending.popleft(), folder)


def _files(
    command: str, paths: Iterable[str | os.PathLike[str]], base: pathlib.Path
) -> Iterator[str]:
    """Paths of programs or test files, from the root, each once, those of a folder in their order by name."""
    seen = set()
    for given in paths:
        path = (base / given).resolve()
        if not path.is_relative_to(base):
            raise ValueError(f"{given} is not below {base}")
        if not path.exists():
            raise ValueError(f"there is no {given}")
        found = [path]
        if path.is_dir():
            found = sorted(below for below in path.rglob("*") if _is_taken(command, below))
            if not found:
                raise ValueError(f"{given} has no {'test files' if command == 'test' else 'programs'}")
        for file in found:
            name = file.relative_to(base).as_posix()
            if name not in seen:
                seen.add(name)
                yield name


def _is_taken(command: str, path: pathlib.Path) -> bool:
    if command == "test":
        return path.name.endswith(_TESTS)
    return path.suffix.lower() in _PROGRAMS and path.is_file()


def _unit(path: str, base: pathlib.Path) -> str:
    """The folder or file that belongs to a program, from the root."""
    file = base / path
    for folder in [file, *file.parents]:
        if (folder / _SETTINGS).is_file():
            return folder.relative_to(base).as_posix()
        if folder == base:
            break
    belongs = file.parent if file.name.endswith(_TESTS) else file
    return belongs.relative_to(base).as_posix()


def _pack(base: pathlib.Path, unit: str) -> bytes:
    """The files of a unit, always as the same bytes."""
    top = base / unit
    files = [top] if top.is_file() else sorted(file for file in top.rglob("*") if file.is_file())
    size = sum(file.stat().st_size for file in files)
    if size > _MOST_BYTES:
        raise ValueError(f"{top} has {size} bytes: give it a rungc.toml in a smaller folder")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in files:
            name = zipfile.ZipInfo(file.relative_to(base).as_posix())
            name.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(name, file.read_bytes())
    return packed.getvalue()


def _task(
    command: str,
    path: str,
    options: Sequence[str],
    unit: str,
    digest: str,
    part: tuple[int, int],
) -> _Task:
    arguments = [command, path, *options]
    divided = None
    if part[1] > 1:
        divided = f"{part[0]}/{part[1]}"
        arguments += ["--shard", divided]
    has_form = any(option.split("=")[0] in ("--format", "--mutants", "--coverage") for option in options)
    if command in ("check", "test", "verify", "explore") and not has_form:
        arguments += ["--format", "json"]
    names = json.dumps([__version__, digest, arguments]).encode()
    key = hashlib.sha256(names).hexdigest()
    return _Task(path, divided, tuple(arguments), unit, key)


def _known(cache: pathlib.Path | None, task: _Task) -> Result | None:
    """The result of an earlier run."""
    if cache is None:
        return None
    try:
        kept = json.loads((cache / f"{task.key}.json").read_text("utf-8"))
        code, output, errors = kept["code"], kept["output"], kept["errors"]
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return Result(task.path, task.part, code, output, errors, cached=True)


def _result(task: _Task, waits: Any, cache: pathlib.Path | None) -> Result:
    if isinstance(waits, Result):
        return waits
    code, output, errors = ray.get(waits)
    if cache is not None and code in _LASTING:
        kept = json.dumps({"code": code, "output": output, "errors": errors})
        with tempfile.NamedTemporaryFile("w", dir=cache, delete=False, encoding="utf-8") as file:
            file.write(kept)
        os.replace(file.name, cache / f"{task.key}.json")
    return Result(task.path, task.part, code, output, errors, cached=False)


def _command() -> str:
    """The executable that the wheel has installed, else that of the search path."""
    suffix = ".exe" if os.name == "nt" else ""
    own = pathlib.Path(sysconfig.get_path("scripts"), f"rungc{suffix}")
    found = str(own) if own.is_file() else shutil.which("rungc")
    if found is None:
        raise RuntimeError("there is no command `rungc`: install its wheel on all workers")
    return found


def _check_version(command: str) -> None:
    """Raises RuntimeError for another version than that of this module; asks once in a worker."""
    if command in _checked:
        return
    asked = subprocess.run([command, "--version"], capture_output=True, text=True, check=True)
    version = asked.stdout.split()[-1]
    if version != __version__:
        raise RuntimeError(f"a worker has rungc {version}, this is {__version__}")
    _checked.add(command)


def _work(files: bytes, task: _Task, executable: str | None) -> tuple[int, str, str]:
    """Runs a task on a worker: exit code, standard output, standard error."""
    command = executable or _command()
    _check_version(command)
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(io.BytesIO(files)) as archive:
            archive.extractall(folder)
        # A task has one processor, and caches of a worker say nothing to others.
        settings = {**os.environ, "RUNGC_THREADS": "1"}
        done = subprocess.run(
            [command, *task.arguments],
            cwd=folder,
            env=settings,
            capture_output=True,
            text=True,
            encoding="utf-8",
            check=False,
        )
    return done.returncode, done.stdout, done.stderr
