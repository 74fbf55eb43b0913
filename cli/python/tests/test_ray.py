"""Programs on a local cluster of Ray: the same results as on one machine, also where a worker is lost."""

import json
import pathlib
import subprocess

import pytest

ray = pytest.importorskip("ray")

import rungc.ray  # noqa: E402

EXAMPLES = pathlib.Path(__file__).resolve().parents[3] / "examples"


@pytest.fixture(scope="module", autouse=True)
def cluster():
    ray.init(num_cpus=2, log_to_driver=False, include_dashboard=False)
    yield
    ray.shutdown()


def untimed(report):
    """A report without the seconds that it took."""
    if isinstance(report, dict):
        return {key: untimed(value) for key, value in report.items() if key != "seconds"}
    if isinstance(report, list):
        return [untimed(value) for value in report]
    return report


def alone(*arguments):
    command = rungc.ray._command()
    done = subprocess.run([command, *arguments], cwd=EXAMPLES, capture_output=True, text=True)
    return done.returncode, untimed(json.loads(done.stdout))


def test_results_are_those_of_one_machine_in_the_same_order():
    results = list(rungc.ray.run("check", ["programs", "press"], root=EXAMPLES))
    paths = [result.path for result in results]
    assert len(paths) > 15 and paths == sorted(paths[:-1]) + paths[-1:]
    for result in results:
        expected = alone("check", result.path, "--format", "json")
        assert (result.code, untimed(result.report)) == expected, result.path


def test_tests_are_divided_and_their_machines_travel():
    parts = list(rungc.ray.run("test", ["programs/drill.plctest.toml"], root=EXAMPLES, parts=3))
    assert [result.part for result in parts] == ["1/3", "2/3", "3/3"]
    code, whole = alone("test", "programs/drill.plctest.toml", "--format", "json")
    cases = [case["name"] for result in parts if result.output for case in result.report["cases"]]
    assert sorted(cases) == sorted(case["name"] for case in whole["cases"])
    assert code == 0 and all(result.code in (0, 2) for result in parts)


def test_results_are_cached_by_content(tmp_path):
    program = tmp_path / "machines" / "motor.il"
    program.parent.mkdir()
    program.write_text("LD X000\nOUT Y000\nEND\n")
    options = ["--never", "Y000"]

    def verdict():
        (result,) = rungc.ray.run(
            "verify", ["machines"], options, root=tmp_path, cache=tmp_path / "verdicts"
        )
        return result

    first, again = verdict(), verdict()
    assert (first.code, first.cached, again.cached) == (1, False, True)
    assert again.output == first.output
    program.write_text("LD M0\nOUT Y001\nEND\n")
    changed = verdict()
    assert (changed.code, changed.cached) == (0, False)


def test_a_task_of_a_lost_worker_runs_again(tmp_path):
    for n in range(4):
        (tmp_path / f"{n}.il").write_text("LD X000\nOUT Y000\nEND\n")
    # The command ends its worker the first time.
    lost = tmp_path / "lost"
    slow = tmp_path / "rungc"
    real = rungc.ray._command()
    slow.write_text(
        "#!/bin/sh\n"
        f'if [ "$1" != --version ] && mkdir "{lost}" 2>/dev/null; then kill -9 $PPID; fi\n'
        f'exec "{real}" "$@"\n'
    )
    slow.chmod(0o755)
    results = list(rungc.ray.run("check", ["."], root=tmp_path, executable=str(slow)))
    assert lost.is_dir()
    assert [(result.path, result.code) for result in results] == [(f"{n}.il", 0) for n in range(4)]


def test_what_cannot_run_is_an_error(tmp_path):
    with pytest.raises(ValueError, match="is not below"):
        list(rungc.ray.run("check", ["/"], root=tmp_path))
    with pytest.raises(ValueError, match="has no programs"):
        list(rungc.ray.run("check", ["."], root=tmp_path))
    with pytest.raises(ValueError, match="divided"):
        list(rungc.ray.run("check", ["."], root=tmp_path, parts=2))
    (tmp_path / "a.il").write_text("LD X000\nOUT Y000\nEND\n")
    other = tmp_path / "other"
    other.write_text("#!/bin/sh\necho rungc 0.0.0\n")
    other.chmod(0o755)
    with pytest.raises(ray.exceptions.RayTaskError, match="0.0.0"):
        list(rungc.ray.run("check", ["."], root=tmp_path, executable=str(other)))
