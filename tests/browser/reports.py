#!/usr/bin/env python3
"""Opens HTML reports in headless Chromium and checks that they work for a reader: reports.py FILE.html [FILE2.html …]

Needs chromium and chromedriver (Debian: chromium, chromium-driver); without them it says SKIPPED and succeeds.
"""

import contextlib
import itertools
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from http.client import HTTPConnection, HTTPException
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

FLAGS = ["--headless=new", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync"]
PHONE = {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True}
LEAST_DRAWINGS, LEAST_TEXT_PX = 4, 7
MOST_FAULTS = 8
LOGS = ["browser", "performance"]
# A number as a reader sees it: "−7.558", "< 0.0001", "12 000", "8.882·10⁻¹⁶".
NUMBER = re.compile(r"(?:< ?)?([-+]?\d+(?:\u202f\d{3})*(?:\.\d+)?)(?:·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)|e([-+]?\d+))?")
PLAIN = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789", "\u202f")

# What is folded away has no boxes to measure.
UNFOLD = "document.querySelectorAll('details').forEach((fold) => { fold.open = true; });"
# Grid and frame are there even when nothing is plotted, so they do not count; nor does what lies outside its drawing.
DRAWINGS = """
const drawings = [...document.querySelectorAll('svg')], faults = [];
const isDrawn = (svg, shape) => {
  const [box, all, seen] = [shape.getBBox(), svg.getBoundingClientRect(), shape.getBoundingClientRect()];
  return !shape.matches('.grid, .frame') && box.width + box.height > 0 && all.width > 0 && all.height > 0
    && isFinite(box.x + box.y + box.width + box.height)
    && seen.left <= all.right && seen.right >= all.left && seen.top <= all.bottom && seen.bottom >= all.top;
};
drawings.forEach((svg, i) => {
  if (![...svg.querySelectorAll('path, rect, circle')].some((shape) => isDrawn(svg, shape)))
    faults.push(`svg ${i + 1} in #${svg.closest('section')?.id} is empty`);
});
for (const part of document.querySelectorAll('svg, svg *'))
  for (const { name, value } of part.attributes)
    if (/^(d|[cr]?[xy]|[xy][12]|r|width|height|points|transform|viewBox)$/.test(name) && /nan|inf/i.test(value))
      faults.push(`<${part.nodeName} ${name}="${value.slice(0, 60)}"> in #${part.closest('section')?.id}`);
return [drawings.length, faults];"""
# Each column after one click and after two: what its head says, and per cell its text without and with small print.
SORT = """
const rows = (table) => [...table.tBodies[0].rows];
const own = (cell) => [...cell.childNodes].filter((node) => node.nodeName !== 'SMALL').map((node) => node.textContent);
const read = (cell) => [own(cell).join('').trim(), cell.textContent.trim()];
return [...document.querySelectorAll('table.sortable')].map((table) => {
  const all = () => rows(table).map((row) => row.innerHTML).sort().join('\\n'), before = all();
  const clicked = (head, column) => {
    head.click();
    const cells = rows(table).map((row) => read(row.cells[column]));
    return { says: head.getAttribute('aria-sort'), cells, whole: all() === before };
  };
  return [...(table.tHead?.rows[0]?.cells ?? [])].map((head, column) =>
    ({ head: head.textContent, clicks: [clicked(head, column), clicked(head, column)] }));
});"""
# Of a page that is too wide the elements are named that stick out and are in no box that scrolls by itself.
NARROW = """
const root = document.documentElement;
const scrolls = (of) => of && (getComputedStyle(of).overflowX !== 'visible' || scrolls(of.parentElement));
const isOut = (part) => part.getBoundingClientRect().right > root.clientWidth + 1 && !scrolls(part.parentElement);
const size = (text) => {
  const m = text.getScreenCTM();
  return parseFloat(getComputedStyle(text).fontSize) * Math.min(Math.hypot(m.a, m.b), Math.hypot(m.c, m.d));
};
const texts = [...document.querySelectorAll('svg text, svg tspan')].filter((text) => text.textContent.trim());
return { page: root.clientWidth, needs: root.scrollWidth, texts: texts.map((text) => [size(text), text.textContent]),
  out: [...document.body.querySelectorAll('*')].filter(isOut).map((part) => part.outerHTML.slice(0, 80)) };"""
LINKS = """
return [[...document.querySelectorAll('[href]')].map((link) => link.getAttribute('href')),
  [...document.querySelectorAll('[id]')].filter((to) => to.getClientRects().length).map((to) => to.id)];"""


def request(port: int, method: str, path: str, body: Any = None) -> Any:
    # http.client, since urllib would send even this through a proxy of the environment.
    connection = HTTPConnection("127.0.0.1", port, timeout=90)
    try:
        connection.request(method, path, None if body is None else json.dumps(body))
        response = connection.getresponse()
        value = json.load(response)["value"]
    finally:
        connection.close()
    if response.status != 200:
        raise RuntimeError(f"{path.rsplit('/', 1)[-1]}: {value.get('message', value).splitlines()[0]}")
    return value


@contextlib.contextmanager
def driver(program: str) -> Iterator[int]:
    """The port of a chromedriver that lives as long as the context; it finds a free one itself: no race for it."""
    pipe, null = subprocess.PIPE, subprocess.DEVNULL
    with subprocess.Popen([program, "--port=0"], stdout=pipe, stderr=null, text=True) as process:
        try:
            lines = (re.search(r"started successfully on port (\d+)", line) for line in process.stdout or ())
            port = next((found[1] for found in lines if found), None)
            if port is None:
                raise RuntimeError("chromedriver did not start")
            yield int(port)
        finally:
            process.terminate()


@contextlib.contextmanager
def browser(port: int, program: str) -> Iterator[str]:
    """The path of a session: a browser of its own for every page, so that no page's log or crash is another's."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        flags = [*FLAGS, f"--user-data-dir={profile}", *(["--no-sandbox"] if os.geteuid() == 0 else [])]
        wanted = {"browserName": "chrome", "goog:chromeOptions": {"binary": program, "args": flags},
                  "goog:loggingPrefs": dict.fromkeys(LOGS, "ALL"), "timeouts": {"pageLoad": 30_000, "script": 30_000}}
        session = request(port, "POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
        try:
            yield f"/session/{session['sessionId']}"
        finally:
            try:
                request(port, "DELETE", f"/session/{session['sessionId']}")
            except (OSError, HTTPException, RuntimeError):
                # A browser that hangs would outlive its driver.
                with contextlib.suppress(ProcessLookupError, KeyError):
                    os.kill(session["capabilities"]["goog:processID"], signal.SIGKILL)


def key(cell: list[str]) -> tuple[int, float, str]:
    """Order of a cell: no value, numbers by value, texts; read as a reader does, not as the script under test does."""
    own, whole = (text.replace("−", "-") for text in cell)
    if own in ("", "–"):
        return 0, float("-inf"), ""
    if number := NUMBER.match(own):
        return 0, float(f"{number[1]}e{number[2] or number[3] or 0}".translate(PLAIN)), ""
    return 1, 0.0, whole


def sorting(tables: list[list[dict[str, Any]]]) -> list[str]:
    faults = [] if tables else ["no sortable table"]
    for n, columns in enumerate(tables, 1):
        faults += [] if columns else [f"table {n} has no head"]
        for column, (times, click) in itertools.product(columns, enumerate(("descending", "ascending"))):
            where, after = f"table {n} by “{column['head']}”, click {times + 1}", column["clicks"][times]
            if after["says"] != click:
                faults.append(f"{where}: aria-sort is {after['says']}, not {click}")
            if not after["whole"]:
                faults.append(f"{where}: rows were lost or changed")
            for one, next_one in itertools.pairwise(after["cells"]):
                if key(one) < key(next_one) if click == "descending" else key(one) > key(next_one):
                    faults.append(f"{where}: “{one[1]}” comes before “{next_one[1]}”, which is not {click}")
                    break
    return faults


def leads(href: str, page: Path, targets: list[str]) -> bool:
    """Whether a link leads somewhere; addresses elsewhere are the reader's own choice to follow."""
    parts = urlsplit(href)
    if href.startswith("#"):
        return unquote(parts.fragment) in (*targets, "", "top")
    return bool(parts.scheme or parts.netloc) or (page.parent / unquote(parts.path)).is_file()


def check(port: int, session: str, page: Path) -> dict[str, list[str]]:
    """Faults by check."""
    def post(what: str, body: Any) -> Any:
        return request(port, "POST", f"{session}/{what}", body)

    def run(script: str) -> Any:
        return post("execute/sync", {"script": script, "args": []})

    address = page.as_uri()
    # The browser opens with a page of its own, whose log is none of the report's.
    post("url", {"url": "about:blank"})
    for kind in LOGS:
        post("se/log", {"type": kind})
    post("url", {"url": address})
    run(UNFOLD)
    count, drawings = run(DRAWINGS)
    if count < LEAST_DRAWINGS:
        drawings.append(f"{count} drawings, fewer than {LEAST_DRAWINGS}")
    tables = run(SORT)
    hrefs, targets = run(LINKS)
    post("goog/cdp/execute", {"cmd": "Emulation.setDeviceMetricsOverride", "params": PHONE})
    narrow = run(NARROW)
    # A page without a viewport tag is laid out wider than the phone and shrunk.
    laid_out, needs = narrow["page"], narrow["needs"]
    phone = [] if laid_out == PHONE["width"] else [f"laid out for {laid_out} px, not {PHONE['width']} px"]
    if needs > laid_out + 1:
        phone.append(f"scrolls sideways: {needs} px in {laid_out} px: {', '.join(narrow['out'][:3])}")
    phone += [f"text of {px:.1f} px: “{text}”" for px, text in narrow["texts"] if not px >= LEAST_TEXT_PX]
    dead = [f"dead link {href}" for href in dict.fromkeys(hrefs) if not leads(href, page, targets)]
    # Logs come last: a click may fail or fetch something too.
    console, events = (post("se/log", {"type": kind}) for kind in LOGS)
    events = [json.loads(entry["message"])["message"] for entry in events]
    requests = [e["params"]["request"]["url"] for e in events if e["method"] == "Network.requestWillBeSent"]
    requests += [e["params"]["url"] for e in events if e["method"] == "Network.webSocketCreated"]
    network = [f"asks for {url[:120]}" for url in requests if url != address and not url.startswith("data:")]
    if address not in requests:
        network.append("the log of requests does not even name the page: it proves nothing")
    return {"console": [entry["message"] for entry in console if entry["level"] in ("SEVERE", "WARNING")],
            "network": network, "drawings": drawings, "sorting": sorting(tables), "phone": phone, "links": dead}


def main(names: list[str]) -> int:
    if not names:
        print(__doc__, file=sys.stderr)
        return 2
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    chromedriver = shutil.which("chromedriver")
    if not (chromium and chromedriver):
        print(f"SKIPPED: {'chromedriver' if chromium else 'chromium'} is not installed; no report was opened")
        return 0
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # A CI that gives up leaves no browser behind.
    passed = failed = 0
    with driver(chromedriver) as port:
        for name in names:
            try:
                with browser(port, chromium) as session:
                    results = check(port, session, Path(name).resolve(strict=True))
            except (OSError, HTTPException, RuntimeError) as error:
                results = {"opening": [str(error)]}
            for what, faults in results.items():
                print(f"{'FAIL' if faults else 'ok  '} {name}: {what}")
                more = [f"and {len(faults) - MOST_FAULTS} more"] if len(faults) > MOST_FAULTS else []
                for fault in faults[:MOST_FAULTS] + more:
                    print(f"       {fault}")
                passed, failed = passed + (not faults), failed + bool(faults)
    print(f"{passed} passed, {failed} failed")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
