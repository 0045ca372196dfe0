"""Checks the built site: every link leads to a page and an anchor that exist, and nothing is loaded from elsewhere.

`python docs/check_site.py site`. Links are followed in the HTML as it was written, so those that are made by hooks are
checked too. Where Chromium is at hand, every page is also opened, without a network, and what it asks for is watched.
"""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

sys.path.insert(0, str(Path(__file__).parents[1]))
from tests.web.browser import CHROMIUM, FLAGS

LOADS = {
    "script": ("src",),
    "link": ("href",),
    "img": ("src", "srcset"),
    "iframe": ("src",),
    "source": ("src", "srcset"),
}
CSS_URL = re.compile(r"url\(\s*['\"]?([^'\")]+)")


class Contents(HTMLParser):
    """What a page defines (`anchors`), leads to (`links`) and needs to be shown (`loads`)."""

    def __init__(self, page: Path) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.feed(page.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value for name, value in attrs if value}
        self.anchors |= {given[name] for name in ("id", "name") if name in given}
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        if tag != "link" or given.get("rel") not in ("canonical", "prev", "next"):
            self.loads += [given[name] for name in LOADS.get(tag, ()) if name in given]


def problems(site: Path) -> list[str]:
    """What is wrong in a site, one line each."""
    pages = {page.resolve(): Contents(page) for page in site.rglob("*.html") if page.name != "404.html"}
    found = []
    for page, contents in pages.items():
        name = page.relative_to(site.resolve())
        found += [f"{name} loads {url}, which is elsewhere" for url in contents.loads if elsewhere(url)]
        inside = [url for url in contents.links + contents.loads if not elsewhere(url) and not url.startswith("data:")]
        found += [f"{name}: {trouble}" for url in inside if (trouble := missing(page, url, pages))]
    for sheet in site.rglob("*.css"):
        for url in CSS_URL.findall(sheet.read_text(encoding="utf-8")):
            if elsewhere(url):
                found.append(f"{sheet.relative_to(site)} loads {url}, which is elsewhere")
            elif not url.startswith(("data:", "#")) and not (sheet.parent / urlsplit(url).path).exists():
                found.append(f"{sheet.relative_to(site)} loads {url}, which is missing")
    return found


def elsewhere(url: str) -> bool:
    parts = urlsplit(url)
    return bool(parts.netloc) or parts.scheme in {"http", "https", "mailto"}


def missing(page: Path, url: str, pages: dict[Path, Contents]) -> str | None:
    """What a link within the site does not find."""
    parts = urlsplit(url)
    target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
    if target.is_dir():
        target /= "index.html"
    if not target.exists():
        return f"{url} leads to no file"
    anchor = unquote(parts.fragment)
    if anchor and target in pages and anchor not in pages[target].anchors:
        return f"{url} leads to no such place on the page"
    return None


def asked_for(site: Path) -> list[str]:
    """What the pages ask for from elsewhere, or fail to show, when a browser opens them from the disk."""
    from playwright.sync_api import sync_playwright

    found: list[str] = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        context = browser.new_context(offline=True)
        tab = context.new_page()
        tab.on("request", lambda request: found.append(f"asks for {request.url}") if elsewhere(request.url) else None)
        tab.on("pageerror", lambda error: found.append(f"{tab.url}: {error}"))
        for page in sorted(site.rglob("*.html")):
            if page.parent.name != "core":  # listings, which are all made alike
                tab.goto(page.resolve().as_uri())
        browser.close()
    return found


def main(site: Path) -> int:
    found = problems(site)
    if CHROMIUM:
        found += asked_for(site)
    for line in found:
        print(line, file=sys.stderr)
    looked = "opened in Chromium, too" if CHROMIUM else "not opened: Chromium is not here"
    print(f"{site}: {len(list(site.rglob('*.html')))} pages, {len(found)} problems ({looked})")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
