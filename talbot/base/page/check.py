"""Faults of a page: requests, pictures without a text, tables that a narrow screen cuts."""

import re
from html.parser import HTMLParser

# Attributes that make a browser fetch; a link that is followed by a click is none
FETCHED = {"link": ("href",), "image": ("href", "xlink:href"), "use": ("href", "xlink:href"), "object": ("data",)}
ANY = ("src", "srcset", "poster", "background")
LOCAL = re.compile(r"data:|#|[\w.-]+(?:/[\w.-]+)*$")  # in the page, or a file beside it
STYLE = re.compile(r"""@import[^;]*|url\(\s*['"]?(?!data:|#)[^)]*\)""")
VOID = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}


def faults(html: str) -> list[str]:
    """Return the faults of a page, an entry each; [] without any."""
    page = _Page()
    page.feed(html)
    page.close()
    return page.faults


class _Page(HTMLParser):
    """The elements that are open, each with whether it scrolls, and faults so far."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[tuple[str, bool]] = []
        self.faults: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Check an element, and remember it until its end."""
        have = {name: value or "" for name, value in attrs}
        for name in (*ANY, *FETCHED.get(tag, ())):
            if name in have and not LOCAL.match(have[name]):
                self.faults.append(f"{tag} fetches {have[name][:80]}")
        self._style(have.get("style", ""))
        if tag == "img" and not have.get("alt", "").strip():
            self.faults.append(f"img {have.get('src', '')[:40]}: no alt")
        shown = have.get("role") == "img" and have.get("aria-label", "").strip()
        if tag == "svg" and not shown and not any(name == "svg" for name, _ in self.open):
            self.faults.append("svg: no role=img with aria-label")
        if tag == "table" and not any(scrolls for _, scrolls in self.open):
            self.faults.append("table: not in a box that scrolls")
        scrolls = "wide" in have.get("class", "").split()
        if scrolls and not (have.get("tabindex") == "0" and have.get("aria-label", "").strip()):
            self.faults.append("box that scrolls: no tabindex and aria-label")
        if tag not in VOID:
            self.open.append((tag, scrolls))

    def handle_endtag(self, tag: str) -> None:
        """Forget the element, and those in it that have no end."""
        for place in range(len(self.open) - 1, -1, -1):
            if self.open[place][0] == tag:
                del self.open[place:]
                break

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Check an element that is closed at once."""
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.handle_endtag(tag)

    def handle_data(self, data: str) -> None:
        """Check a style sheet, and scripts for a fetch."""
        if self.open and self.open[-1][0] == "style":
            self._style(data)
        if self.open and self.open[-1][0] == "script":
            self.faults += [f"script: {found}" for found in re.findall(r"\bfetch\(|XMLHttpRequest|https?://\S*", data)]

    def _style(self, text: str) -> None:
        self.faults += [f"style: {found[:80]}" for found in STYLE.findall(text)]
