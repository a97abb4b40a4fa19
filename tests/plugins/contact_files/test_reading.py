"""Contacts read from files by the readers of plugins, and batches of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.cases import wearlaw
from tests.core.distributions import Install
from tests.plugins.contact_files.files import FILES
from wearlaw import Q
from wearlaw.errors import CompositionError, DataError, ModelError, UnknownModelError

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning", "ignore::wearlaw.RangeWarning")

READER = """
    import numpy as np
    import wearlaw as wl

    class Printed(wl.Reader):
        \"\"\"An ellipse of which the file holds the creepage.\"\"\"

        name = "{name}"
        source = "a test"
        suffixes = ("{suffix}",)

        friction_coefficient: float = 0.3
        \"\"\"Friction coefficient, μ [-].\"\"\"

        @classmethod
        def recognises(cls, head):
            return head.startswith(b"{mark}")

        def read(self, path):
            problem = wl.Problem.ellipse(
                a="6 mm", b="4 mm", normal_force="80 kN", shear_modulus="82 GPa", poisson_ratio=0.28,
                friction_coefficient=self.friction_coefficient, lateral_creepage="0 %", spin="0 1/m",
                longitudinal_creepage=path.read_text().split()[1] + " %")
            bodies = {{"wheel": wl.Body(wl.steel(), 0.46), "rail": wl.Body(wl.steel(), float("inf"))}}
            contact = wl.contact_model("fastsim").solve(problem.replaced(bodies=bodies))
            return {result}

    @wl.hookimpl
    def wearlaw_models():
        return [Printed]
"""


def reader(name: str = "printed", suffix: str = ".prt", mark: str = "PRINTED", result: str = "contact") -> str:
    return READER.format(name=name, suffix=suffix, mark=mark, result=result)


def printed(folder: Path, creepage: str = "0.2", name: str = "one.prt", mark: str = "PRINTED") -> Path:
    path = folder / name
    path.write_text(f"{mark} {creepage}\n", encoding="utf-8")
    return path


def test_a_reader_of_a_plugin_is_found_by_the_ending_and_takes_its_fields(install: Install, tmp_path: Path) -> None:
    install("wearlaw_prt", reader())
    assert "printed" in wl.installed("reader")
    assert "contact_mat" in wl.installed("reader")
    contact = wl.read_contact(printed(tmp_path))
    assert contact.problem is not None
    assert contact.problem.longitudinal_creepage == pytest.approx(0.002)
    assert wl.read_contact(str(printed(tmp_path)), friction_coefficient=0.2).tangential_force < contact.tangential_force
    upper = printed(tmp_path, name="ONE.PRT")
    assert wl.read_contact(upper).wear_index == contact.wear_index
    other = printed(tmp_path, name="one.dat")
    assert wl.read_contact(other, reader="printed").wear_index == contact.wear_index
    with pytest.raises(
        wl.ConfigurationError, match=r"printed: friction: unknown field; did you mean 'friction_coefficient'"
    ):
        wl.read_contact(upper, friction=0.2)
    listed = wearlaw("plugins").stdout.split()
    assert listed[listed.index("printed") - 1 : listed.index("printed") + 2] == ["reader", "printed", "wearlaw_prt"]
    shown = wearlaw("show", "printed").stdout
    assert "friction_coefficient = 0.3" in shown
    assert shown.endswith("reads files that end in .prt\n")


def test_readers_of_one_ending_are_told_apart_by_the_content(install: Install, tmp_path: Path) -> None:
    install("wearlaw_one", reader("one"))
    install("wearlaw_other", reader("other", mark="OTHER"))
    assert wl.read_contact(printed(tmp_path)).problem is not None
    assert wl.read_contact(printed(tmp_path, "0.3", mark="OTHER")).wear_index > 0.0
    with pytest.raises(
        UnknownModelError,
        match=r"none of the readers for its ending recognises it, 'one' of wearlaw_one 1.0 \(plugin 'wearlaw_one'\) and"
        r" 'other' of wearlaw_other 1.0 .*; name one, as in read_contact\(path, reader=...\)",
    ):
        wl.read_contact(printed(tmp_path, mark="NEITHER"))
    install("wearlaw_third", reader("third"))
    with pytest.raises(UnknownModelError, match=r"several readers recognise it, 'one' of .* and 'third' of we"):
        wl.read_contact(printed(tmp_path))
    assert wl.read_contact(printed(tmp_path), reader="third").wear_index > 0.0


def test_a_plugin_may_read_the_files_of_a_shipped_reader(install: Install, tmp_path: Path) -> None:
    install("wearlaw_one", reader("one", suffix=".mat"))
    assert wl.read_contact(printed(tmp_path, name="own.mat")).wear_index > 0.0
    assert wl.read_contact(FILES["tread"]).normal_force == pytest.approx(4489.7, rel=1e-4)


def test_two_readers_of_one_name_are_named_with_their_distributions(install: Install, tmp_path: Path) -> None:
    install("wearlaw_one", reader())
    install("wearlaw_two", reader())
    with pytest.raises(UnknownModelError, match=r"several readers recognise it, 'printed' .* wearlaw_two"):
        wl.read_contact(printed(tmp_path))
    with pytest.raises(UnknownModelError, match=r"reader 'printed' is provided more than once, by wearlaw_one 1.0"):
        wl.read_contact(printed(tmp_path), reader="printed")


def test_files_that_cannot_be_read_are_named(install: Install, tmp_path: Path) -> None:
    install("wearlaw_prt", reader())
    path = printed(tmp_path)
    with pytest.raises(DataError, match=r"there is no file '.*onee.prt'; did you mean 'one.prt'\?"):
        wl.read_contact(path.with_name("onee.prt"))
    with pytest.raises(DataError, match=r"cannot read '.*': Is a directory"):
        wl.read_contact(tmp_path)
    with pytest.raises(DataError, match=r"no reader reads files that end in '.csv'; those .* end in .mat, .prt"):
        wl.read_contact(printed(tmp_path, name="one.csv"))
    with pytest.raises(UnknownModelError, match="no reader is called 'print'; did you mean 'printed'"):
        wl.read_contact(path, reader="print")
    with pytest.raises(wl.InputError, match="paths: give at least one file"):
        wl.read_contact([])


@pytest.mark.parametrize(
    ("result", "message"),
    [
        ("None", "reader 'printed' returned None, not a wearlaw.Contact with its problem"),
        ("contact.replaced(problem=None)", "not a wearlaw.Contact with its problem"),
        ("1 / 0", "reader 'printed' failed: ZeroDivisionError"),
        ("contact.replaced(pressure=np.nan * contact.pressure)", "reader 'printed' gave a pressure that is not finite"),
        ("contact.replaced(area=-contact.area)", "reader 'printed' gave a negative area"),
        ("contact.replaced(slip=contact.slip[:3])", "reader 'printed' gave a slip of shape"),
        (
            "contact.replaced(force_x=2 * contact.force_x)",
            "reader 'printed' gave a longitudinal force of .*, but its no",
        ),
    ],
)
def test_a_reader_that_returns_something_wrong_is_named(
    result: str, message: str, install: Install, tmp_path: Path
) -> None:
    install("wearlaw_prt", reader(result=result))
    with pytest.raises(ModelError, match=message):
        wl.read_contact(printed(tmp_path))


def test_a_reader_needs_endings_and_starts_no_pipeline() -> None:
    for wrong in ("()", '".mat"'):
        with pytest.raises(TypeError, match="suffixes must be a tuple"):
            exec(f"class Wrong(wl.Reader):\n    name = 'wrong'\n    suffixes = {wrong}", {"wl": wl})
    with pytest.raises(CompositionError, match="reader 'contact_mat' cannot start a pipeline"):
        _ = wl.installed("reader")["contact_mat"]() | wl.wear_law("usfd")


@pytest.mark.parametrize(("digits", "works"), [(None, False), (6, True), (7, True), (8, False)])
def test_tractions_may_exceed_their_bound_by_the_rounding_of_printed_digits(
    digits: int | None, works: bool, install: Install, tmp_path: Path
) -> None:
    """Where the patch slips, the traction is its bound. A share of 3e-7 more is within 1e-6, but not within 1e-7."""
    grown = "contact.replaced(**{name: (1 + 3e-7) * getattr(contact, name) for name in ('traction', 'traction_x')})"
    install("wearlaw_prt", reader(result=grown).replace("suffixes =", f"digits = {digits}\n        suffixes ="))
    if works:
        assert wl.read_contact(printed(tmp_path)).wear_index > 0.0
    else:
        with pytest.raises(ModelError, match="where its own bound is"):
            wl.read_contact(printed(tmp_path))


def test_a_reader_itself_reads_a_file(install: Install, tmp_path: Path) -> None:
    install("wearlaw_prt", reader())
    slippery = wl.installed("reader")["printed"](friction_coefficient=0.2)
    path = printed(tmp_path)
    found = wl.read_contact(path, reader=slippery)
    assert found.wear_index == wl.read_contact(path, reader="printed", friction_coefficient=0.2).wear_index
    assert wl.read_contact(path, reader=slippery, friction_coefficient=0.3).wear_index != found.wear_index


def test_a_batch_of_files_has_the_results_of_each_of_them() -> None:
    paths = [FILES["tread"], FILES["flange"]]
    singles, batch = [wl.read_contact(path) for path in paths], wl.read_contact(paths)
    assert batch.rolling_speed.shape == (2,)
    assert batch.pressure.shape == (2, *np.max([one.pressure.shape for one in singles], axis=0))
    law = wl.wear_law("kth")  # jumps within cells
    together = wl.Prediction.of(batch, law)
    for index, single in enumerate(singles):
        alone = wl.Prediction.of(single, law)
        for name in ("wear_rate", "wear_index", "cell_wear_index", "patch_area", "stick_ratio", "max_pressure", "spin"):
            assert together[name][index].m == pytest.approx(alone[name].m, rel=1e-12), name
        assert together.wear_rate_of("rail")[index].m == pytest.approx(alone.wear_rate_of("rail").m, rel=1e-12)
        for body in ("wheel", "rail"):
            own, across = alone.wear_profile(body), together.wear_profile(body).isel(point_0=index)
            count = own.y.size
            assert across.depth[:count].values == pytest.approx(own.depth.values, rel=1e-12)
            assert (across.depth[count:] == 0.0).all()
            assert across.y[:count].values == pytest.approx(own.y.values)
            assert np.diff(across.y) == pytest.approx(0.2)  # the strips go on beyond the patch
        one = together.isel(point_0=index)
        assert one.wear_rate_of("rail").m == pytest.approx(alone.wear_rate.m, rel=1e-12)
        assert one.contact.force_y == pytest.approx(single.force_y)
        assert one.wear_rate_error.m == pytest.approx(alone.wear_rate_error.m, rel=1e-12)


def test_files_that_do_not_fit_together_are_refused(install: Install, tmp_path: Path) -> None:
    with pytest.raises(wl.InputError, match=r"half_space.0001.mat': has no radius of 'wheel', but '.*flange"):
        wl.read_contact([FILES["tread"], FILES["half_space"]])
    both = wl.read_contact([FILES["tread"], FILES["half_space"]], wheel_radius="460 mm")
    assert both.problem is not None
    assert both.problem.contact_angle == pytest.approx([-1.17022, 0.0])
    install("wearlaw_prt", reader(result="contact.mapped(lambda array: array[None])"))
    assert wl.read_contact(printed(tmp_path)).rolling_speed.shape == (1,)
    with pytest.raises(wl.InputError, match=r"one.prt': holds several operating points; read it alone"):
        wl.read_contact([printed(tmp_path)])


def test_unlike_materials_do_not_share_a_batch(tmp_path: Path, install: Install) -> None:
    install("wearlaw_prt", reader())
    with pytest.raises(wl.InputError, match=r"is of geometry 'ellipse', but '.*flange.0001a.mat' is of 'strips'"):
        wl.read_contact([FILES["tread"], printed(tmp_path)])
    bronze = '{"wheel": wl.Body(wl.steel(density="8800 kg/m^3"), 0.46), "rail": wl.Body(wl.steel(), 1.0)}'
    result = f"contact.replaced(problem=contact.problem.replaced(bodies={bronze}))"
    install("wearlaw_pru", reader("bronze", suffix=".pru", result=result))
    with pytest.raises(wl.InputError, match=r"its bodies are of other materials than those of '.*one.prt'"):
        wl.read_contact([printed(tmp_path), printed(tmp_path, name="one.pru")])


def test_laws_on_a_solved_contact_give_what_the_pipeline_gives() -> None:
    rig = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
    conditions: Any = {"normal_force": Q([60.0, 80.0, 100.0], "kN"), "longitudinal_creepage": "0.8 %",
                       "spin": "0.2 1/m", "friction_coefficient": 0.3}  # fmt: skip
    law = wl.wear_law("kth")
    for model in ("fastsim", "polach"):
        one = rig | wl.contact_model(model) | law
        found = one(**conditions)
        again = wl.Prediction.of(found.contact, law)
        for name in ("wear_rate", "cell_wear_index", "mass_per_distance", "longitudinal_force", "stick_ratio"):
            assert again[name].m == pytest.approx(found[name].m, rel=1e-12), (model, name)
        assert again.scale == found.scale
    assert again.depth_per_distance("wheel").m == pytest.approx(found.depth_per_distance("wheel").m)


def test_what_a_solved_contact_cannot_do_says_so() -> None:
    contact, usfd = wl.read_contact(FILES["tread"]), wl.wear_law("usfd")
    with pytest.raises(wl.InputError, match=r"contact: has no problem, .* use contact \| law"):
        wl.Prediction.of(contact.replaced(problem=None), usfd)
    with pytest.raises(CompositionError, match=r"resolves it into cells; take the means first, contact.patch_mean"):
        wl.Prediction.of(contact, wl.wear_law("brr"))
    assert wl.Prediction.of(contact.patch_mean(), wl.wear_law("brr")).wear_rate.m > 0.0
    with pytest.raises(CompositionError, match="both predict 'wear_rate'"):
        wl.Prediction.of(contact, usfd, wl.wear_law("kth"))
    with pytest.raises(CompositionError, match="the rig has no body 'disc_1'"):
        wl.Prediction.of(contact, wl.wear_law("usfd", body="disc_1"))
    found = wl.Prediction.of(contact, wl.wear_law("usfd", body="rail"), wl.wear_law("kth", body="wheel"))
    assert found.wear_rate_of("wheel") != found.wear_rate_of("rail")
    with pytest.raises(CompositionError, match="strips: the contact is already solved"):
        found.wear_profile("rail", strips=20)


def test_a_law_fitted_for_other_contacts_is_warned_of_where_it_is_used() -> None:
    contact = wl.read_contact(FILES["tread"])
    with pytest.warns(wl.CalibrationWarning, match="used with patches of strips") as caught:
        wl.Prediction.of(contact, wl.wear_law("usfd"))
    assert {one.filename for one in caught if one.category is wl.CalibrationWarning} == {__file__}
