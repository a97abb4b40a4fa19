"""The page of `wearlaw explore`: the data of its figures, and the page in a browser, by keyboard and on a phone.

The browser needs chromium and chromedriver, as for the report.
"""

from __future__ import annotations

import html
import http.client
import io
import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from time import process_time, sleep
from typing import Any, ClassVar

import matplotlib.pyplot as plt
import numpy as np
import panel as pn
import pytest
from selenium import webdriver
from selenium.webdriver import Keys
from selenium.webdriver.support.ui import WebDriverWait

import wearlaw as wl
from tests.plugins.studies.test_report_browser import BROWSER, DRIVER, PATIENCE_S, scheme, started
from wearlaw_apps.explore.page import Page, named, patch_figures  # private: the page without a browser
from wearlaw_apps.explore.subject import Subject  # private: a rig that is not installed
from wearlaw_apps.output.notes import Notes  # private: what the page shows as notes

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning")  # the page has them as notes

needs_browser = pytest.mark.skipif(BROWSER is None or DRIVER is None, reason="needs chromium and chromedriver on PATH")

EXPLORE = [sys.executable, "-c", "from wearlaw.cli import main; main()", "explore", "wheel_rail", "--no-browser"]

DEEP = """
    const found = [];
    const visit = root => root.querySelectorAll("*").forEach(e => {
        if (e.matches(arguments[0])) found.push(e);
        if (e.shadowRoot) visit(e.shadowRoot);
    });
    visit(document);
    return found;
"""
"""The elements of a selector, those within bokeh's shadow roots included."""


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with subprocess.Popen(
        EXPLORE, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"}
    ) as it:
        assert it.stdout is not None
        line = it.stdout.readline()
        assert "http://localhost:" in line, line
        yield line.split("at ")[1].split(";")[0]
        it.kill()


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    # Any other host than this one fails to resolve, as without a network.
    driver = started(tmp_path_factory.mktemp("browser"), "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE localhost")
    yield driver
    driver.quit()


def deep(page: webdriver.Chrome, selector: str) -> list[Any]:
    return list(page.execute_script(DEEP, selector))


def text(page: webdriver.Chrome) -> str:
    script = DEEP.replace("return found", "return found.map(e => e.textContent).join(' ')")
    return str(page.execute_script(script, "pre, table, p"))


def wait(page: webdriver.Chrome, until: Any) -> None:
    WebDriverWait(page, PATIENCE_S, poll_frequency=0.05).until(lambda _: until())


def drawn(page: Page) -> dict[str, Any]:
    return {name: pane.object for name, pane in page.panes.items() if pane in page.figures}


def predicted(model: str, *laws: str, rig: str = "wheel_rail", **given: Any) -> tuple[dict[str, wl.Prediction], Notes]:
    notes = Notes()
    subject = named(rig)
    return subject.predict(model, laws, subject.conditions(given), notes), notes


@pytest.mark.parametrize("model", ["fastsim", "strip_theory"])
def test_a_map_carries_the_wear_of_its_patch(model: str) -> None:
    found, _ = predicted(model, "usfd")
    prediction = found["usfd"]
    pressure, _, wear = (figure.panels[0].map for figure in patch_figures(found))
    assert getattr(pressure, "label", None) == "", "the title above it says the same"
    assert wear is not None
    inside = np.isfinite(wear.values)
    pixel = (wear.x[1] - wear.x[0]) * (wear.y[1] - wear.y[0])
    assert pixel * inside.sum() == pytest.approx(prediction.patch_area.m_as("mm^2"), rel=0.01)
    assert wear.values[inside].mean() == pytest.approx(prediction.wear_rate.magnitude, rel=0.03)
    assert pressure is not None
    assert np.nanmax(pressure.values) == pytest.approx(prediction.max_pressure.m_as("MPa"), rel=0.02)


def test_an_ellipse_answers_within_a_fifth_of_a_second() -> None:
    page = Page(named("wheel_rail"), {})
    page.laws.value = ["usfd", "kth"]

    def seconds(value: float) -> float:
        started = process_time()
        page.sliders["normal_force"].value = value  # everything but the browser
        return process_time() - started

    assert min(seconds(value) for value in (81.0, 82.0, 83.0)) < 0.2
    assert "normal_force='83 kN'" in page.python.object
    assert {trace["name"] for trace in drawn(page)["curve_0"]["data"]} == {"usfd", "kth", "now"}


def test_a_slow_contact_has_no_curve_and_waits_for_the_release_of_a_slider(monkeypatch: pytest.MonkeyPatch) -> None:
    subject = named("wheel_rail")
    predict = subject.predict

    def late(*arguments: Any) -> dict[str, wl.Prediction]:
        sleep(0.6)  # elements on half-spaces take longer
        return predict(*arguments)

    monkeypatch.setattr(subject, "predict", late)
    page = Page(subject, {})
    assert "curve_0" not in drawn(page)
    page.sliders["normal_force"].value = 81.0
    assert "normal_force='80 kN'" in page.python.object
    page._update()
    assert "normal_force='81 kN'" in page.python.object


def test_a_wheelset_shows_its_profiles_their_contacts_and_the_wear_along_them() -> None:
    page = Page(named("wheelset"), {})
    assert page.model.value == "strip_theory"
    assert [*page.patch.options] == ["left, patch 1", "right, patch 1"]
    *_, lines = drawn(page)["contact_state_1"]["data"]
    worn = drawn(page)["wear_state_1"]["data"][0]
    at = wl.rig("wheelset", **wl.installed("rig")["wheelset"].example_fields).profiles_in_track().wheel
    y = np.interp(1e-3 * worn["x"][np.nanargmax(np.array(worn["y"], float))], at[0], 1e3 * at[1])
    assert y == pytest.approx(lines["x"][0], abs=2.0)  # most wear where the right wheel touches


@pytest.mark.parametrize(
    ("model", "law", "rig", "given"),
    [("global", "brr", "twin_disc", {"creepage": "2 %"}), ("fastsim", "brr", "wheel_rail", {})],
)
def test_the_python_on_the_page_gives_its_numbers(
    model: str, law: str, rig: str, given: dict[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    found, _ = predicted(model, law, rig=rig, **given)
    subject = named(rig)
    exec(subject.python(model, [law], subject.conditions(given)), {})
    assert capsys.readouterr().out.strip() == repr(found[law])


def test_a_law_in_a_file_stands_first_and_its_python_reads_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("law.toml").write_text('[wear_law]\nmodel = "usfd"\nq_s = "22 ug/m/mm^2"\n', encoding="utf-8")
    subject = named("twin_disc", ["law.toml"])
    first, *_ = subject.laws
    conditions = subject.conditions({"creepage": "3 %"})
    found = subject.predict("global", [first], conditions, Notes())
    assert found[first].wear_rate.m_as("ug/m/mm^2") == pytest.approx(22.0)  # the severe plateau
    code = subject.python("global", [first], conditions)
    assert "wl.read_law('law.toml')" in code
    exec(code, {})
    assert capsys.readouterr().out.strip() == repr(found[first])


def test_a_case_brings_its_models_laws_and_stages() -> None:
    subject = named("tassini2010")
    assert {"exact", "global"} <= {*subject.models}
    assert "case = wl.load_case('tassini2010')" in subject.python("exact", ["usfd"], subject.conditions({}))


def test_a_rig_whose_creepage_no_condition_sets_has_no_curve() -> None:
    class Speeds(wl.TwinDisc):
        name: ClassVar[str] = "speeds"
        creepage: ClassVar[str | None] = None

    page = Page(Subject(Speeds(**dict(wl.TwinDisc.suros())), "rig"), {})
    assert "curve_0" not in drawn(page)
    assert "wear rate by usfd" in page.numbers.object


def test_errors_are_notes_and_a_load_replaces_the_other() -> None:
    found, notes = predicted("global", "brr", rig="twin_disc", normal_force="7 m")
    assert not found
    assert "normal_force" in notes.texts[0]
    assert "max_pressure" not in named("twin_disc").conditions({"normal_force": "7 m"})


@pytest.mark.parametrize(
    ("given", "error"), [({"normal_force": "7 m"}, wl.UnitError), ({"mu": 0.3}, wl.ConditionsError)]
)
def test_a_wrong_start_value_is_an_error_before_the_page_opens(given: dict[str, Any], error: type[Exception]) -> None:
    with pytest.raises(error, match=next(iter(given))):
        Page(named("twin_disc"), given)


def opened(browser: webdriver.Chrome, address: str, width: int) -> webdriver.Chrome:
    size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 640}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    browser.get(address)
    wait(browser, lambda: "wear rate by usfd" in text(browser) and deep(browser, ".main-svg"))
    return browser


def test_the_rig_has_sliders_too_and_the_python_has_its_values(capsys: pytest.CaptureFixture[str]) -> None:
    page = Page(named("wheel_rail"), {})
    before = page.numbers.object
    page.fields["wheel_radius"].value = 500.0
    assert page.numbers.object != before
    code = page.python.object.split("white-space: pre-wrap'>")[1].partition("</pre>")[0]
    assert "500.0 mm" in code
    exec(html.unescape(code), {})
    printed = capsys.readouterr().out
    rig = wl.rig("wheel_rail", **{**wl.installed("rig")["wheel_rail"].example_fields, "wheel_radius": "500 mm"})
    predicted_here = (rig | wl.contact_model("strip_theory") | wl.wear_law("usfd"))(**rig.example)
    assert printed.strip() == repr(predicted_here)


@pytest.mark.parametrize(("control", "value"), [("creepage", 250.0), ("disc_1.diameter", -5.0)])
def test_an_error_marks_its_control(control: str, value: float) -> None:
    page = Page(named("twin_disc"), {})
    every = {**page.sliders, **page.fields}
    assert not any(one.stylesheets for one in every.values())
    every[control].value = value
    assert [name for name, one in every.items() if one.stylesheets] == [control]
    assert control in page.notes.object


def test_numbers_and_pictures_say_which_patch_they_are_of() -> None:
    page = Page(named("wheelset"), {})
    assert "<th>left, patch 1</th>" in page.numbers.object
    titles = [pane.object["layout"]["annotations"][0]["text"] for pane in page.figures]
    assert titles[0] == "pressure p [MPa], left, patch 1"
    assert "wear over lateral displacement, the largest of the patches" in titles


def test_a_page_has_a_token_and_answers_to_this_computer_alone(address: str) -> None:
    port = int(address.split(":")[2].partition("/")[0])
    token = address.rpartition("/")[2]
    assert len(token) >= 20

    def status(path: str, **heads: str) -> int:
        with closing(http.client.HTTPConnection("localhost", port, timeout=20)) as connection:
            connection.request("GET", path, headers=heads)
            with connection.getresponse() as answer:
                return answer.status

    assert status(f"/{token}") == 200
    assert status("/") == status("/page") == 404
    assert status(f"/{token}", Host="example.org") == 403
    socket_of = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13"}
    assert status(f"/{token}/ws", Origin="http://example.org", **socket_of, **{"Sec-WebSocket-Key": "YQ=="}) == 403


def test_a_port_in_use_is_told() -> None:
    with socket.create_server(("localhost", 0)) as used:
        port = used.getsockname()[1]
        refused = subprocess.run([*EXPLORE, "--port", str(port)], capture_output=True, text=True, timeout=120)
    assert refused.returncode == 1
    assert refused.stdout == ""
    assert refused.stderr.splitlines()[-1].startswith(f"Error: --port: cannot use {port}: ")
    assert refused.stderr.endswith("; choose another, or leave --port out for a free one\n")
    assert "Traceback" not in refused.stderr


def test_a_notebook_gets_a_page_that_renders() -> None:
    rig = wl.rig("twin_disc", **wl.installed("rig")["twin_disc"].example_fields)
    page = wl.explore(rig | wl.contact_model("exact") | wl.wear_law("usfd"), creepage=wl.Q(3, "%"))
    with pn.config.set(console_output="disable"):  # which needs IPython
        bundle, _ = page._repr_mimebundle_()
    assert "<script" in bundle["text/html"]
    code = "".join(pane.object for pane in page.select(pn.pane.HTML))
    assert "creepage='3 %'" in code
    assert "wl.rig('twin_disc', disc_1={'diameter': '47.0 mm'" in html.unescape(code)
    assert "predict." not in code


@needs_browser
@pytest.mark.parametrize("width", [1300, 390])
def test_arrow_keys_move_a_slider_and_the_numbers_follow(browser: webdriver.Chrome, address: str, width: int) -> None:
    page = opened(browser, address, width)
    (first, *_) = deep(page, ".noUi-handle")
    before = text(page)
    assert "normal_force='80 kN'" in before
    page.execute_script("arguments[0].focus()", first)
    first.send_keys(Keys.ARROW_RIGHT)
    wait(page, lambda: "normal_force='80 kN'" not in text(page))
    assert text(page) != before
    assert "Traceback" not in text(page)
    hosts = page.execute_script("return performance.getEntriesByType('resource').map(e => new URL(e.name).hostname)")
    assert set(hosts) == {"localhost"}


@needs_browser
@pytest.mark.parametrize("width", [1300, 390])
@pytest.mark.parametrize("wanted", ["light", "dark"])
def test_the_page_is_dark_where_its_reader_prefers_that(
    browser: webdriver.Chrome, address: str, wanted: str, width: int
) -> None:
    scheme(browser, wanted)
    page = opened(browser, address, width)
    shot = plt.imread(io.BytesIO(page.get_screenshot_as_png()))[..., :3]
    assert (np.median(shot) < 0.2) == (wanted == "dark")
    scheme(browser, "light")


@needs_browser
def test_nothing_is_wider_than_a_phone(browser: webdriver.Chrome, address: str) -> None:
    page = opened(browser, address, 390)
    assert page.execute_script("return document.documentElement.scrollWidth") <= 390
    wide = [one.rect for one in deep(page, ".main-svg, .noUi-target, select, pre, table")]
    assert wide
    assert all(one["x"] >= 0 and one["x"] + one["width"] <= 390 for one in wide)
