"""Mutation testing: make one small change at a time in a module, and see whether its tests fail; see `mutation.md`.

The mutations are those of cosmic-ray, and two more: a quantity in a text such as "47 mm" grows by one per cent, and a
call for its effect alone, or a raise, is left out. No file is changed: each mutant is compiled in a process of its own,
forked from one that has imported what does not change, so that a mutant costs little more than its tests.
"""

from __future__ import annotations

import gc
import importlib
import importlib.machinery
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from types import CodeType
from typing import Any

import hypothesis
import pytest
from cosmic_ray.ast import ast_nodes, get_ast  # pyright: ignore[reportMissingImports]
from cosmic_ray.mutating import mutate_code  # pyright: ignore[reportMissingImports]
from cosmic_ray.operators.provider import OperatorProvider  # pyright: ignore[reportMissingImports]
from parso.python.tree import Keyword, String  # pyright: ignore[reportMissingImports]

ROOT = Path(__file__).parents[1]

TESTS = {
    "wearlaw_models.laws.archard": "plugins/archard/test_archard.py",
    "wearlaw_models.laws.brr": "plugins/brr/test_brr.py",
    "wearlaw_apps.contact_files": "plugins/contact_files/test_contact_files.py",
    "wearlaw_models.laws.energy": "plugins/energy/test_energy.py",
    "wearlaw_models.contact_models.exact": "plugins/exact/test_kernel.py plugins/exact/test_exact.py test_numbers.py",
    "wearlaw_models.contact_models.fastsim": "plugins/fastsim/test_kernel.py plugins/fastsim/test_first_slip.py"
    " plugins/fastsim/test_fastsim.py plugins/fastsim/test_solution.py plugins/fastsim/test_strip_forces.py"
    " plugins/fastsim/test_strip_fields.py"
    " plugins/fastsim/test_limits.py"
    " plugins/fastsim/test_given_strips.py",
    "wearlaw_models.contact_models.global_": "plugins/global/test_global.py",
    "wearlaw_models.laws.kth": "plugins/kth/test_kth.py",
    "wearlaw_models.contact_models.linear": "plugins/linear/test_linear.py",
    "wearlaw_models.contact_models.polach": "plugins/polach/test_polach.py",
    "wearlaw_apps.papers.tassini2010": "plugins/tassini2010/test_claims.py plugins/tassini2010/test_tables.py",
    "wearlaw_models.contact_models.shen_hedrick_elkins": "plugins/shen_hedrick_elkins/test_shen_hedrick_elkins.py",
    "wearlaw_models.stages.thermal": "plugins/thermal/test_thermal.py",
    "wearlaw_models.stages.third_body": "plugins/third_body/test_third_body.py",
    "wearlaw_models.laws.usfd": "plugins/usfd/test_usfd.py",
    "wearlaw_models.laws.wlrm": "plugins/wlrm/test_wlrm.py",
    "wearlaw.pipeline.composition": "core/test_composition.py core/test_pipeline.py"
    " plugins/wheel_rail/test_wheel_rail.py plugins/wheel_rail/test_result.py"
    " core/test_unlike_materials.py core/test_several_patches.py core/test_outcomes.py",
    "wearlaw.contact.hertz": "core/test_hertz.py core/test_unlike_materials.py",
    "wearlaw.contact.hertz_ellipse": "core/test_hertz_ellipse.py",
    "wearlaw.numerics.splits": "core/test_splits.py",
    "wearlaw.parameters": "core/test_varying.py",
    "wearlaw.pipeline.pipeline": "core/test_composition.py core/test_pipeline.py plugins/fits/test_uncertainty.py"
    " plugins/fits/test_uncertainty_refusals.py plugins/sweeps/test_inverse.py"
    " plugins/wheel_rail/test_wheel_rail.py plugins/wheel_rail/test_result.py core/test_models.py",
    "wearlaw.contact.contact": "core/test_contact_from_arrays.py core/test_elliptic_contact.py"
    " plugins/fastsim/test_given_strips.py core/test_several_patches.py core/test_outcomes.py"
    " plugins/studies/test_materials.py core/test_models.py core/test_blame.py",
    "wearlaw_models.laws.archard.coefficients": "plugins/archard/test_wear_coefficients.py",
    "wearlaw.units.quantities": "core/test_units.py core/test_configuration.py",
}
"""The test files of each package or module; a plugin must pass the conformance kit too, and each mutant the oracle."""

ORACLE = "tests/test_oracle.py"
"""Comes last, as it takes longest: it sees any number that moves."""

BINARY = ["Add_Sub", "Sub_Add", "Mul_Div", "Div_Mul", "Pow_Mul", "FloorDiv_Div", "BitOr_BitAnd", "BitAnd_BitOr"]
COMPARISON = ["Lt_LtE", "Lt_GtE", "LtE_Lt", "LtE_Gt", "Gt_GtE", "Gt_LtE", "GtE_Gt", "GtE_Lt"]
COMPARISON += ["Eq_NotEq", "NotEq_Eq", "Is_IsNot", "IsNot_Is"]
OPERATORS = [
    *(f"ReplaceBinaryOperator_{pair}" for pair in BINARY),
    *(f"ReplaceComparisonOperator_{pair}" for pair in COMPARISON),
    *("ReplaceUnaryOperator_USub_UAdd", "ReplaceUnaryOperator_Delete_Not", "AddNot", "ReplaceAndWithOr"),
    *("ReplaceOrWithAnd", "ReplaceTrueWithFalse", "ReplaceFalseWithTrue", "ReplaceBreakWithContinue"),
    *("ReplaceContinueWithBreak", "ExceptionReplacer", "NumberReplacer", "ZeroIterationForLoop"),
]
"""One replacement or two of each operator; the others of cosmic-ray fall to the same tests."""

SHARED = {
    *("_pytest", "click", "h5netcdf", "h5py", "jinja2", "matplotlib", "mpmath", "numpy", "packaging", "pandas", "pint"),
    *("plotly", "pydantic", "pydantic_core", "rich", "scipy", "sybil", "xarray"),
}
"""What is imported once; for mutants of a plugin, the core of wearlaw too."""

PYTEST = [
    *("-x", "-q", "--assert=plain", "--override-ini=addopts=", "--hypothesis-profile=mutation"),
    *("-p", "_hypothesis_pytestplugin", "-p", "no:cacheprovider", "-p", "no:unraisableexception"),
]

FACTOR, LEAST = 4.0, 20.0
"""A mutant is killed if its tests take this many times as long as without it, and at least this many seconds."""


class _NumberInText:
    """Make a quantity in a text one per cent larger."""

    def mutation_positions(self, node: Any) -> Iterator[Any]:
        if isinstance(node, String) and re.fullmatch(r"""["'][-+]?[0-9.]+(e-?\d+)? \S*[a-zA-Z%]\S*["']""", node.value):
            yield node.start_pos, node.end_pos

    def mutate(self, node: Any, _: int) -> Any:
        number, _, unit = node.value[1:-1].partition(" ")
        return String(f'"{float(number) * 1.01 or 0.01:.12g} {unit}"', node.start_pos, node.prefix)


class _LeftOut:
    """Leave out a call for its effect alone, or a raise."""

    def mutation_positions(self, node: Any) -> Iterator[Any]:
        call = node.type in ("atom_expr", "power") and node.parent.type == "simple_stmt"
        if call or node.type == "raise_stmt":
            yield node.start_pos, node.end_pos

    def mutate(self, node: Any, _: int) -> Any:
        return Keyword("pass", node.start_pos, node.get_first_leaf().prefix)


def mutants(source: str) -> Iterator[tuple[int, str, str]]:
    """Yield line, name of the operator and source of each mutant."""
    provider, tree = OperatorProvider(), get_ast(source)
    kinds: list[Any] = [*(provider[name] for name in OPERATORS), _NumberInText, _LeftOut]
    for operator in (kind() for kind in kinds):
        places = [(node, position) for node in ast_nodes(tree) for position in operator.mutation_positions(node)]
        for occurrence, (node, position) in enumerate(places):
            if not _is_of_a_signature(node):
                mutant: Any = mutate_code(source, operator, occurrence)
                yield position[0][0], type(operator).__name__.lstrip("_"), mutant


def _is_of_a_signature(node: Any) -> bool:
    """Return whether a node stands in the type of a name, an argument or a result, or is the star among arguments."""
    if node.parent is not None and node.parent.type in ("parameters", "param", "arglist", "argument"):
        return bool(node.type == "operator")
    while node.parent is not None:
        siblings, parent = node.parent.children, node.parent
        before = siblings[next(i for i, sibling in enumerate(siblings) if sibling is node) - 1]
        if (parent.type in ("annassign", "tfpdef") and before == ":") or (parent.type == "funcdef" and before == "->"):
            return True
        node = parent
    return False


def run_tests(path: Path, source: str, tests: list[str]) -> int:
    """Return pytest's exit code in a process that compiles the module at `path` from `source`."""
    original = importlib.machinery.SourceFileLoader.get_code

    def get_code(loader: importlib.machinery.SourceFileLoader, fullname: str) -> CodeType | None:
        return compile(source, path, "exec") if loader.path == str(path) else original(loader, fullname)

    importlib.machinery.SourceFileLoader.get_code = get_code  # type: ignore[assignment, method-assign]
    silent = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silent, 1)
    os.dup2(silent, 2)
    search = (hypothesis.Phase.explicit, hypothesis.Phase.generate)  # which example fails is of no interest
    hypothesis.settings.register_profile(
        "mutation", max_examples=20, deadline=None, derandomize=True, database=None, phases=search
    )
    subprocess.run = lambda *_, **__: pytest.skip("another process runs no mutant")
    os.environ |= {"WEARLAW_ACCELERATE": "0", "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    with tempfile.TemporaryDirectory() as folder:
        os.environ["NUMBA_CACHE_DIR"] = folder  # no compiled mutant is kept
        return int(pytest.main([*PYTEST, *tests]))


def in_a_fork(work: Callable[[], int], limit: float) -> int | None:
    """Return the number that work in a process of its own ends with, or None if it takes longer than `limit` [s]."""
    child = os.fork()
    if child == 0:
        os.setsid()
        try:
            os._exit(work())
        finally:
            os._exit(1)
    end = time.monotonic() + limit
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return None


def run_unchanged(path: Path, tests: list[str]) -> float:
    """Run the tests, import the modules that they used and no mutant changes, and return their time [s]."""
    shared = SHARED if (ROOT / "core") in path.parents else SHARED | {"wearlaw"}
    start = time.monotonic()
    with tempfile.NamedTemporaryFile("r", encoding="utf-8") as names:

        def run() -> int:
            code = run_tests(path, path.read_text(encoding="utf-8"), tests)
            found = [name for name in sys.modules if name.partition(".")[0] in shared]
            Path(names.name).write_text("\n".join(found), encoding="utf-8")
            return code

        if in_a_fork(run, 600.0) != 0:
            raise SystemExit(f"{' '.join(tests)}: fails without a mutation")
        seconds = time.monotonic() - start
        for name in names.read().split():
            importlib.import_module(name)
    gc.freeze()  # the collections of the mutants leave out what is shared
    return seconds


def report(path: Path, runs: list[list[str]]) -> None:
    """Print the mutants of a module that survive all runs of tests, and how many there are."""
    source = path.read_text(encoding="utf-8")
    limits = [max(LEAST, FACTOR * run_unchanged(path, tests)) for tests in runs]
    start, killed, total = time.monotonic(), 0, 0
    for line, operator, mutant in mutants(source):
        total += 1
        if all(
            in_a_fork(partial(run_tests, path, mutant, tests), limit) == 0
            for tests, limit in zip(runs, limits, strict=True)
        ):
            before, after = source.splitlines()[line - 1], mutant.splitlines()[line - 1]
            print(f"{path.relative_to(ROOT)}:{line}: {operator}\n  - {before.strip()}\n  + {after.strip()}", flush=True)
        else:
            killed += 1
    seconds = time.monotonic() - start
    print(f"{path.relative_to(ROOT)}: {killed} of {total} mutants killed in {seconds:.0f} s", flush=True)


def main(names: list[str]) -> None:
    """Test the mutants of the named packages and modules, or of all."""
    if unknown := set(names) - set(TESTS):
        raise SystemExit(f"unknown: {', '.join(unknown)}; there are: {', '.join(TESTS)}")
    # Modules of the core first: for those of plugins the core is imported, and then cannot be mutated any more.
    for name in sorted(names or TESTS, key=lambda name: not name.startswith("wearlaw.")):
        runs = [[f"tests/{path}" for path in TESTS[name].split()]]
        path = ROOT / ("core" if name.startswith("wearlaw.") else "plugins") / name.replace(".", "/")
        paths = sorted(path.glob("*.py")) if path.is_dir() else [path.with_suffix(".py")]
        if name.startswith("wearlaw_models."):
            model = name.split(".")[2].removesuffix("_")
            runs.append(["tests/test_shipped_models.py", "-k", f"test_the_model_conforms and {model}"])
        runs.append([ORACLE])
        for path in paths:
            report(path, runs)


if __name__ == "__main__":
    main(sys.argv[1:])
