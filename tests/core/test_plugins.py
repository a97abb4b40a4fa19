"""Discovery and look-up, with distributions that are real folders on `sys.path`."""

from __future__ import annotations

import pickle
import sys
import textwrap
import warnings
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier
from time import sleep
from typing import Any

import pytest
from click.testing import CliRunner

import wearlaw as wl
from tests.core.distributions import FIRST_PARTY_LAWS, FIRST_PARTY_MODELS, LAW, Install, write_distribution
from wearlaw import loader  # private: plugins of a test are found as if they were installed
from wearlaw.cli import main  # private: the program in this process
from wearlaw.errors import PluginWarning, UnknownModelError
from wearlaw.fields import specification  # private: what case files hold
from wearlaw_apps.output.commands import law_of  # private: laws on the command line

COMMAND = """
    import click
    import wearlaw as wl

    @click.command()
    def command():
        click.echo("{word}")

    @wl.hookimpl
    def wearlaw_commands():
        return [wl.Command("{name}", __name__ + ":command", "A command of a test.")]
"""

BROKEN = {
    "import_that_fails": ("import a_module_that_is_not_there", "ModuleNotFoundError: No module named"),
    "syntax_error": ("def", "SyntaxError"),
    "exit_on_import": ("raise SystemExit(0)", "SystemExit: 0"),
    "misspelt_hook": (
        "import wearlaw\n@wearlaw.hookimpl\ndef wearlaw_model():\n    return []",
        "unknown hook 'wearlaw_model'",
    ),
    "hook_without_marker": (
        "def wearlaw_models():\n    return []",
        "TypeError: it implements no hook; mark its functions with @wearlaw.hookimpl",
    ),
    "hook_that_raises": (
        "import wearlaw\n@wearlaw.hookimpl\ndef wearlaw_models():\n    raise KeyError('lost')",
        "KeyError: 'lost'",
    ),
    **{
        f"{hook}_that_returns_nothing": (
            f"import wearlaw\n@wearlaw.hookimpl\ndef {hook}():\n    pass",
            f"TypeError: {hook}: returned None; is its `return` missing?",
        )
        for hook in ("wearlaw_models", "wearlaw_named", "wearlaw_resources", "wearlaw_commands")
    },
    "instance_in_place_of_a_class": (
        "import wearlaw\n@wearlaw.hookimpl\ndef wearlaw_models():\n    return ['exact']",
        "TypeError: wearlaw_models: 'exact' is no rig, contact model, stage, wear law, law, reader",
    ),
    "built_for_a_newer_interface": (
        "wearlaw_interface = 99",
        "TypeError: it is built for version 99 of the plugin interface, but this wearlaw has version 4;"
        " upgrade the older of the two",
    ),
    "abstract_model": (
        "import wearlaw\n@wearlaw.hookimpl\ndef wearlaw_models():\n    class Half(wearlaw.WearLaw):\n"
        "        name = 'half'\n    return [Half]",
        "TypeError: Half does not implement rate",
    ),
    "model_without_name": (
        textwrap.dedent(LAW).format(name="outside").replace('name = "outside"', "pass"),
        "TypeError: the name of a wear law must be an identifier, got None",
    ),
}


def test_the_first_party_plugins_are_found_by_name_in_order() -> None:
    assert list(wl.installed("contact model")) == sorted(FIRST_PARTY_MODELS)
    assert list(wl.installed("wear law")) == sorted(FIRST_PARTY_LAWS)
    assert {origin.distribution for origin in loader.discovered().plugins} == {"wearlaw"}
    assert not loader.discovered().broken


def test_an_outside_law_is_found_beside_the_others(install: Install) -> None:
    install("outside_plugin", LAW.format(name="outside"), version="3.2")
    assert wl.wear_law("outside").name == "outside"
    assert set(wl.installed("wear law")) == FIRST_PARTY_LAWS | {"outside"}
    assert str(loader.discovered()["wear law"].origin("outside")) == "outside_plugin 3.2 (plugin 'outside_plugin')"


def test_a_command_of_a_plugin_is_imported_when_it_is_called_and_named_if_that_fails(install: Install) -> None:
    install(
        "own",
        """
        import click
        import wearlaw as wl

        @click.command()
        def greet():
            click.echo("hello")

        @wl.hookimpl
        def wearlaw_commands():
            return [wl.Command("greet", "own:greet", "Greet."), wl.Command("gone", "no_such_module:gone", "Fail.")]
    """,
    )
    listed = CliRunner().invoke(main, ["--help"])
    assert "greet" in listed.output
    assert "gone" in listed.output
    assert CliRunner().invoke(main, ["greet"]).output == "hello\n"
    failed = CliRunner().invoke(main, ["gone"])
    assert failed.exit_code == 1
    assert "command 'gone' of own 1.0 (plugin 'own') cannot be loaded: ModuleNotFoundError" in failed.output


@pytest.mark.parametrize("case", BROKEN)
def test_a_broken_plugin_is_warned_of_and_left_out_while_the_others_work(case: str, install: Install) -> None:
    source, cause = BROKEN[case]
    install(f"broken_{case}", source)
    install("working_plugin", LAW.format(name="working"))
    with pytest.warns(PluginWarning) as caught:
        laws = wl.installed("wear law")
    assert len(caught) == 1
    assert str(caught[0].message).startswith(f"left out: broken_{case} 1.0 (plugin 'broken_{case}'): ")
    assert cause in str(caught[0].message)
    assert caught[0].filename == __file__
    assert set(laws) == FIRST_PARTY_LAWS | {"working"}
    assert set(wl.installed("contact model")) == FIRST_PARTY_MODELS
    with pytest.raises(UnknownModelError) as error:
        wl.wear_law("half")
    assert f"left out: broken_{case} 1.0" in str(error.value)
    assert cause in str(error.value)


def test_a_broken_plugin_is_warned_of_once_and_then_left_alone(install: Install) -> None:
    install("broken_plugin", "raise RuntimeError")
    with pytest.warns(PluginWarning):
        wl.installed("wear law")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        wl.installed("wear law")
        wl.contact_model("exact")


def test_ctrl_c_while_a_plugin_is_loading_ends_the_program(install: Install) -> None:
    install("slow_plugin", "raise KeyboardInterrupt")
    with pytest.raises(KeyboardInterrupt):
        wl.installed("wear law")


def test_what_a_plugin_gave_before_it_broke_stays(install: Install) -> None:
    install("half_broken", LAW.format(name="outside").replace("return [Outside]", "return [Outside, int]"))
    with pytest.warns(PluginWarning, match="'int'"):
        assert wl.wear_law("outside").name == "outside"


def test_one_name_of_two_distributions_is_an_error_that_names_both(install: Install) -> None:
    install("one_plugin", LAW.format(name="twin"), version="1.5")
    install("other_plugin", LAW.format(name="twin"), version="2.5")
    with pytest.raises(UnknownModelError) as error:
        wl.wear_law("twin")
    assert str(error.value) == (
        "wear law 'twin' is provided more than once, by one_plugin 1.5 (plugin 'one_plugin')"
        " and other_plugin 2.5 (plugin 'other_plugin'); write 'one_plugin:twin' or 'other_plugin:twin'"
    )
    assert type(wl.wear_law("One-Plugin:twin")).__module__ == "one_plugin"
    other = wl.wear_law("other_plugin:twin")
    assert type(other).__module__ == "other_plugin"
    assert specification(other) == {"model": "other_plugin:twin"}
    assert "twin" not in wl.installed("wear law")
    assert wl.wear_law("usfd").name == "usfd"


def test_a_name_that_wearlaw_ships_means_the_shipped_thing_with_one_warning(install: Install) -> None:
    install("usurper", LAW.format(name="kth"))
    with pytest.warns(PluginWarning, match=r"'kth' is that of wearlaw; the other, of usurper 1.0 .* 'usurper:kth'"):
        shipped = wl.wear_law("kth")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert wl.wear_law("kth") == shipped
        assert type(shipped).__module__ == type(wl.wear_law("wearlaw:kth")).__module__ == "wearlaw_models.laws.kth"
        other = wl.wear_law("usurper:kth")
        assert type(other).__module__ == "usurper"
    for law in (shipped, other):  # the table in a file makes an equal law
        table = specification(law)
        assert wl.law(table.pop("model"), **table) == law
    assert type(law_of("usurper:kth")) is type(other)
    assert law_of("wearlaw:kth:body=rail") == law_of("kth:body=rail")
    assert wl.installed("wear law")["kth"] is type(shipped)
    shown = CliRunner().invoke(main, ["show", "usurper:kth"])
    assert "kth: a wear law of usurper 1.0 (plugin 'usurper')" in shown.output
    with pytest.raises(UnknownModelError, match="no wear law is called 'nobody:kth'"):
        wl.wear_law("nobody:kth")


def test_a_command_that_wearlaw_ships_means_the_shipped_one(install: Install) -> None:
    install("usurper", COMMAND.format(name="run", word="mine"))
    with pytest.warns(PluginWarning, match="command 'run' is that of wearlaw"):
        assert "Run a study" in CliRunner().invoke(main, ["run", "--help"]).output
    assert CliRunner().invoke(main, ["usurper:run"]).output == "mine\n"


def test_a_command_of_two_distributions_is_an_error_that_names_both(install: Install) -> None:
    for name in ("one_plugin", "other_plugin"):
        install(name, COMMAND.format(name="greet", word=name))
    refused = CliRunner().invoke(main, ["greet"])
    assert refused.exit_code == 1
    assert "command 'greet' is provided more than once" in refused.output
    assert CliRunner().invoke(main, ["other_plugin:greet"]).output == "other_plugin\n"


def test_a_distribution_can_be_left_out(install: Install, monkeypatch: pytest.MonkeyPatch) -> None:
    install("one_plugin", LAW.format(name="outside"))
    install("broken_plugin", "raise RuntimeError")
    monkeypatch.setenv("WEARLAW_PLUGINS", "-One.Plugin, -broken-plugin")
    assert set(wl.installed("wear law")) == FIRST_PARTY_LAWS
    assert {origin.distribution for origin in loader.discovered().plugins} == {"wearlaw"}


@pytest.mark.parametrize(("stated", "works"), [("4", True), ("(3, 4)", True), ("range(4, 7)", True), ("(5, 6)", False)])
def test_a_plugin_states_the_interfaces_that_it_works_with(install: Install, stated: str, works: bool) -> None:
    install("one_plugin", f"wearlaw_interface = {stated}\n" + textwrap.dedent(LAW.format(name="outside")))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PluginWarning)
        assert ("outside" in wl.installed("wear law")) is works


@pytest.mark.usefixtures("install")
def test_a_file_is_a_plugin_for_one_process(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [*sys.path])
    file = tmp_path / "a_local_law.py"
    file.write_text(textwrap.dedent(LAW.format(name="local")))
    wl.use(file)
    wl.use(str(file))  # a second time changes nothing
    law = wl.wear_law("local")
    assert str(loader.discovered()["wear law"].origin("local")).startswith("a_local_law.py ")
    assert type(wl.wear_law("a_local_law.py:local")) is type(law)
    assert pickle.loads(pickle.dumps(law)) == law
    (tmp_path / "no_plugin.py").write_text("x = 1")
    for wrong, message in (("no_plugin.py", "it implements no hook"), ("gone.py", "No such file")):
        with pytest.raises(wl.InputError, match=f"plugin '.*{wrong}': cannot be used: .*{message}"):
            wl.use(tmp_path / wrong)
    (tmp_path / "textwrap.py").write_text("")
    with pytest.raises(wl.InputError, match="there is another module called 'textwrap'; rename the file"):
        wl.use(tmp_path / "textwrap.py")


@pytest.mark.usefixtures("install")
@pytest.mark.parametrize("before", [True, False])
def test_a_command_uses_a_file_as_a_plugin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, before: bool) -> None:
    monkeypatch.setattr(sys, "path", [*sys.path])
    file = tmp_path / f"a_command_{before}.py"
    file.write_text(textwrap.dedent(LAW.format(name="commanded")))
    option = ["--plugin", str(file)]
    shown = CliRunner().invoke(main, [*option, "show", "commanded"] if before else ["show", "commanded", *option])
    assert "commanded: a wear law of a_command_" in shown.output
    missing = CliRunner().invoke(main, ["show", "usfd", "--plugin"])
    assert missing.exit_code == 2
    assert "--plugin needs a file" in missing.output


def test_a_plugin_may_implement_a_hook_of_a_later_wearlaw_and_provide_nothing(install: Install) -> None:
    hooks = """
    @wl.hookimpl(optionalhook=True)
    def wearlaw_of_tomorrow():
        return []

    @wl.hookimpl(specname="wearlaw_named")
    def _materials():
        return {"outside_steel": wl.steel()}

    @wl.hookimpl
    def wearlaw_resources():
        return {}
    """
    install("outside_plugin", LAW.format(name="outside") + hooks)
    assert "outside" in wl.installed("wear law")
    assert "outside_steel" in wl.installed("material")


def test_of_two_copies_of_a_distribution_the_first_on_the_path_counts(
    install: Install, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install("doubled_plugin", LAW.format(name="doubled"), version="2.0")
    write_distribution(tmp_path / "later", "doubled_plugin", LAW.format(name="doubled"), version="1.0")
    monkeypatch.setattr(sys, "path", [*sys.path, str(tmp_path / "later")])
    assert str(loader.discovered()["wear law"].origin("doubled")).startswith("doubled_plugin 2.0 ")
    assert wl.wear_law("doubled").name == "doubled"


def test_an_unknown_contact_model_gets_a_suggestion_and_the_list() -> None:
    with pytest.raises(UnknownModelError, match=r"did you mean 'exact'\? Installed: exact, fastsim, global,"):
        wl.contact_model("exakt")
    with pytest.raises(UnknownModelError, match="no wear law is called 'wlrm'"):  # which predicts fatigue
        wl.wear_law("wlrm")


def test_threads_that_need_plugins_at_once_all_find_them(install: Install, monkeypatch: pytest.MonkeyPatch) -> None:
    install("slow", "")
    found, together = loader._entry_points, Barrier(4)

    def slowly() -> Iterable[Any]:
        sleep(0.1)
        return found()

    def look_up(_: int) -> str:
        together.wait()
        return wl.contact_model("exact").name

    monkeypatch.setattr(loader, "_entry_points", slowly)
    with ThreadPoolExecutor(4) as pool, pytest.warns(PluginWarning, match="slow"):
        assert list(pool.map(look_up, range(4))) == ["exact"] * 4
