"""What some of wearlaw needs beside its dependencies: any kind of failed import names the extra."""

from __future__ import annotations

import pytest

import wearlaw as wl
from wearlaw.late import MissingPackageError, needed_for  # private: what wraps late imports

INSTALL = r'; install it with: python -m pip install "wearlaw\[fits\]"$'


def pandas_without_jinja2() -> None:
    try:
        raise ModuleNotFoundError("No module named 'jinja2'", name="jinja2")
    except ImportError as error:
        raise ImportError("`Import jinja2` failed. Use pip or conda to install the jinja2 package.") from error


def raised(error: ImportError) -> None:
    raise error


@pytest.mark.parametrize(
    ("fails", "said"),
    [
        (lambda: raised(ModuleNotFoundError("No module named 'zarr'", name="zarr")), "needs zarr"),
        (pandas_without_jinja2, "needs jinja2"),
        (
            lambda: raised(ImportError("Pandas requires version '3.1.6' or newer of 'jinja2'")),
            "cannot be loaded: Pandas requires version '3.1.6' or newer of 'jinja2'",
        ),
        (
            lambda: raised(ImportError("cannot import name 'Path' from 'matplotlib'", name="matplotlib")),
            "cannot be loaded: cannot import name 'Path' from 'matplotlib'",
        ),
        (
            lambda: raised(ImportError("libhdf5.so.310: cannot open shared object file")),
            "cannot be loaded: libhdf5.so.310: cannot open shared object file",
        ),
    ],
)
def test_any_import_that_fails_names_the_extra(fails: object, said: str) -> None:
    assert callable(fails)
    with pytest.raises(MissingPackageError, match=f"^wearlaw fit {said}{INSTALL}"), needed_for("wearlaw fit", "fits"):
        fails()
    assert issubclass(MissingPackageError, wl.WearlawError)


@pytest.mark.parametrize(
    ("error", "extra"),
    [
        (ModuleNotFoundError("No module named 'wearlaw_apps.fitz'", name="wearlaw_apps.fitz"), "fits"),
        (ImportError("cannot import name 'fitz' from 'wearlaw'", name="wearlaw"), "fits"),
        (ModuleNotFoundError("No module named 'torch'", name="torch"), None),
    ],
)
def test_faults_of_wearlaw_and_of_others_stay_as_they_are(error: ImportError, extra: str | None) -> None:
    with pytest.raises(type(error)) as caught, needed_for("wearlaw fit", extra):
        raise error
    assert caught.value is error
