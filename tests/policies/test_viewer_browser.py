"""The viewer's page in a headless browser: its controls are moved and the page is read.

It needs viser, selenium, Chromium and its driver. With the environment variable SLIPGYM_SCREENSHOT it also
writes the picture of docs/viewer.md there.
"""

import io
import os
import shutil
import socket
import time

import numpy as np
import pytest

BROWSER, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(BROWSER is None or DRIVER is None, reason="needs chromium and chromedriver"),
]
FLAGS = (
    "--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync --hide-scrollbars --use-gl=angle --use-angle=swiftshader "
    "--enable-unsafe-swiftshader --window-size=1440,960"
)
PATIENCE = 90.0  # [s]


class Page:
    """A viewer and a browser that shows it; time passes only in `until` and `play`."""

    def __init__(self, viewer, browser):
        self.viewer, self.browser = viewer, browser
        browser.get(viewer.url)
        self.until(lambda: self.read("time") != "")

    def play(self, seconds):
        for _ in range(round(30 * seconds)):
            self.viewer.frame(1.0 / 30.0)

    def until(self, condition, seconds=0.0):
        """Wait until the page fulfils a condition, while time passes at that pace."""
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end, self.browser.find_element("tag name", "body").text
            self.viewer.frame(seconds)
            time.sleep(0.2)

    def read(self, name):
        found = self.browser.find_elements("css selector", f'[data-name="{name}"]')
        return found[0].text if found else ""

    def slider(self, number):
        return self.browser.find_elements("css selector", "[role=slider]")[number]

    def click(self, words):
        buttons = self.browser.find_elements("tag name", "button")
        button = next(each for each in buttons if each.text == words)
        self.browser.execute_script("arguments[0].click()", button)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    pytest.importorskip("viser")
    webdriver = pytest.importorskip("selenium.webdriver")
    from policies.play.viewer import open_viewer

    folder = tmp_path_factory.mktemp("viewer")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    options = {"material": "wood", "distance": 0.04}
    viewer = open_viewer(
        "linear_slip", video=folder / "video.mp4", options=options, port=port, engine="planar"
    )
    settings = webdriver.ChromeOptions()
    settings.binary_location = BROWSER
    for flag in (*FLAGS.split(), f"--user-data-dir={folder / 'profile'}"):
        settings.add_argument(flag)
    browser = webdriver.Chrome(options=settings, service=webdriver.ChromeService(DRIVER))
    yield Page(viewer, browser)
    browser.quit()
    viewer.close()


def test_the_page_shows_the_episode(page):
    page.until(lambda: "not observed: it needs slip" in page.read("off mu_c"))
    page.play(1.0)
    page.until(lambda: page.read("time") not in ("", "0.00 s"), 1.0 / 30.0)
    assert page.read("policy") == "linear_slip"
    assert page.read("object") == "wood, 200 g"
    assert page.read("mu_c true") == "0.362"
    assert len(page.browser.find_elements("css selector", "svg.ls polyline")) >= 2
    assert len(page.browser.find_elements("css selector", ".uplot canvas")) == 3


def test_a_slider_changes_the_friction_at_once(page):
    session = page.viewer.session
    page.until(lambda: _press(page.slider(1)) or "mu_c" in session.values)
    page.viewer.frame(1.0 / 30.0)
    wanted = session.values["mu_c"]
    assert wanted > 0.3623
    assert session.info["true"][1] == pytest.approx(wanted, rel=1e-6)
    page.until(lambda: page.read("mu_c true") == f"{session.values['mu_c']:.3f}", 1.0 / 30.0)
    assert page.read("set by hand") == "mu_c"


def test_latency_waits_for_the_next_episode(page):
    session = page.viewer.session
    page.until(lambda: _press(page.slider(4)) or "latency" in session.pending)
    page.until(lambda: page.read("next episode") == "latency", 1.0 / 30.0)
    seed = session.seed
    page.click("next episode")
    page.until(lambda: session.seed > seed)
    assert session.env.config.sensors.slip.latency_samples == session.values["latency"] > 1
    page.until(lambda: page.read("next episode") == "as this one", 1.0 / 30.0)


def test_a_button_pokes_the_object(page):
    page.click("undo all sliders")
    page.until(lambda: not page.viewer.session.values)
    page.play(0.2)
    page.click("→")
    pushes = page.viewer.session.env.simulation.episode["pushes"]
    page.until(lambda: pushes[0] == 1)
    page.until(lambda: page.viewer.session.env.simulation.plant.world["external"][0, 0] > 0.0, 1.0 / 120.0)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # imageio_ffmpeg's own pipes
def test_a_checkbox_records_a_video(page):
    reader = pytest.importorskip("imageio_ffmpeg")
    recording = page.viewer.recording
    for running in (True, False):
        box = page.browser.find_elements("css selector", "input[type=checkbox]")[-1]
        page.browser.execute_script("arguments[0].click()", box)
        page.until(lambda running=running: recording.running == running, 1.0 / 30.0)
        page.play(0.5)
    video = reader.read_frames(str(recording.paths[0]))
    assert next(video)["size"] == (720, 480)
    assert len(list(video)) >= 15


def test_a_screenshot_shows_the_object(page):
    from PIL import Image

    session = page.viewer.session
    session.request_restart()
    page.play(3.2)
    number = page.browser.find_elements("css selector", "input[inputmode=decimal]")[1]
    number.send_keys("\ue009a\ue000", "0.55\ue007")  # Ctrl-A, then the number and Enter
    page.until(lambda: session.values.get("mu_c") == 0.55)
    page.play(2.0)
    page.until(lambda: page.read("mu_c true") == "0.550", 1.0 / 30.0)
    page.browser.execute_script("document.activeElement.blur()")
    for button in page.browser.find_elements("css selector", "[class*=Notification-closeButton]"):
        page.browser.execute_script("arguments[0].click()", button)
    path = os.environ.get("SLIPGYM_SCREENSHOT", os.devnull)
    end = time.monotonic() + PATIENCE
    while True:  # the view fades in
        time.sleep(2.0)
        with Image.open(io.BytesIO(page.browser.get_screenshot_as_png())) as picture:
            view = np.asarray(picture.convert("RGB"))[150:700, 330:1000]
            brown = (view[..., 0].astype(int) > view[..., 2] + 40).mean()
            if brown > 0.02:
                picture.convert("P", palette=Image.Palette.ADAPTIVE).save(path, format="PNG", optimize=True)
                break
        assert time.monotonic() < end, "the object is not in the picture"


def _press(slider):
    slider.send_keys("\ue014")  # arrow to the right
