"""Sessions beyond `.ci/run`: other Python versions, the documentation to look at, its pictures, benchmarks."""

import nox

nox.options.default_venv_backend = "venv"
nox.options.sessions = ["tests"]


@nox.session(python=["3.11", "3.12", "3.13"])
def tests(session: nox.Session) -> None:
    session.install("-e", ".[test]")
    session.run("pytest", *session.posargs)


@nox.session(python="3.11")
def docs(session: nox.Session) -> None:
    session.install("-e", ".", *nox.project.dependency_groups(nox.project.load_toml(), "docs"))
    session.run("sphinx-build", "-W", "--keep-going", "-b", "html", "docs", "docs/_build/html")


@nox.session(python="3.11")
def pictures(session: nox.Session) -> None:
    """Draw the pictures of the README and the documentation anew; that of the report needs chromium."""
    session.install("-e", ".[test]")
    session.run("python", "docs/pictures.py")


@nox.session(python="3.11")
def bench(session: nox.Session) -> None:
    """Time wearlaw beside its rivals; the rivals in C need a compiler."""
    session.install("-e", ".[fast]")
    session.run("python", "-m", "tests.benchmarks.speed", *session.posargs)
    session.run("python", "-m", "tests.benchmarks.wheel_rail")
    session.run("python", "-m", "tests.benchmarks.fit")
    session.run("python", "tests/benchmarks/study.py")
    session.install("-e", ".[fast,dask]")
    session.run("python", "-m", "tests.benchmarks.sweep")
