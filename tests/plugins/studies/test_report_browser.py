"""The report in a browser, without a window and without a network.

Needs chromium and chromedriver, which Debian and Ubuntu have as the packages chromium and chromium-driver.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium import webdriver
from selenium.webdriver import ActionChains, Keys
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

from tests.plugins.studies.report_data import EVIL, ODD, ONE, THREE, page_of, small_study

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
DRIVER = shutil.which("chromedriver")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--force-color-profile=srgb",
    "--window-size=1200,900",
)
PATIENCE_S = 20.0

pytestmark = pytest.mark.skipif(
    BROWSER is None or DRIVER is None,
    reason="needs a browser: chromium and chromedriver on PATH (apt-get install chromium chromium-driver)",
)


def started(home: Path, *flags: str) -> webdriver.Chrome:
    """Start a browser that keeps all its files in a folder."""
    assert BROWSER is not None
    options = webdriver.ChromeOptions()
    options.binary_location = BROWSER
    for flag in (*FLAGS, *flags, f"--user-data-dir={home / 'profile'}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    places = dict.fromkeys(("HOME", "TMPDIR", "XDG_CONFIG_HOME", "XDG_CACHE_HOME"), str(home))
    return webdriver.Chrome(options, Service(DRIVER, env={**os.environ, **places}))


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    driver = started(tmp_path_factory.mktemp("browser"))
    yield driver
    driver.quit()


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(page_of(small_study(title=EVIL)), encoding="utf-8")
    return path


def open_page(browser: webdriver.Chrome, file: Path) -> None:
    scheme(browser, "light")
    browser.get_log("browser")  # type: ignore[no-untyped-call]  # empties it
    browser.get(file.as_uri())
    left = "return [...document.querySelectorAll('.plot')].filter(e => !e.querySelector('.main-svg')).length"
    wait(browser, lambda: browser.execute_script(left) == 0)


@pytest.fixture(scope="module")
def opened(browser: webdriver.Chrome, file: Path) -> webdriver.Chrome:
    """Open the page once, since that takes longer than most tests."""
    open_page(browser, file)
    return browser


@pytest.fixture
def page(opened: webdriver.Chrome) -> webdriver.Chrome:
    """Give the page to a test that leaves it as it was, but for its colours."""
    scheme(opened, "light")
    return opened


@pytest.fixture
def page_to_change(page: webdriver.Chrome, file: Path) -> Iterator[webdriver.Chrome]:
    """Give the page to a test that changes it."""
    yield page
    open_page(page, file)


SIZES = {"desktop": (1300, 900), "phone": (390, 800)}
"""Screens on which the report must be readable [px]."""


@pytest.fixture(params=SIZES)
def screen(request: pytest.FixtureRequest, browser: webdriver.Chrome, file: Path) -> Iterator[tuple[int, int]]:
    """Open the page on a screen and give its size."""
    width, height = SIZES[request.param]
    size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": request.param == "phone"}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    open_page(browser, file)
    yield width, height
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    open_page(browser, file)


def scheme(browser: webdriver.Chrome, wanted: str) -> None:
    """Say which colours the reader prefers."""
    features = [{"name": "prefers-color-scheme", "value": wanted}]
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})


def plot(page: webdriver.Chrome, name: str) -> Any:
    """Return the element of a figure, in sight."""
    element = page.find_element("css selector", f"#figure-{name} .plot")
    page.execute_script("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'})", element)
    return element


def visible(page: webdriver.Chrome, element: Any, name: str) -> list[Any]:
    """Return whether each trace of a name is shown."""
    script = "return arguments[0]._fullData.filter(t => t.name === arguments[1]).map(t => t.visible)"
    return list(page.execute_script(script, element, name))


def legend_entry(element: Any, name: str) -> Any:
    (entry,) = (e for e in element.find_elements("css selector", ".legend .traces") if e.text == name)
    return entry


def wait(page: webdriver.Chrome, until: Any) -> None:
    WebDriverWait(page, PATIENCE_S, poll_frequency=0.05).until(lambda _: until())


def hover_text(page: webdriver.Chrome, element: Any, x: float, y: float) -> str:
    """Return what is shown when the mouse is over a point of the first panel, its lines without breaks."""
    where = """
        const {_fullLayout: {xaxis, yaxis}} = arguments[0], box = arguments[0].getBoundingClientRect();
        return [box.x + xaxis._offset + xaxis.d2p(arguments[1]), box.y + yaxis._offset + yaxis.d2p(arguments[2])];
    """
    across, down = page.execute_script(where, element, x, y)
    chain = ActionChains(page, duration=0)
    mouse: Any = chain.w3c_actions.pointer_action
    for step in (-3, 0):
        mouse.move_to_location(round(across) + step, round(down))
    chain.perform()
    wait(page, lambda: element.find_elements("css selector", ".hoverlayer .hovertext"))
    (shown,) = element.find_elements("css selector", ".hoverlayer .hovertext")
    return str(shown.text).replace("\N{NO-BREAK SPACE}", " ")


def test_the_page_opens_without_a_complaint_and_without_a_request(page: webdriver.Chrome) -> None:
    assert page.execute_script("return document.readyState") == "complete"
    assert page.get_log("browser") == []  # type: ignore[no-untyped-call]
    assert page.execute_script("return performance.getEntriesByType('resource')") == []


@pytest.mark.parametrize("figure", [ONE, THREE, ODD], ids=lambda figure: figure.name)
def test_every_curve_is_drawn(page: webdriver.Chrome, figure: Any) -> None:
    element = plot(page, figure.name)
    drawn = """
        const length = group => [...group.querySelectorAll("path")].reduce((sum, p) => sum + p.getTotalLength(), 0);
        return [...arguments[0].querySelectorAll(".scatterlayer .trace")].map(length);
    """
    lengths = page.execute_script(drawn, element)
    bands = sum(curve.low is not None and not curve.points for panel in figure.panels for curve in panel.curves)
    assert len(lengths) == sum(len(panel.curves) for panel in figure.panels) + bands
    # A band has no outline, but is filled, beneath the curves.
    assert sum(length > 0 for length in lengths) >= len(lengths) - bands
    assert len(element.find_elements("css selector", ".scatterlayer .js-fill")) == bands


@pytest.mark.parametrize(("figure", "name", "count"), [(ONE, "falling", 1), (THREE, "rising", 6)])
def test_a_click_in_the_legend_hides_a_curve_with_its_band_in_all_panels_and_shows_it_again(
    page: webdriver.Chrome, figure: Any, name: str, count: int
) -> None:
    element = plot(page, figure.name)
    others = page.execute_script("return arguments[0]._fullData.length", element) - count
    assert visible(page, element, name) == [True] * count
    for shown in ("legendonly", True):
        legend_entry(element, name).find_element("css selector", ".legendtoggle").click()
        wait(page, lambda shown=shown: visible(page, element, name) == [shown] * count)
        states = page.execute_script("return arguments[0]._fullData.map(t => t.visible)", element)
        assert states.count(True) == others + (count if shown is True else 0)
    paths = ".scatterlayer .trace"
    assert len(element.find_elements("css selector", paths)) == others + count


def test_hovering_shows_the_value_with_its_unit(page: webdriver.Chrome) -> None:
    element = plot(page, ONE.name)
    assert hover_text(page, element, 10.0, 30.0) == "risingcreepage [%]: 10wear rate [µg/m/mm²]: 30from 20 to 40"


def luminance(colour: str) -> float:
    """Return the relative luminance of an rgb colour (WCAG 2, definition of relative luminance)."""
    parts = np.array([float(part) for part in colour.split("(")[1].rstrip(")").split(",")[:3]]) / 255.0
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def contrast(one: str, other: str) -> float:
    """Return the contrast of two colours, from 1 to 21 (WCAG 2, definition of contrast ratio)."""
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("wanted", ["light", "dark"])
def test_text_and_measured_points_can_be_read_in_both_colour_schemes(page: webdriver.Chrome, wanted: str) -> None:
    """Text needs a contrast of 4.5, and what is drawn 3 (WCAG 2, criteria 1.4.3 and 1.4.11)."""
    element = plot(page, ONE.name)
    scheme(page, wanted)
    paper = page.find_element("tag name", "body").value_of_css_property("background-color")
    assert (luminance(paper) < 0.5) == (wanted == "dark")

    def styles(within: Any, selector: str, of: str) -> list[str]:
        script = "return [...arguments[0].querySelectorAll(arguments[1])].map(e => getComputedStyle(e)[arguments[2]])"
        return list(page.execute_script(script, within, selector, of))

    def readable(selector: str) -> bool:
        found = styles(element, selector, "fill")
        return bool(found) and all(contrast(colour, paper) >= 4.5 for colour in found)

    wait(page, lambda: readable(".legendtext, .xtick text, .xtitle, .ytitle"))
    body = page.find_element("tag name", "body")
    for tag in ("h1", "h2", "td", "figcaption", "a", ".verdict", ".where"):
        assert all(contrast(colour, paper) >= 4.5 for colour in styles(body, tag, "color"))
    markers = "return arguments[0]._fullData.filter(t => t.name).map(t => [t.name, (t.marker || t.line).color])"
    for name, colour in page.execute_script(markers, element):
        rgb = f"rgb({', '.join(str(part) for part in bytes.fromhex(colour[1:7]))})"
        least = 4.5 if name == "tests" else 3.0 if wanted == "dark" else 2.2  # print has the published palette
        assert contrast(rgb, paper) >= least, name


def boxes(page: webdriver.Chrome, selector: str) -> list[tuple[str, float, float, float, float]]:
    """Return text, left, top, right and bottom of each visible element on the page, without contents of tables."""
    script = """
        return [...document.querySelectorAll(arguments[0])].filter(e => !e.closest(".wide") || e.matches(".wide"))
          .map(e => [e.textContent.trim().slice(0, 40), e.getBoundingClientRect()]).filter(([, box]) => box.width > 0)
          .map(([text, box]) => [text, box.left, box.top + scrollY, box.right, box.bottom + scrollY])
    """
    return [tuple(box) for box in page.execute_script(script, selector)]


def test_the_first_screen_holds_title_and_the_main_figure(browser: webdriver.Chrome, screen: tuple[int, int]) -> None:
    width, height = screen
    found = boxes(browser, "h1, .main h2, .main .plot, .main .legend")
    assert len(found) == 4
    for text, left, top, right, bottom in found:
        assert 0.0 <= left < right <= width, text
        assert 0.0 <= top < bottom <= height, text
    assert browser.execute_script("return document.querySelector('.main .cartesianlayer').getBBox().height") > 100.0


@pytest.mark.parametrize("wanted", ["light", "dark"])
def test_nothing_is_wider_than_the_screen(browser: webdriver.Chrome, screen: tuple[int, int], wanted: str) -> None:
    width, _ = screen
    scheme(browser, wanted)
    paper = browser.find_element("tag name", "body").value_of_css_property("background-color")
    assert (luminance(paper) < 0.5) == (wanted == "dark")
    assert browser.execute_script("return document.documentElement.scrollWidth") <= width
    everything = "h1, h2, h3, p, li, figcaption, summary, .wide, .plot, .legend, .xtitle, .ytitle, .annotation-text"
    cut = [box for box in boxes(browser, everything) if box[1] < 0.0 or box[3] > width]
    assert not cut
    scrolling = "return [...document.querySelectorAll('.wide')].map(e => getComputedStyle(e).overflowX)"
    assert set(browser.execute_script(scrolling)) == {"auto"}
    hidden = "return [...document.querySelectorAll('#main .wide, .stacked')].map(e => e.scrollWidth - e.clientWidth)"
    assert set(browser.execute_script(hidden)) == {0}, "the main table and claims do not scroll"


def test_panels_stand_below_each_other_on_a_phone_and_do_not_overlap(
    browser: webdriver.Chrome, screen: tuple[int, int]
) -> None:
    parts = "#figure-three .xy, #figure-three .x2y2, #figure-three .x3y3"
    script = "return [...document.querySelectorAll(arguments[0])].map(e => e.getBoundingClientRect())"
    every = ", ".join(f"{part} .nsewdrag" for part in parts.split(", "))
    wait(browser, lambda: len(browser.execute_script(script, every)) == 3)  # plotly may be drawing anew
    drags = browser.execute_script(script, every)
    across = {round(box["left"]) for box in drags}
    assert len(across) == (1 if screen[0] < 640 else 2)
    titles = browser.execute_script(script, "#figure-three .xtitle, #figure-three .x2title, #figure-three .x3title")
    if screen[0] < 640:
        for box, title, below in zip(drags, titles, [*drags[1:], None], strict=True):
            assert title["top"] > box["bottom"]
            assert below is None or title["bottom"] < below["top"]


@pytest.mark.parametrize("wanted", ["light", "dark"])
def test_a_checker_of_accessibility_finds_no_fault(page_to_change: webdriver.Chrome, wanted: str) -> None:
    """The rules of axe-core: contrast, names, roles, headings, landmarks, focus."""
    page = page_to_change
    scheme(page, wanted)
    package = find_spec("axe_playwright_python")  # for another driver, so that its file of rules alone is used
    assert package is not None
    assert package.origin is not None
    page.execute_script(Path(package.origin).with_name("axe.min.js").read_text(encoding="utf-8"))
    found = page.execute_async_script("axe.run().then(arguments[0])")
    faults = {fault["id"]: [node["html"][:200] for node in fault["nodes"]] for fault in found["violations"]}
    assert not faults
    assert "color-contrast" in {rule["id"] for rule in found["passes"]}


@pytest.mark.usefixtures("screen")
def test_all_controls_can_be_reached_with_the_tab_key_and_show_the_focus(browser: webdriver.Chrome) -> None:
    page = browser
    script = """
        const e = document.activeElement, style = getComputedStyle(e);
        return [e.tagName.toLowerCase(), style.outlineStyle, parseFloat(style.outlineWidth)];
    """
    reached: list[str] = []
    for _ in range(200):
        page.switch_to.active_element.send_keys(Keys.TAB)
        tag, outline, width = page.execute_script(script)
        if tag == "body":
            break
        reached.append(tag)
        assert outline != "none", tag
        assert width > 0.0, tag
    count = "return [...document.querySelectorAll(arguments[0])].filter(e => e.checkVisibility()).length"
    for tag, selector in (("a", "a"), ("summary", "summary"), ("div", ".wide"), ("g", ".legend .traces")):
        assert reached.count(tag) == page.execute_script(count, selector), tag


def test_a_print_has_a_bright_page_without_navigation(page_to_change: webdriver.Chrome) -> None:
    page = page_to_change
    scheme(page, "dark")
    record = """
        window.seen = [];
        window.addEventListener("beforeprint", () => {
          const background = getComputedStyle(document.body).backgroundColor;
          window.seen.push(background);
        });
    """
    page.execute_script(record)
    assert page.print_page()
    (background,) = page.execute_script("return window.seen")
    assert luminance(background) > 0.9
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    assert not page.find_element("tag name", "nav").is_displayed()
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
