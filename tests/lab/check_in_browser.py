"""Opens reports of warpshadow-lab in headless Chromium, as wide as a desk and as a phone.

usage: check_in_browser.py CHROMIUM CHROMEDRIVER FOLDER...

Every folder holds a report.html. Exit code 77 where CHROMIUM or CHROMEDRIVER is no program.
"""

import json
import shutil
import sys
import tempfile
from collections import Counter
from pathlib import Path

if len(sys.argv) < 4:
    sys.exit(__doc__)
BROWSER, DRIVER, *FOLDERS = sys.argv[1:]
if not (shutil.which(BROWSER) and shutil.which(DRIVER)):
    print("skipped: there is no Chromium with its driver to open the reports in")
    sys.exit(77)

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

# Width, and whether the browser acts as that of a phone.
SCREENS = ((1200, False), (360, True))
SMALLEST_TEXT = 11  # pixels of the screen that a reader holds

# What any page has to be, whatever is on it: a list of faults.
LAYOUT = """
const [width, smallest, done] = arguments;
const faults = [], say = (what, which) => faults.push(what + ": " + which);
const name = e => e.outerHTML.slice(0, 160);
const box = e => e.getBoundingClientRect();

for (const each of document.querySelectorAll("details")) {
  if (!each.open) each.querySelector("summary").click();
  if (!each.open || !box(each.lastElementChild).height) say("does not open", name(each));
}
if (innerWidth != width || document.documentElement.scrollWidth > width) {
  say("page as wide as", document.documentElement.scrollWidth + " in " + innerWidth);
}
const scrolls = e => e && (/auto|scroll/.test(getComputedStyle(e).overflowX) || scrolls(e.parentElement));
for (const each of document.body.querySelectorAll("*")) {
  if (!scrolls(each) && box(each).width && (box(each).right > width + 1 || box(each).left < -1)) {
    say("sticks out", name(each));
  }
}

const seen = new Set();
for (const each of document.querySelectorAll("[id]")) {
  if (seen.has(each.id)) say("one id twice", each.id);
  seen.add(each.id);
}
for (const each of document.querySelectorAll("a")) {
  if (!seen.has(each.hash.slice(1))) say("leads nowhere", name(each));
}
if (document.querySelectorAll("h1").length != 1) say("h1", document.querySelectorAll("h1").length);
for (const each of document.querySelectorAll("section")) {
  const heading = each.querySelector("h2");
  if (!heading || !heading.textContent.trim() || !box(heading).height) say("no heading", name(each));
}
for (const each of document.querySelectorAll("table")) {
  const columns = row => [...row.cells].reduce((sum, cell) => sum + cell.colSpan, 0);
  const [head, ...rows] = [...each.rows].map(columns);
  if (!rows.length || rows.some(count => count != head)) say("rows of other lengths", name(each));
}

for (const each of document.querySelectorAll("svg")) {
  if (!(box(each).width > 0 && box(each).height > 0)) say("no size", name(each));
  const touch = (a, b, by) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > by &&
                              Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > by;
  const words = [...each.querySelectorAll("text")];
  for (const [i, one] of words.entries()) {
    const a = box(one), frame = box(each);
    if (Math.min(a.left - frame.left, a.top - frame.top,
                 frame.right - a.right, frame.bottom - a.bottom) < -1) {
      say("cut off", one.textContent);
    }
    for (const other of words.slice(i + 1)) {
      if (touch(a, box(other), 3)) say("written over", one.textContent + " / " + other.textContent);
    }
  }
  for (const part of [each, ...each.querySelectorAll("*")]) {
    for (const {name: key, value} of part.attributes) {
      if (/\\b(nan|inf|infinity|undefined)\\b/i.test(value)) say("not a number", key + "=" + value);
    }
  }
}

const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (texts.nextNode()) {
  const holder = texts.currentNode.parentElement;
  if (!texts.currentNode.data.trim() || holder.closest("script, style, title, option")) continue;
  const scale = holder.ownerSVGElement ? holder.getScreenCTM() : {a: 1, b: 0};
  const size = parseFloat(getComputedStyle(holder).fontSize) * Math.hypot(scale.a, scale.b);
  if (size < smallest) say("text of " + size.toFixed(1) + " px", name(holder));
}

(async () => {
  for (const each of document.images) {
    each.loading = "eager";
    try {
      await each.decode();
    } catch (error) {
      say("not decoded", name(each));
    }
    if (!each.naturalWidth) say("empty picture", name(each));
    for (const side of each.closest(".over") ? [] : ["Width", "Height"]) {
      if (each["natural" + side] != each.getAttribute(side.toLowerCase())) {
        say("its size is not said", name(each)); // the page would jump when it comes
      }
    }
    if (!each.alt) say("no words for it", name(each));
  }
  done(faults);
})();
"""

# The picture on top at a place of the slider's box, as a share of its width.
ON_TOP = """
const over = arguments[0].querySelector(".over"), place = over.getBoundingClientRect();
over.scrollIntoView({block: "center"});
const r = over.getBoundingClientRect();
return document.elementFromPoint(r.left + arguments[1] * r.width, r.top + r.height / 2).alt;
"""


def open_browser(folder):
    options = webdriver.ChromeOptions()
    options.binary_location = BROWSER
    for flag in ("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
                 "--disable-background-networking", "--disable-component-update", "--disable-sync",
                 "--disable-dev-shm-usage", f"--user-data-dir={folder}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(DRIVER), options=options)


def open_page(browser, page, width, phone):
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
        "width": width, "height": 740, "deviceScaleFactor": 1, "mobile": phone})
    browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": phone})
    browser.get(page.resolve().as_uri())


def logged_faults(browser, page):
    """What the console says, and what the page asks for besides itself."""
    faults = [f"console: {entry['message']}" for entry in browser.get_log("browser")]
    for entry in browser.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            url = message["params"]["request"]["url"]
            own = url.startswith(("data:", "chrome:")) # the latter: the browser's first tab
            if not own and url.split("#")[0] != page.resolve().as_uri():
                faults.append(f"asks for {url}")
    return faults


def slider_faults(browser):
    """The border between two pictures goes where it is moved, and between those that are chosen."""
    faults = []
    script = browser.execute_script

    def expect(what, holds):
        if not holds:
            faults.append(f"slider: {what}")

    for box in browser.find_elements(By.CLASS_NAME, "compare"):
        slider = box.find_element(By.CSS_SELECTOR, "input[type=range]")
        left, right = (Select(e) for e in box.find_elements(By.TAG_NAME, "select"))
        under, over = box.find_elements(By.TAG_NAME, "img")
        border = lambda: script("return Number(arguments[0].value) / 100", slider)
        shown = lambda: [each.get_property("src") for each in (under, over)]

        def border_is(share):
            expect(f"border at {border()}, not at {share}", abs(border() - share) < 0.03)
            sides = [script(ON_TOP, box, at) for at in (border() - 0.03, border() + 0.03)]
            expect(f"pictures at {share}: {sides}", sides == ["left", "right"])

        border_is(0.5)
        script("arguments[0].scrollIntoView({block: 'center'})", slider)
        quarter = slider.size["width"] // 4
        ActionChains(browser, duration=50).move_to_element(slider).click_and_hold().move_by_offset(
            quarter, 0).release().perform()
        border_is(0.75)
        both = box.find_element(By.CLASS_NAME, "over")
        script("arguments[0].scrollIntoView({block: 'center'})", both)
        ActionChains(browser, duration=50).move_to_element(both).click_and_hold().move_by_offset(
            -both.size["width"] // 5, 0).release().perform()
        border_is(0.3)
        slider.send_keys(Keys.HOME, *[Keys.ARROW_RIGHT] * 20)
        border_is(0.2)

        expect("one picture twice", shown()[0] != shown()[1])
        names = [option.text for option in left.options]
        expect(f"choices {names}", len(set(names)) == len(names) > 1)
        last = len(names) - 1
        before = shown()
        left.select_by_index(last)
        chosen = script("return document.getElementById(arguments[0]).src",
                        left.options[last].get_attribute("value"))
        expect("left choice", shown() == [chosen, before[1]])
        right.select_by_index(0)
        expect("right choice", shown() == [chosen, before[0]])
        expect("picture not decoded", script("return arguments[0].naturalWidth > 0", over))
    return faults


def page_faults(browser, page, width, phone):
    open_page(browser, page, width, phone)
    faults = slider_faults(browser)
    faults += browser.execute_async_script(LAYOUT, width, SMALLEST_TEXT)
    return faults + logged_faults(browser, page)


def main():
    failed = False
    with tempfile.TemporaryDirectory() as profile:
        browser = open_browser(profile)
        try:
            for folder in FOLDERS:
                page = Path(folder) / "report.html"
                for width, phone in SCREENS:
                    faults = page_faults(browser, page, width, phone)
                    failed = failed or bool(faults)
                    print(f"{page} at {width} px: {len(faults)} faults")
                    kinds = Counter(fault.split(":")[0] for fault in faults)
                    for kind, count in kinds.items():
                        first = next(f for f in faults if f.split(":")[0] == kind)
                        print(f"  {first}" + (f" ({count} of its kind)" if count > 1 else ""))
        finally:
            browser.quit()
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
