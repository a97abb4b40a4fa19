"""The page of `wearlaw explore`: the data of its figures, and the page in a browser, by keyboard and on a phone.

The browser needs chromium and chromedriver, as for the report.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import panel as pn
import pytest
from selenium import webdriver
from selenium.webdriver import Keys
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

import wearlaw as wl
from tests.plugins.studies.test_report_browser import BROWSER, DRIVER, FLAGS, PATIENCE_S
from wearlaw_explore._answer import Answer, together  # private: the page without a browser
from wearlaw_explore._command import named  # private: as above
from wearlaw_explore._figures import nodes  # private: as above

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning")  # the page has them as notes

needs_browser = pytest.mark.skipif(BROWSER is None or DRIVER is None, reason="needs chromium and chromedriver on PATH")

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
    command = [sys.executable, "-c", "from wearlaw.cli import main; main()", "explore", "wheel_rail", "--no-browser"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"}
    ) as it:
        assert it.stdout is not None
        line = it.stdout.readline()
        assert "http://localhost:" in line, line
        yield line.split("at ")[1].split(";")[0]
        it.kill()


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    assert BROWSER is not None
    home = tmp_path_factory.mktemp("browser")
    options = webdriver.ChromeOptions()
    options.binary_location = BROWSER
    # Any other host than this one fails to resolve, as without a network.
    for flag in (
        *FLAGS,
        f"--user-data-dir={home / 'profile'}",
        "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE localhost",
    ):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    places = dict.fromkeys(("HOME", "TMPDIR", "XDG_CONFIG_HOME", "XDG_CACHE_HOME"), str(home))
    driver = webdriver.Chrome(options, Service(DRIVER, env={**os.environ, **places}))
    yield driver
    driver.quit()


def deep(page: webdriver.Chrome, selector: str) -> list[Any]:
    return list(page.execute_script(DEEP, selector))


def text(page: webdriver.Chrome) -> str:
    script = DEEP.replace("return found", "return found.map(e => e.textContent).join(' ')")
    return str(page.execute_script(script, "pre, table, p"))


def wait(page: webdriver.Chrome, until: Any) -> None:
    WebDriverWait(page, PATIENCE_S, poll_frequency=0.05).until(lambda _: until())


def answer(model: str, *laws: str, rig: str = "wheel_rail", **conditions: Any) -> Answer:
    subject = named(rig)
    given = together(subject.rig.example, conditions)
    return Answer(subject, f'wl.contact_model("{model}")', [f'wl.wear_law("{law}")' for law in laws], given)


@pytest.mark.parametrize("model", ["fastsim", "strip_theory"])
def test_cells_tile_the_patch_and_carry_its_wear(model: str) -> None:
    prediction = answer(model, "usfd").predictions['wl.wear_law("usfd")']
    cells = nodes(prediction)
    areas = (cells["right"] - cells["left"]) * (cells["top"] - cells["bottom"])
    area = prediction.patch_area.to("mm^2").magnitude
    np.testing.assert_allclose(areas.sum(), area, rtol=1e-9)
    np.testing.assert_allclose((areas * cells["wear"]).sum(), prediction.wear_rate.magnitude * area, rtol=1e-9)
    a, b = prediction.problem.a * 1e3, prediction.problem.b * 1e3
    assert np.abs(cells["left"]).max() <= a
    np.testing.assert_allclose(cells["top"].max(), b, rtol=0.01)  # strips are a quadrature of it


def test_an_ellipse_answers_within_a_fifth_of_a_second() -> None:
    subject = named("wheel_rail")
    slider = subject.slider("longitudinal_creepage", subject.rig.example)
    assert slider is not None

    def seconds() -> float:
        started = perf_counter()
        one = answer("fastsim", "usfd", "kth")
        assert len(one.curve(slider)) == 2
        nodes(one.predictions['wl.wear_law("usfd")'])
        return perf_counter() - started

    assert min(seconds() for _ in range(3)) < 0.2


def test_a_slow_contact_has_no_curve_on_a_wheelset_either() -> None:
    one = answer("fastsim", "usfd", rig="wheelset")
    slider = one.subject.slider("lateral_displacement", one.conditions)
    assert slider is not None
    one.seconds = 0.1
    assert len(one.curve(slider)) == 1
    one.seconds = 8.0  # as elements on half-spaces take, and as many times for a curve as it has points
    assert one.curve(slider) == {}


def test_the_python_on_the_page_gives_its_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    one = answer("global", "brr", rig="twin_disc", creepage="2 %")
    exec(one.subject.python(one.model, one.laws, one.conditions), {})
    assert capsys.readouterr().out.strip() == repr(one.predictions['wl.wear_law("brr")'])


def test_a_law_in_a_file_stands_first_and_its_python_reads_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("law.toml").write_text('[wear_law]\nmodel = "usfd"\nq_s = "22 ug/m/mm^2"\n', encoding="utf-8")
    subject = named("twin_disc", ["law.toml"])
    code = 'wl.read_law("law.toml")'
    assert next(iter(subject.laws)) == code
    one = Answer(subject, 'wl.contact_model("global")', [code], together(subject.rig.example, {"creepage": "3 %"}))
    assert one.predictions[code].wear_rate.m_as("ug/m/mm^2") == pytest.approx(22.0)  # the severe plateau
    exec(subject.python(one.model, one.laws, one.conditions), {})
    assert capsys.readouterr().out.strip() == repr(one.predictions[code])


def test_errors_are_notes_and_a_load_replaces_the_other() -> None:
    wrong = answer("global", "brr", rig="twin_disc", normal_force="7 m")
    assert not wrong.predictions
    assert "normal_force" in wrong.notes.texts[0]
    assert "max_pressure" not in wrong.conditions


def opened(browser: webdriver.Chrome, address: str, width: int) -> webdriver.Chrome:
    size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 640}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    browser.get(address)
    wait(browser, lambda: "wear rate, usfd" in text(browser) and deep(browser, "canvas"))
    return browser


def test_a_notebook_gets_a_page_that_renders() -> None:
    rig = wl.rig("twin_disc", **wl.rigs()["twin_disc"].example_fields)
    page = wl.explore(rig | wl.contact_model("exact") | wl.wear_law("usfd"), creepage=wl.Q(3, "%"))
    with pn.config.set(console_output="disable"):  # which needs IPython
        bundle, _ = page._repr_mimebundle_()
    assert "<script" in bundle["text/html"]
    assert "creepage=&#x27;3 %&#x27;" in str([pane.object for pane in page.select(pn.pane.HTML)])


@needs_browser
def test_arrow_keys_move_a_slider_and_the_numbers_follow(browser: webdriver.Chrome, address: str) -> None:
    page = opened(browser, address, 1300)
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
def test_nothing_is_wider_than_a_phone(browser: webdriver.Chrome, address: str) -> None:
    page = opened(browser, address, 390)
    assert page.execute_script("return document.documentElement.scrollWidth") <= 390
    wide = [one.rect for one in deep(page, "canvas, .noUi-target, select, pre, table")]
    assert wide
    assert all(one["x"] >= 0 and one["x"] + one["width"] <= 390 for one in wide)
