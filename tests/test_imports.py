"""Imports, read from the source: in files of core and plugins, and of what is private in tests; see `lint-imports` too.

Those inside functions and for types count.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

import wearlaw as wl
from tests.environments import ROOT

DEFERRED = {
    ("wearlaw.kernels", "numba"): "is optional, and takes a second to load",
    (
        "wearlaw_apps.output.plot",
        "wearlaw_apps.output.drawing",
    ): "matplotlib takes longer to load than all else; few plot",
    ("wearlaw.numerics.crossings", "scipy.optimize"): "takes as long to load as the rest of wearlaw",
    ("wearlaw_apps.output.drawing", "matplotlib"): "pyplot loads a backend, which commands do without",
    ("wearlaw_apps.output.datasets", "xarray"): "takes as long to load as the rest of wearlaw; for datasets alone",
    (
        "wearlaw_apps.sweeps.several",
        "xarray",
    ): "takes as long to load as the rest of wearlaw; for lists of models alone",
    ("wearlaw.text_files", "tomllib"): "few scripts read a file in TOML",
    ("wearlaw_apps.sweeps.sweep", "wearlaw_apps.sweeps.store"): "zarr takes as long to load as all else",
    ("wearlaw_apps.sweeps.wear_profile", "wearlaw_apps.sweeps.folder"): "zarr takes as long to load as all else",
    ("wearlaw_apps.sweeps.workers", "loky"): "is for several processes alone",
    ("wearlaw_apps.sweeps.workers", "zarr"): "takes as long to load as all else",
    ("wearlaw_apps.tables", "pandas"): "takes half as long to load as the rest of wearlaw",
    ("wearlaw_kit.section", "wearlaw_apps.output.files"): "matplotlib takes longer to load than all else",
    ("wearlaw_kit.kit", "pytest"): "is not needed to run the checks of the kit",
    ("wearlaw_apps.fits.wear_tests", "pandas"): "takes half as long to load as the rest of wearlaw; for one method",
    ("wearlaw_apps.life", "wearlaw_apps.life.section"): "is needed for a report alone",
    ("wearlaw_apps.life.line", "wearlaw_apps.sweeps.folder"): "zarr takes as long to load as all else",
    ("wearlaw_models.rigs.wheelset", "wearlaw_models.rigs.wheelset.section"): "is needed for a report alone",
    (
        "wearlaw_models.rigs.wheelset.geometry",
        "xarray",
    ): "takes as long to load as the rest of wearlaw; for tables",
    ("wearlaw_models.rigs.wheelset.pictures", "matplotlib.figure"): "takes longer to load than all else; few plot",
    ("wearlaw_models.rigs.wheelset.pictures", "matplotlib.style"): "takes longer to load than all else; few plot",
    (
        "wearlaw_apps.papers.tassini2010",
        "wearlaw_apps.papers.tassini2010",
    ): "its sections need pandas, which looking up a plugin must not load",
}
"""All imports inside functions: by file and what is imported, and why. scipy loads its other parts by itself when they
are used; `wearlaw.late` and the table of commands load the applications."""


def modules() -> dict[str, Path]:
    """Return all files of core and plugins by their module."""
    found = {}
    for root in (ROOT / "core", ROOT / "plugins"):
        for path in root.rglob("*.py"):
            if "templates" not in path.parts:
                parts = path.relative_to(root).with_suffix("").parts
                found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported(source: str, known: Mapping[str, object]) -> Iterator[str]:
    """Yield the modules among the known ones that a source imports anywhere."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)
        elif isinstance(node, ast.ImportFrom):
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield from (name for name in [inner if inner in known else str(node.module)] if name in known)


def test_no_file_imports_a_package_that_it_lies_in() -> None:
    known = modules()
    assert {"wearlaw", "wearlaw_apps.studies.case", "wearlaw_models.laws.kth", "_wearlaw_hypothesis"} <= known.keys()
    found = {(name, one) for name, path in known.items() for one in imported(path.read_text(encoding="utf-8"), known)}
    assert [(name, one) for name, one in found if name.startswith(f"{one}.")] == []


def deferred(source: str) -> Iterator[str]:
    """Yield the imports inside functions of a source."""
    functions = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)]
    for node in {inner: None for function in functions for inner in ast.walk(function)}:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield str(node.module)


def test_imports_inside_functions_are_few_and_each_has_its_reason() -> None:
    found = {(name, one) for name, path in modules().items() for one in deferred(path.read_text(encoding="utf-8"))}
    assert sorted(found) == sorted(DEFERRED)


PLUGIN = r"wearlaw_kit|wearlaw_models\.\w+\.\w+|wearlaw_apps\.(papers\.)?\w+"
OURS = re.compile(rf"(wearlaw|{PLUGIN})\.(?!errors$)\w")
"""A name below wearlaw or one of its plugins; these themselves and `wearlaw.errors` are public."""

TESTS = [*(ROOT / "tests").rglob("*.py"), ROOT / "conftest.py"]
TESTS = [path for path in TESTS if not {"wearlaw-outside", "cases"} & {*path.parts}]


def private(source: str, known: Collection[str]) -> Iterator[str]:
    """Yield the private paths that a source imports, or patches by name, on a line without `# private: why`."""
    lines = source.splitlines()
    for node in ast.walk(ast.parse(source)):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            inner = [f"{node.module}.{alias.name}" for alias in node.names if alias.name not in wl.__all__]
            names = [node.module, *(name for name in inner if name in known)]
        elif isinstance(node, ast.Call) and getattr(node.func, "attr", "") in ("setattr", "delattr", "setitem"):
            names = [one.value for one in node.args[:1] if isinstance(one, ast.Constant) and isinstance(one.value, str)]
        else:
            continue
        if not any(re.search("# private: .", line) for line in lines[node.lineno - 1 : node.end_lineno]):
            yield from (name for name in names if OURS.match(name))


def test_tests_use_public_names_or_say_on_the_line_why_not() -> None:
    known = modules()
    found = {path: [*private(path.read_text(encoding="utf-8"), known)] for path in TESTS}
    assert {str(path.relative_to(ROOT)): names for path, names in found.items() if names} == {}


def test_pages_and_their_examples_import_no_module_of_a_plugin() -> None:
    docs = ROOT / "docs"
    pages = [ROOT / "README.md", *docs.glob("*.md"), *docs.glob("gallery/*.py"), *docs.glob("examples/*.py")]
    wrong = re.compile(r"^\s*(?:>>> )?(?:import|from) wearlaw_(?:models|apps)\b", re.MULTILINE)
    assert len(pages) > 20
    assert [page.name for page in pages if wrong.search(page.read_text(encoding="utf-8"))] == []
