"""The help of every command, as a stranger reads it."""

import re
from argparse import _SubParsersAction

import pytest

from talbot.base.paths import ROOT
from talbot.commands import parser
from talbot.front import COMMANDS, GROUPS, WIDTH


def help_of(name, monkeypatch):
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("COLUMNS", "100000")
    (commands,) = (action for action in parser(name)._actions if isinstance(action, _SubParsersAction))
    return commands.choices[name].format_help()


def test_every_command_has_a_line_in_its_group():
    text = parser().format_help().partition("\noptions:")[0]
    shown = dict(re.findall(r"(?m)^  ([a-z-]+) +(.*)$", text))
    assert shown == {name: command.summary for name, command in COMMANDS.items()}
    assert re.findall(r"(?m)^(\w.*):$", text) == [*GROUPS] and max(map(len, text.splitlines())) <= WIDTH


@pytest.mark.parametrize("name", COMMANDS)
def test_a_default_is_named_once_in_words_and_from_here(name, monkeypatch):
    text = help_of(name, monkeypatch)
    for line in text.splitlines():
        assert line.count("default:") <= 1, line
    assert str(ROOT) not in text and "(default: (" not in text and "(default: [" not in text


@pytest.mark.parametrize("name", COMMANDS)
def test_a_number_is_refused_with_its_range(name):
    """Argparse's own types name none: `base.arguments` reads the text, and a check of the value names it."""
    (commands,) = (action for action in parser(name)._actions if isinstance(action, _SubParsersAction))
    assert not [action.dest for action in commands.choices[name]._actions if action.type in (int, float)]


def test_what_a_default_looks_like(monkeypatch):
    assert "(default: build/verify)" in help_of("verify", monkeypatch)
    assert "(default: motorcycle)" in help_of("sim", monkeypatch)
