"""Helpers that open a report in a headless browser, and that read its page and decode its pictures without one."""

import base64
import io
import re
import shutil
import xml.etree.ElementTree as ET
from html.parser import HTMLParser
from pathlib import Path

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def browser() -> str | None:
    """Return the path of a Chromium that playwright can control, or None."""
    try:
        import playwright  # noqa: F401
    except ImportError:
        return None
    return next((path for name in BROWSERS if (path := shutil.which(name))), None)


def seen_in_browser(report: Path, program: str) -> dict[str, object]:
    """Return what a browser finds in a page: images and their sizes, requests to the network, scripts, errors, text."""
    from playwright.sync_api import sync_playwright

    asked: list[str] = []
    errors: list[str] = []
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"], timeout=0)
        page = chromium.new_page()
        page.set_default_timeout(0)
        page.on("request", lambda request: asked.append(request.url))
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("dialog", lambda dialog: (errors.append(dialog.message), dialog.dismiss()))
        page.goto(report.as_uri(), wait_until="load")
        images = page.evaluate(
            "[...document.images].map(i => [i.alt, i.complete, i.naturalWidth, i.getBoundingClientRect().width])"
        )
        scripts = page.evaluate("document.scripts.length")
        text = page.inner_text("body")
        chromium.close()
    outside = [url for url in asked if not url.startswith(("data:", "file:"))]
    return {"images": images, "outside": outside, "scripts": scripts, "errors": errors, "text": text}


class Page(HTMLParser):
    """The sources of the images, the elements and the text of an HTML page."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.images: list[str] = []
        self.elements: set[str] = set()
        self.text = ""
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Record an element."""
        self.elements.add(tag)
        if tag == "img":
            self.images.append(dict(attrs).get("src") or "")

    def handle_data(self, data: str) -> None:
        """Record text."""
        self.text += data


def decoded_width(source: str) -> float:
    """Return the width of the picture in a data URI, after decoding it completely."""
    match = re.fullmatch(r"data:image/(png|svg\+xml);base64,([A-Za-z0-9+/=]+)", source)
    assert match, source[:80]
    content = base64.b64decode(match[2], validate=True)
    if match[1] == "png":
        import matplotlib.image

        return float(matplotlib.image.imread(io.BytesIO(content), format="png").shape[1])
    root = ET.fromstring(content)
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert len(list(root.iter())) > 20, "an empty picture"
    return float((root.get("width") or "0").removesuffix("pt"))
