"""Running a case: what is noted, recorded and refused."""

from __future__ import annotations

import importlib.metadata
import json
import warnings

import pytest

import wearlaw as wl
from tests.core import cases
from tests.core.cases import InstallModel, case
from tests.plugins.studies.studies import lattice_study
from wearlaw import Array
from wearlaw_studies.case import Case
from wearlaw_studies.notes import grouped
from wearlaw_studies.study import evaluations, provenance, run

STRONG = {"preset": "suros", "material": dict(wl.steel(shear_yield_stress=None))}


def test_what_is_left_out_and_every_warning_is_noted_once() -> None:
    study = lattice_study()
    left_out = [note for note in study.notes if "is left out" in note]
    assert [note.split(":")[0] for note in left_out] == ["brr on exact is left out"]
    fitted = [note for note in study.notes if "were fitted for" in note]
    assert [note.split(":")[0] for note in fitted] == ["usfd on exact"]
    beyond = [note for note in study.notes if "is beyond the shakedown limit" in note]
    assert {note.split(":")[0] for note in beyond} == {"sweep 'creepage'", "sweep 'lattice'", "profile 'partial_slip'"}
    assert len(study.notes) == len(set(study.notes)) == 2 + len(beyond)


def test_a_warning_that_all_pairs_give_is_noted_once_for_each_sweep_or_profile() -> None:
    hard = {**cases.POINT, "max_pressure": "1700 MPa", "creepage": "3 %"}
    sweeps = {"a": hard, "b": hard, "c": {**hard, "max_pressure": "900 MPa"}}
    study = run(case(contact_models=["exact", "fastsim"], wear_laws=["kth"], sweeps=sweeps, profiles={"p": hard}))
    assert [note.split(":")[0] for note in study.notes] == ["sweep 'a'", "sweep 'b'", "profile 'p'"]
    assert all("shakedown limit, 1177 MPa" in note for note in study.notes)


def test_printed_notes_name_all_parts_of_a_case_that_share_a_remark_and_each_source_once() -> None:
    pressure, speed = (f"wear law 'usfd' has a known range of mean {name} from 1 to 2" for name in ("pressure", "slip"))
    source, other = " (Lewis (2004), Table 1)", " (Jendel (2002))"
    law = "wear law 'kth' has a known range of mean slip from 1 to 2"
    said = grouped([
        f"sweep 'a': {pressure}{source}; 1 of 3 points lies outside, as far as 4",
        f"sweep 'a': {speed}{source}; 2 of 3 points lie outside, as far as 5",
        f"profile 'p': {pressure}{source}; 1 of 1 points lies outside, as far as 6",
        "profile 'p': check it",
        "profile 'q': check it",
        "section 's': check it",
        f"profile 'p': {law}{other}; 1 of 1 points lies outside, as far as 7",
        "usfd on exact: was fitted for patch means",
    ])  # fmt: skip
    assert said == [
        "usfd on exact: was fitted for patch means",
        f"{pressure}{source}; sweep 'a': 1 of 3 points lies outside, as far as 4; profile 'p': 1 of 1 points lies"
        " outside, as far as 6",
        f"sweep 'a': {speed} (source above); 2 of 3 points lie outside, as far as 5",
        "profile 'p', profile 'q' and section 's': check it",
        f"profile 'p': {law}{other}; 1 of 1 points lies outside, as far as 7",
    ]


def test_the_range_of_a_law_is_printed_once_for_all_sweeps() -> None:
    soft = {**cases.POINT, "max_pressure": "300 MPa"}
    study = run(case(contact_models=["exact"], wear_laws=["usfd"], sweeps={"a": soft, "b": soft}, profiles={}))
    ranges = [note for note in grouped(study.notes) if "known range of mean pressure" in note]
    assert len(ranges) == 1
    assert ranges[0].startswith("wear law 'usfd' has a known range")
    assert "; sweep 'a': 1 of 1 operating points lies outside, as far as 235.6 MPa; sweep 'b': 1 of 1" in ranges[0]


class Warns(cases.Linear):
    name = "warns"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        warnings.warn("from elsewhere", DeprecationWarning, stacklevel=1)
        return super().rate(contact, p)


def test_warnings_of_others_are_passed_on_and_not_noted(install_model: InstallModel) -> None:
    install_model(Warns)
    with pytest.warns(DeprecationWarning, match="from elsewhere"):
        study = run(
            case(contact_models=["exact"], wear_laws=[{"model": "warns", "slope": "1 m"}], rig=STRONG, profiles={})
        )
    assert study.notes == ()


def test_a_profile_that_no_model_resolves_is_left_out_and_noted() -> None:
    study = run(case(contact_models=["global"], rig=STRONG))
    assert study.notes == ("profile 'partial_slip' is left out: no contact model of the case resolves the patch",)
    assert not study.profiles["partial_slip"]


def test_the_provenance_is_the_case_and_the_versions_of_all_that_was_used(install_model: InstallModel) -> None:
    install_model(cases.Linear)
    ran = case(contact_models=["global"], wear_laws=["kth", {"model": "linear", "slope": "1 m"}])
    study = run(ran)
    version = importlib.metadata.version("wearlaw")
    for dataset in (*study.sweeps.values(), *study.profiles.values()):
        assert dataset.attrs["title"] == "A small study"
        said = json.loads(dataset.attrs["provenance"])
        assert said["wearlaw"] == version
        assert said["contact_models"] == {"exact": f"wearlaw {version}", "global": f"wearlaw {version}"}
        assert said["wear_laws"] == {"kth": f"wearlaw {version}", "linear": "wearlaw-testing 9.8.7"}
        assert said["parameter_sets"] == said["materials"] == said["cases"] == {}
        assert Case(**said["case"]) == ran
    assert study.case == ran


def test_the_provenance_says_of_a_law_that_only_this_process_knows_that_it_is_not_installed(
    install_model: InstallModel,
) -> None:
    class Own(cases.Linear):
        name = "linear"

    laws = [Own(slope="1 m"), wl.wear_law("kth")]  # type: ignore[arg-type]
    ran = case(contact_models=["exact"], wear_laws=laws, profiles={})
    assert provenance(ran)["wear_laws"]["linear"] == "not installed"
    install_model(cases.Linear)  # another law of that name
    assert provenance(ran)["wear_laws"]["linear"] == "not installed"
    assert run(ran).sweeps["creepage"].sizes["pair"] == 2


@pytest.mark.parametrize("kind", ["sweep", "profile"])
def test_measured_traction_that_no_model_can_use_is_refused(kind: str) -> None:
    wrong = {f"{kind}s": {"x": {**cases.POINT, "traction_coefficient": 0.2}}}
    with pytest.raises(wl.InputError, match=f"^{kind} 'x': no contact model of the case can use a traction_coeff"):
        run(case(contact_models=["exact"], **wrong))


def test_a_case_of_which_no_pair_can_be_is_refused_and_says_why() -> None:
    impossible = case(contact_models=["exact"], wear_laws=["brr"])
    for what in (run, evaluations):
        with pytest.raises(wl.InputError, match="no contact model can be used with any of the wear laws") as no:
            what(impossible)
        assert "brr on exact is left out" in str(no.value)
