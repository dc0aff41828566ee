#!/usr/bin/python3
"""The page of a load report in a browser: what is drawn, loaded, and how wide it is."""
import html
import json
import re
import shutil
import subprocess
import unittest

from made_loads import Shared

PROBE = """<script>
window.addEventListener('load', () => {
  const images = [...document.images];
  document.body.dataset.probe = JSON.stringify({
    images: images.length, drawn: images.filter(i => i.complete && i.naturalWidth > 100).length,
    wide: document.documentElement.scrollWidth - window.innerWidth,
    tables: document.querySelectorAll('table').length, rows: document.querySelectorAll('tbody tr').length,
    font: getComputedStyle(document.body).fontSize, loaded: performance.getEntriesByType('resource').filter(
      entry => !entry.name.startsWith('data:')).map(entry => entry.name)});
});
</script>"""


class Browser(Shared):
    """The page in Chromium without a screen."""

    def setUp(self):
        self.chromium = shutil.which("chromium")
        if self.chromium is None:
            self.skipTest("chromium is not installed: scripts/install_dependencies.sh --workflow")
        super().setUp()

    def chromium_says(self, page, *words):
        ran = subprocess.run([self.chromium, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                              "--user-data-dir=%s" % (self.folder / "profile"), *words, "file://%s" % page],
                             stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=120)
        return ran.stdout.decode("utf-8")

    def probe(self, width):
        page = self.made / "report.html"
        probed = self.folder / "probed.html"
        probed.write_text(page.read_text(encoding="utf-8").replace("</body>", PROBE + "</body>"), encoding="utf-8")
        dom = self.chromium_says(probed, "--window-size=%d,900" % width, "--virtual-time-budget=5000", "--dump-dom")
        said = re.search(r'data-probe="([^"]*)"', dom)
        self.assertIsNotNone(said, dom[-300:])
        return json.loads(html.unescape(said.group(1)))

    def test_every_picture_is_drawn_and_nothing_is_loaded(self):
        said = self.probe(1400)
        self.assertGreater(said["images"], 8)
        self.assertEqual(said["drawn"], said["images"])
        self.assertGreaterEqual(said["tables"], 6)
        self.assertGreater(said["rows"], 30)
        self.assertEqual(said["loaded"], [])

    def test_it_fits_screens_of_any_width(self):
        for width in (1400, 700):
            with self.subTest(width=width):
                self.assertLessEqual(self.probe(width)["wide"], 0)


if __name__ == "__main__":
    unittest.main()
