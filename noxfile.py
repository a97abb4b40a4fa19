"""Sessions beyond `.ci/run`: other versions of Python and dependencies, documentation, benchmarks, a release."""

import re
import shutil
from pathlib import Path

import nox

nox.needs_version = ">=2025.2"
nox.options.default_venv_backend = "venv"

PYPROJECT = nox.project.load_toml()
FOR_SLOW = nox.project.dependency_groups(PYPROJECT, "slow")
SLOW = "@tests/slow.txt"
"""The files of the slow tests, as pytest takes them from a file."""


def declared(*extras: str) -> list[str]:
    """Return the requirements of the project with extras, and with the extras that these name."""
    project = PYPROJECT["project"]
    requirements = list(project["dependencies"])
    for requirement in (each for extra in extras for each in project["optional-dependencies"][extra]):
        nested = re.fullmatch(r"wearlaw\[(.+)\]", requirement)
        requirements += declared(*nested[1].split(",")) if nested else [requirement]
    return list(dict.fromkeys(requirements))


@nox.session(python=["3.11", "3.12", "3.13", "3.14"])
def tests(session: nox.Session) -> None:
    """Test with the newest version of each dependency."""
    session.install("-e", ".[test]")
    session.run("pytest", *session.posargs)


@nox.session(python="3.11", default=False)
def slow(session: nox.Session) -> None:
    """Run the slow tests, those of the files in tests/slow.txt."""
    session.install("-e", ".[test]", *FOR_SLOW)
    session.run("pytest", "-n", "auto", SLOW, *session.posargs)


@nox.session(python="3.11", default=False)
def deep(session: nox.Session) -> None:
    """Measure the coverage, and let property tests draw twenty times the examples."""
    session.install("-e", ".[test]", *FOR_SLOW)
    session.run("pytest", "-n", "auto", "--cov", "--cov-report=", "--cov-fail-under=0")
    session.run("pytest", "-n", "auto", "--cov", "--cov-append", SLOW)
    for files in ((), (SLOW,)):
        session.run("pytest", "-n", "auto", "--hypothesis-profile=deep", "-m", "hypothesis", *files)


@nox.session(python="3.11", default=False)
def minimum(session: nox.Session) -> None:
    """Test with the lowest version of each dependency that is declared to do."""
    lowest = (requirement.replace(">=", "==") for requirement in declared("test", "dask"))
    session.install("--only-binary=:all:", "-e", ".[test,dask]", *lowest)
    # What these need in turn is the newest, of which they may use what is deprecated by now.
    session.run("pytest", "-W", "ignore::DeprecationWarning", *session.posargs)


@nox.session(python="3.11", default=False)
@nox.parametrize("extra", ["none", "sweeps", "fits", "studies", "explore", "check", "dask", "fast"])
def extras(session: nox.Session, extra: str) -> None:
    """Install each extra alone, and run what it is for."""
    session.install("." if extra == "none" else f".[{extra}]")
    session.run("python", "tests/extras.py", extra)


@nox.session(python="3.11", default=False)
def hooks(session: nox.Session) -> None:
    """Run the hooks of pre-commit on all files."""
    session.install("pre-commit>=4", "ruff>=0.11")
    session.run("pre-commit", "run", "--all-files")


@nox.session(python="3.11", default=False)
def docs(session: nox.Session) -> None:
    session.install("-e", ".[explore,check]", *nox.project.dependency_groups(PYPROJECT, "docs"))
    session.run("sphinx-build", "-W", "--keep-going", "-b", "html", "docs", "docs/_build/html")


@nox.session(python="3.11", default=False)
def pictures(session: nox.Session) -> None:
    """Draw the pictures of the README and the documentation anew; that of the report needs chromium."""
    session.install("-e", ".[test]", *FOR_SLOW)
    session.run("python", "-m", "docs.pictures")


@nox.session(python="3.11", default=False)
def bench(session: nox.Session) -> None:
    """Time wearlaw beside its rivals; the rivals in C need a compiler."""
    session.install("-e", ".[fast]")
    session.run("python", "-m", "tests.benchmarks.speed", *session.posargs)
    session.install("-e", ".[fast,studies]")
    session.run("python", "-m", "tests.benchmarks.sweep")


@nox.session(python="3.11", default=False)
def repo_review(session: nox.Session) -> None:
    """Go through the checklist of Scientific Python; `pyproject.toml` says what is declined and why."""
    session.install("sp-repo-review[cli]")
    session.run("repo-review", ".")


@nox.session(python="3.11", default=False)
def release(session: nox.Session) -> None:
    """Build what would be released into dist/, try it, and say what is missing or left to a person."""
    session.install("build", "check-sdist", "check-wheel-contents", "packaging", "pipx", "twine")
    shutil.rmtree("dist", ignore_errors=True)
    session.run("python", "-m", "build")
    session.run("check-sdist", "--installer=pip")
    (sdist,), (wheel,) = Path("dist").glob("*.tar.gz"), Path("dist").glob("*.whl")
    session.run("twine", "check", "--strict", str(sdist), str(wheel))
    session.run("check-wheel-contents", str(wheel))
    tried = Path(session.create_tmp())
    program = ("pipx", "run", "--spec", str(wheel), "wearlaw")
    session.run(*program, "run", "tassini2010", "-o", str(tried / "out"), env={"PIPX_HOME": str(tried / "pipx")})
    session.run("python", "-m", "tests.release")


@nox.session(python="3.11", default=False)
def mutation(session: nox.Session) -> None:
    """Break a module in every small way and see if tests fail, as tests/mutation.md says."""
    session.install("-e", ".[test]", "cosmic-ray>=8.7")
    module, *tests = session.posargs or session.error("name a module and its tests, as tests/mutation.md does")
    folder = Path(session.create_tmp())
    config, results = str(folder / "config.toml"), str(folder / "results.sqlite")
    Path(config).write_text(
        f'[cosmic-ray]\nmodule-path = "{module}"\ntimeout = 300.0\n'
        f'test-command = "python -m pytest -x -q {" ".join(tests)}"\n[cosmic-ray.distributor]\nname = "local"\n',
        encoding="utf-8",
    )
    session.run("cosmic-ray", "init", "--force", config, results)
    session.run("cosmic-ray", "baseline", config)
    session.run("cosmic-ray", "exec", config, results)
    session.run("cr-report", "--surviving-only", "--show-diff", results)
