"""A page taken apart, for tests of what stands in it."""

import base64
import re
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

QUICK = Path(__file__).resolve().parents[1] / "quick_case.toml"
EMPTY = {"meta", "img"}


class Page(HTMLParser):
    """A page taken apart: tags, attributes, and what is read."""

    def __init__(self, html):
        super().__init__()
        self.html, self.tags, self.attributes, self.texts, self.open = html, [], [], [], []
        self.styles = []
        self.feed(html)
        self.close()
        assert not self.open, "a tag is not closed"

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.attributes += [(tag, name, value or "") for name, value in attributes]
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        (self.styles if self.open and self.open[-1] == "style" else self.texts).append(data)

    @property
    def text(self):
        return " ".join(" ".join(self.texts).split())

    def values(self, name):
        return [value for _, own, value in self.attributes if own == name]

    @property
    def pictures(self):
        """The SVG of each picture, parsed."""
        head = "data:image/svg+xml;base64,"
        assert all(value.startswith(head) for value in self.values("src"))
        return [
            ElementTree.fromstring(base64.b64decode(value.removeprefix(head)))
            for value in self.values("src")
        ]


def assert_harmless(page):
    """No script, nothing that is fetched, no tag or attribute that is not the template's."""
    known = {
        "html", "head", "meta", "title", "style", "body", "header", "h1", "p", "time", "nav", "ol",
        "li", "a", "main", "section", "h2", "div", "table", "caption", "thead", "tbody", "tr", "th",
        "td", "span", "ul", "figure", "img", "figcaption",
    }  # fmt: skip
    assert set(page.tags) <= known
    own = {"lang", "charset", "name", "http-equiv", "content", "id", "class", "href", "scope",
           "src", "width", "height", "alt"}  # fmt: skip
    assert {name for _, name, _ in page.attributes} <= own
    assert all(re.fullmatch(r"#s\d+", value) for value in page.values("href"))
    assert all(re.fullmatch("[a-z -]*", value) for value in page.values("class"))
    assert not re.search(r"url\(|@import|expression", "".join(page.styles))
    for picture in page.pictures:
        for part in picture.iter():
            tag = part.tag.rpartition("}")[2]
            assert tag in {
                "svg", "g", "defs", "style", "path", "use", "clipPath", "rect", "image", "metadata",
                "linearGradient", "stop",
            }, tag  # fmt: skip
            for name, value in part.attrib.items():
                if name.endswith("href"):
                    assert value.startswith(("#", "data:image/png")), value
                assert not name.lower().startswith("on")
                for url in re.findall(r"url\((.*?)\)", value):
                    assert url.startswith("#")
