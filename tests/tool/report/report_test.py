"""The page of `softcell report` in a headless Chromium: report_test.py SOFTCELL_COMMAND [unittest options].

Needs chromium, chromium-driver and python3-selenium. One browser serves all tests; each opens its own page.
"""

import json
import os
import subprocess
import sys
import tempfile
import unittest

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

import known_trace

COMMAND = None
LONG_JOBS = 4_000  # of each SPE, with three more events each


def start_browser():
    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1300,900"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    browser.set_page_load_timeout(20)
    return browser


def report(trace, folder):
    """Runs `softcell report` on a document; the page's path, or None with the command's message."""
    path = os.path.join(folder, "known.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(trace, file)
    page = os.path.join(folder, "known.html")
    result = subprocess.run([COMMAND, "report", path, "--out", page], capture_output=True, text=True, check=False)
    return page, result


class WithBrowser(unittest.TestCase):
    """One browser for all tests that need one."""

    browser = None

    @classmethod
    def setUpClass(cls):
        if WithBrowser.browser is None:
            WithBrowser.browser = start_browser()
            unittest.addModuleCleanup(WithBrowser.browser.quit)


class Refused(unittest.TestCase):
    """What the command makes no page of."""

    def test_a_tampered_trace_is_refused_with_one_sentence_and_leaves_no_page(self):
        def absurd_tag(trace):
            next(e for e in trace["traceEvents"] if e.get("cat") == "dma")["args"]["tag"] = 99

        def without_softcell(trace):
            del trace["softcell"]

        for tamper, part in ((absurd_tag, '"tag" is 99'), (without_softcell, '"softcell" is missing')):
            with self.subTest(part), tempfile.TemporaryDirectory() as folder:
                trace = known_trace.known_trace().document()
                tamper(trace)
                page, result = report(trace, folder)
                self.assertEqual(result.returncode, 1)
                self.assertIn(part, result.stderr)
                self.assertEqual(result.stderr.count("\n"), 1)
                self.assertEqual(os.listdir(folder), ["known.json"], f"{page} is left")


class Page(WithBrowser):
    """The page of the known trace."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.page, result = report(known_trace.known_trace().document(), cls.folder.name)
        assert result.returncode == 0, result.stderr

    def setUp(self):
        self.browser.get_log("browser")
        self.browser.get_log("performance")
        self.browser.get("file://" + self.page)
        self.run_script("window.scrollTo(0, 0)")

    def tearDown(self):
        errors = [entry["message"] for entry in self.browser.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]
        self.assertEqual(errors, [], "the console is silent")

    def run_script(self, script):
        return self.browser.execute_script(script)

    def view(self):
        return self.run_script("const {begin, end} = softcellReport.view; return {begin, end}")

    def text(self, element_id):
        return self.browser.find_element(By.ID, element_id).text

    def wait_until(self, condition, message):
        WebDriverWait(self.browser, 10).until(lambda _: condition(), message)

    def canvas(self):
        return self.browser.find_element(By.ID, "timeline")

    def point_of(self, spe, job):
        """Where a job is drawn: offsets from the canvas's middle, as ActionChains takes them."""
        return self.run_script(f"""
            const {{timeline}} = softcellReport, row = timeline.rows.find((r) => r.kind === "job" && r.spe.number === {spe});
            const box = timeline.canvas.getBoundingClientRect();
            const x = timeline.x((row.columns.begin[{job}] + row.columns.end[{job}]) / 2);
            return [Math.round(x - box.width / 2), Math.round(row.y + row.height / 2 - box.height / 2)]""")

    def test_it_fetches_nothing(self):
        urls = set()
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                urls.add(message["params"]["request"]["url"])
        self.assertEqual({url for url in urls if not url.startswith("data:")}, {"file://" + self.page})

    def test_it_shows_the_jobs_of_the_trace(self):
        jobs = self.run_script("""return softcellReport.trace.spes.map((spe) => [...spe.jobs.begin].map((begin, i) =>
            [begin, spe.jobs.end[i], spe.name(spe.jobs, i), spe.jobs.number[i], spe.jobs.failed[i]]))""")
        self.assertEqual([len(spe) for spe in jobs], [5, 6, 7, 8, 9, 10])
        self.assertEqual(jobs[0][1], [1_000_000, 1_900_000, "sum_bars", 1, 0])
        self.assertEqual(jobs[5][9], [9_050_000, 9_950_000, "sum_bars", 44, 1])
        summary = self.text("summary")
        for part in ("45", "1 failed", "135", "9.95 ms"):
            self.assertIn(part, summary)
        kernels = [[cell.text for cell in row.find_elements(By.CSS_SELECTOR, "th, td")][:3]
                   for row in self.browser.find_elements(By.CSS_SELECTOR, "#kernels tbody tr")]
        self.assertEqual(kernels, [["skin", "24", "0"], ["sum_bars", "21", "1"]])

    def test_jobs_are_drawn_where_they_happened(self):
        skin, sum_bars, skin_again, nothing = self.run_script("""
            const {timeline} = softcellReport, row = timeline.rows.find((r) => r.kind === "job"), scale = devicePixelRatio;
            timeline.draw();
            const {data} = timeline.canvas.getContext("2d").getImageData(0, (row.y + 3) * scale, timeline.canvas.width, 1);
            return [800e3, 1800e3, 2800e3, 6500e3].map((time) => [...data.slice(4 * Math.floor(timeline.x(time) * scale)).slice(0, 4)])""")
        self.assertEqual(skin, skin_again)
        self.assertNotEqual(skin, sum_bars, "another kernel has another colour")
        self.assertNotEqual(skin, nothing)

    def test_the_wheel_zooms_at_the_pointer_and_fit_shows_all(self):
        whole = self.view()
        x, y = self.point_of(2, 3)
        before = self.run_script(f"return softcellReport.timeline.time({x} + softcellReport.timeline.canvas.clientWidth / 2)")
        self.run_script(f"""
            const {{canvas}} = softcellReport.timeline, box = canvas.getBoundingClientRect();
            canvas.dispatchEvent(new WheelEvent("wheel", {{deltaY: -300, cancelable: true, clientX: {x} + box.left + box.width / 2,
                                                           clientY: {y} + box.top + box.height / 2}}))""")
        view = self.view()
        self.assertLess(view["end"] - view["begin"], 0.7 * (whole["end"] - whole["begin"]))
        after = self.run_script(f"return softcellReport.timeline.time({x} + softcellReport.timeline.canvas.clientWidth / 2)")
        pixel = (whole["end"] - whole["begin"]) / 1000
        self.assertAlmostEqual(before, after, delta=pixel)
        self.browser.find_element(By.ID, "fit").click()
        self.assertEqual(self.view(), whole)

    def test_dragging_pans(self):
        self.browser.find_element(By.ID, "zoom-in").click()
        before = self.view()
        x, y = self.point_of(2, 4)
        ActionChains(self.browser).move_to_element_with_offset(self.canvas(), x, y).click_and_hold().move_by_offset(-120, 0).release().perform()
        after = self.view()
        self.assertGreater(after["begin"], before["begin"])
        self.assertAlmostEqual(after["end"] - after["begin"], before["end"] - before["begin"], delta=1)

    def test_hovering_tells_what_lies_there(self):
        x, y = self.point_of(5, 9)
        ActionChains(self.browser).move_to_element_with_offset(self.canvas(), x, y).perform()
        self.wait_until(lambda: self.browser.find_element(By.ID, "tooltip").is_displayed(), "the tooltip appears")
        for part in ("sum_bars, job 44", "900.000 µs", "failed"):
            self.assertIn(part, self.text("tooltip"))

    def test_the_keyboard_does_it_all(self):
        canvas = self.canvas()
        self.run_script("softcellReport.timeline.canvas.focus()")
        whole = self.view()
        canvas.send_keys("++")
        zoomed = self.view()
        self.assertLess(zoomed["end"] - zoomed["begin"], 0.5 * (whole["end"] - whole["begin"]))
        canvas.send_keys(Keys.ARROW_RIGHT)
        self.assertGreater(self.view()["begin"], zoomed["begin"])
        canvas.send_keys("0")
        self.assertEqual(self.view(), whole)
        canvas.send_keys("n")
        self.assertIn("skin, job 0", self.text("selection"))
        canvas.send_keys("n")
        self.assertIn("sum_bars, job 1", self.text("selection"))
        canvas.send_keys("p", Keys.ARROW_DOWN)
        self.assertIn("skin, job 5", self.text("selection"))
        canvas.send_keys(Keys.ESCAPE)
        self.assertEqual(self.text("selection"), "")

    def test_findings_are_listed_once_and_lead_to_the_timeline(self):
        rows = self.browser.find_elements(By.CSS_SELECTOR, "#findings tbody tr")
        self.assertEqual(len(rows), 2)
        self.assertIn("load-in-flight", rows[0].text)
        self.assertIn("skin.cpp:41", rows[0].text)
        self.assertEqual([cell.text for cell in rows[0].find_elements(By.TAG_NAME, "td")][2:4], ["501", "2, 3"])
        rows[0].find_element(By.TAG_NAME, "button").click()
        view = self.view()
        self.assertLess(view["begin"], 1_200_000)
        self.assertGreater(view["end"], 1_200_000)
        self.assertLess(view["end"] - view["begin"], 10_000)
        self.assertIn("a get of tag 3 is in flight", self.text("selection"))

    def test_text_of_a_trace_is_never_markup(self):
        self.assertIn(known_trace.HOSTILE, self.text("findings"))
        self.assertIsNone(self.run_script("return window.escaped ?? null"))

    def test_waits_are_shared_out_over_the_visible_range(self):
        def shares():
            return self.run_script("return [...document.querySelectorAll('#shares tbody tr:first-child td')].slice(1).map((td) => td.textContent)")

        # SPE 0: of 9.95 ms five jobs of 0.9 ms, with 0.15 and 0.05 ms of waits each.
        self.assertEqual(shares(), ["35 %", "7.5 %", "2.5 %", "55 %"])
        self.run_script("softcellReport.view.set(0, 1000000)")
        self.wait_until(lambda: shares() == ["70 %", "15 %", "5.0 %", "10 %"], "the table follows the timeline")

    def test_bandwidth_is_what_the_commands_moved(self):
        numbers = self.text("bandwidth-numbers")
        self.assertIn("get 1.11 MB", numbers)  # 45 * (16384 + 8192) bytes
        self.assertIn("put 184 kB", numbers)   # 45 * 4096 bytes
        self.assertIn("1.29 MB moved", self.text("summary"))
        duration = self.run_script("const {trace} = softcellReport; return (trace.end - trace.begin) / 1e9")
        self.assertIn(f"at {45 * (16384 + 8192) / duration / 1e6:.0f} MB/s", numbers)  # the same MB
        peak = self.run_script("return softcellReport.bandwidth.measure().peak")
        # At most six SPEs with 16384 bytes in 200 us and 8192 in 180 us.
        self.assertGreater(peak, 0.5 * 6 * 127e6)
        self.assertLess(peak, 1.01 * 6 * 128e6)

    def test_local_stores_are_drawn_to_scale(self):
        stores = self.browser.find_elements(By.CSS_SELECTOR, "#stores .store")
        self.assertEqual([store.find_element(By.TAG_NAME, "h3").text.split()[0] for store in stores], ["skin", "sum_bars"])
        whole = stores[0].find_element(By.CLASS_NAME, "map")
        bss = next(part for part in whole.find_elements(By.TAG_NAME, "span") if part.get_attribute("title").startswith("bss"))
        self.assertAlmostEqual(bss.rect["width"] / whole.rect["width"], 40960 / (256 * 1024), delta=0.005)
        for part in ("text", "6 100", "stack", "4 096", "1 360 of 4 096", "weights", "free", "of 256 KiB taken, budget 96 KiB"):
            self.assertIn(part, stores[0].text)
        self.assertIn("not measured", stores[1].text)

    def test_every_control_and_picture_has_a_name(self):
        nameless = self.run_script("""return [...document.querySelectorAll("button, canvas, section, [tabindex], table")].filter((element) =>
            !(element.textContent.trim() || element.getAttribute("aria-label") || element.getAttribute("aria-labelledby"))).map((e) => e.outerHTML)""")
        self.assertEqual(nameless, [])
        levels = self.run_script("return [...document.querySelectorAll('h1, h2, h3')].map((h) => Number(h.tagName[1]))")
        self.assertEqual(levels[0], 1)
        self.assertTrue(all(after - before <= 1 for before, after in zip(levels, levels[1:])), levels)

    def test_it_fits_a_narrow_window(self):
        try:
            self.browser.set_window_size(520, 900)
            self.wait_until(lambda: self.run_script("return document.documentElement.scrollWidth <= window.innerWidth"),
                            "nothing sticks out of the page")
        finally:
            self.browser.set_window_size(1300, 900)


class ResidentTrace(WithBrowser):
    """A kernel that sleeps between its jobs, as all demos have it."""

    def test_sleep_outside_of_jobs_is_no_waiting(self):
        with tempfile.TemporaryDirectory() as folder:
            page, result = report(known_trace.resident_trace().document(), folder)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.browser.get("file://" + page)
            summary = self.browser.find_element(By.ID, "summary").text
            self.assertIn("10 %\nwith a job", summary)
            self.assertIn("25 %\nof the busy time", summary)
            rows = self.browser.find_elements(By.CSS_SELECTOR, "#shares tr")
            cells = [[cell.text for cell in row.find_elements(By.CSS_SELECTOR, "th, td")] for row in rows]
            self.assertEqual(cells[0], ["SPE", "", "working", "MFC_RdTagStat", "SPU_RdEventStat", "no job"])
            self.assertEqual(cells[1:], [[f"SPE {spe}", "", "7.5 %", "2.0 %", "0.5 %", "90 %"] for spe in range(6)])


class LongTrace(WithBrowser):
    """A hundred thousand events: a picture must not cost what they cost."""

    def test_it_draws_quickly_at_every_zoom(self):
        with tempfile.TemporaryDirectory() as folder:
            page, result = report(known_trace.long_trace(LONG_JOBS).document(), folder)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.browser.get("file://" + page)
            milliseconds = self.browser.execute_script("""
                const {timeline, bandwidth, view} = softcellReport, took = [];
                for (let i = 0; i < 12; ++i) {
                  const begin = performance.now();
                  timeline.draw();
                  bandwidth.draw();
                  took.push(performance.now() - begin);
                  view.zoom(0.4);
                }
                return took.sort((a, b) => a - b)[6]""")
            self.assertEqual(self.browser.execute_script("return softcellReport.trace.count('jobs')"), 6 * LONG_JOBS)
            self.assertLess(milliseconds, 250, "half of the pictures are drawn in this time")


if __name__ == "__main__":
    COMMAND = sys.argv.pop(1)
    unittest.main(verbosity=2)
