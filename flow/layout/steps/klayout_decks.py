"""Decks run in the KLayout application, which alone interprets them; and what is in their reports."""

import collections
import os
import xml.etree.ElementTree as ET
from pathlib import Path

from base.tools import ToolError, finish


def run_deck(deck, environment, log, variables=None):
    """Run ``deck`` with ``environment`` and what it reads as ``variables`` (dicts), apart from the user's own settings;
    its words go to the file ``log``. Returns its exit status."""
    said = [word for name, value in (variables or {}).items() for word in ("-rd", f"{name}={value}")]
    done = finish(
        ["klayout", "-b", "-r", deck, *said],
        env={name: str(value) for name, value in environment.items()}
        | {"HOME": os.environ.get("HOME", "/tmp"), "KLAYOUT_HOME": str(Path(log).parent / ".klayout.log")},
    )
    Path(log).write_text(done.stdout + done.stderr)
    return done.returncode


def violations(report):
    """Violations by rule in a report database of KLayout: dict rule -> number. Raises ToolError if it is broken."""
    try:
        items = ET.parse(report).getroot().find("items")
    except (ET.ParseError, FileNotFoundError) as error:
        raise ToolError(f"klayout: left no whole report ({error})") from None
    return dict(collections.Counter(item.findtext("category").strip("'") for item in items))
