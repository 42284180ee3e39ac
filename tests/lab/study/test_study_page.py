"""The report: whole, self-contained, and drawn by a browser."""

import html.parser
import itertools
import re
import shutil
import subprocess

import numpy as np
import pandas as pd
import pytest

from lab.study_report.page import render, write_report
from lab.study_report.videos import Clip, Scene
from policies.play.video import Video
from policies.study import run as runner
from policies.study.tables import benefits, outcomes, shares, transfer
from slipgym.rendering import HEIGHT, WIDTH

CLEAR = {"none": 0, "nominal": 5, "estimated": 9, "true": 10}
VOID = {"meta", "link", "br", "img", "input", "hr", "path", "use", "rect"}
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")


@pytest.fixture(scope="module")
def clip(tmp_path_factory):
    path = tmp_path_factory.mktemp("videos") / "film.mp4"
    with Video(path) as film:
        for grey in range(0, 250, 25):
            film.add(np.full((HEIGHT, WIDTH, 3), grey, np.uint8))
    return path


@pytest.fixture(scope="module")
def page(small, invented, clip):
    """A report with every section, of invented episodes."""
    tables = [
        invented(CLEAR, task, world, kind)
        for task, world, kind in itertools.product(
            ["Hold", "Hinge"], ["PyBullet, ellipsoid", "core"], ["classic", "learned"]
        )
    ]
    plain = pd.concat(tables, ignore_index=True)
    joint = plain[plain["source"] == "estimated"].assign(estimator="joint")
    worse = [
        plain[plain["world"] == "core"].assign(change=change, level=level)
        for change, level in itertools.product(["noise_scale", "friction_jump"], [0.5, 1.0])
    ]
    episodes = pd.concat([plain, joint, *worse], ignore_index=True)
    study = small(
        tasks=["Hold", "Hinge"],
        estimators=["disc", "joint"],
        degradation={"world": "core", "episodes": 10, "noise_scale": [0.5, 1.0], "friction_jump": [1.0, 0.5]},
    )
    made = {
        "outcomes": outcomes(episodes),
        "shares": shares(episodes, "disc"),
        "benefits": benefits(episodes),
        "transfer": transfer(episodes, study),
    }
    made["constant_grip"] = pd.DataFrame(
        [
            {"task": task, "force_N": 3.14, "n": 20}
            | {
                f"{name}{end}": 0.5
                for name in ("success", "dropped", "return")
                for end in ("", "_low", "_high")
            }
            for task in ("Hold", "Hinge")
        ]
    )
    films = tuple(Clip(source, clip, source != "none", False) for source in ("none", "estimated", "true"))
    scene = Scene("Hold", "learned", 7, "the first", films)
    return render(study, episodes, made, [scene], ["Hold: <nothing> & all"], "slipgym study-report small")


class Reader(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.ids, self.links, self.tags = [], [], [], []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        for name, value in attrs:
            if name == "id":
                self.ids.append(value)
            if name in ("href", "src", "xlink:href", "data", "poster", "srcset", "action"):
                self.links.append(value)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open.pop() == tag, tag


def test_the_page_is_whole_and_needs_nothing_else(page):
    reader = Reader()
    reader.feed(page)
    assert reader.open == []
    assert {"script", "iframe", "object"}.isdisjoint(reader.tags)
    assert reader.tags.count("video") == 3
    assert reader.tags.count("svg") == 6  # success, shares, estimators, transfer, and what gets worse, twice
    for link in reader.links:
        assert link.startswith(("data:", "#")), link
    inside = {link[1:] for link in reader.links if link.startswith("#")}
    assert inside <= set(reader.ids)
    assert not re.search(r"url\((?!#)", page)
    assert "@import" not in page


def test_the_page_says_what_is_known(page):
    text = re.sub(r"\s+", " ", re.sub(r"<(style|svg).*?</\1>|<[^>]+>", " ", page, flags=re.DOTALL))
    assert "the estimate recovers 90 %" in text
    assert "at least 80 % in 4 of these" in text  # success and return of both tasks
    assert "Hold 20 3.14 50.0" in text
    assert "The benefit depends on that baseline" in text
    assert "Hold: &lt;nothing&gt; &amp; all" in text
    assert re.search(
        r"Hold train (classic|learned) nominal classic estimated disc 30 40\.0 23\.3 to 56\.7 – ", text
    )
    assert "slipgym study-report small" in text
    assert text.count("✓ reached") == 10
    assert "nan" not in text.lower().replace("nominal", "")


def test_kinds_with_a_single_friction_source_are_compared_in_the_table_alone(small, invented):
    episodes = pd.concat([invented(CLEAR), invented({"none": 7}, kind="memory")], ignore_index=True)
    study = small(tasks=["Hold"])
    made = {
        "outcomes": outcomes(episodes),
        "shares": shares(episodes, "disc"),
        "benefits": benefits(episodes),
    }
    made |= {"transfer": transfer(episodes, study), "constant_grip": pd.DataFrame()}
    page = render(study, episodes, made, [], [], "")
    assert "The controllers: episodes solved" in page
    assert "with a memory of slips" not in page
    assert page.count("<td>memory</td><td>classic</td>") == 2  # the opponent of estimated and true


def test_the_report_of_a_finished_study(small, tmp_path, monkeypatch, invoke):
    original = runner.constant_grips
    monkeypatch.setattr(runner, "constant_grips", lambda *a, **k: original(*a, candidates=3, **k))
    world = {"label": "core", "engine": "planar", "contact": "ellipsoid", "sources": ["true"]}
    folder = runner.run_study(small(worlds=[world]), tmp_path, 1, progress=False)
    page = write_report(folder, progress=False).read_text(encoding="utf-8")
    assert "<td>LinearSlip</td>" in page
    assert 'id="shares"' not in page  # there is one source alone
    assert invoke("study-report", str(tmp_path / "nothing")).exit_code == 2
    assert invoke("study-report", str(folder)).stdout.rstrip().endswith("report.html")


def test_there_is_no_clock_on_the_page(page):
    assert not re.search(r"20\d\d-\d\d-\d\d", re.sub(r"data:[^\"]*", "", page))


PROBE = """
<script>
addEventListener("load", async () => {
  const videos = [...document.querySelectorAll("video")];
  const ready = v => v.readyState || new Promise(done => v.onloadedmetadata = v.onerror = done);
  await Promise.all(videos.map(ready));
  const page = document.documentElement;
  const words = [...document.querySelectorAll("svg text")].map(each => each.getBBox().width);
  page.dataset.played = videos.filter(video => video.videoWidth > 0 && video.duration > 0).length;
  page.dataset.overflow = page.scrollWidth - page.clientWidth;
  const asked = performance.getEntriesByType("resource").filter(each => !each.name.startsWith("data:"));
  page.dataset.asked = asked.length;
  page.dataset.words = words.filter(width => width > 0).length;
  page.dataset.ink = getComputedStyle(document.body).color;
});
</script>
"""


@pytest.mark.parametrize("width", [1280, 500])
def test_a_browser_draws_it(page, tmp_path, width):
    browser = next((found for name in BROWSERS if (found := shutil.which(name))), None)
    if browser is None:
        pytest.skip(f"none of {', '.join(BROWSERS)} is here")
    (tmp_path / "report.html").write_text(page.replace("</body>", PROBE + "</body>"), encoding="utf-8")
    options = ["--headless=new", "--no-sandbox", "--disable-gpu", "--host-resolver-rules=MAP * ~NOTFOUND"]
    options += [f"--user-data-dir={tmp_path / 'profile'}", f"--window-size={width},900"]
    options += ["--virtual-time-budget=20000", "--dump-dom", (tmp_path / "report.html").as_uri()]
    drawn = subprocess.run(
        [browser, *options], capture_output=True, text=True, timeout=120, check=True
    ).stdout
    seen = dict(re.findall(r'data-(\w+)="([^"]*)"', drawn.split("<head>", 1)[0]))
    assert seen["played"] == "3"
    assert seen["overflow"] == "0"
    assert seen["asked"] == "0"
    assert int(seen["words"]) > 100
    assert seen["ink"] == "rgb(34, 34, 34)"
