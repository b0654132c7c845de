"""``sphframe watch``: the page shows the state of a run and follows it."""

import http.client
import importlib.util
import io
import json
import shutil
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from urllib.request import urlopen

import matplotlib.image
import netCDF4
import pytest
from typer.testing import CliRunner

import sphframe
from sphframe.analysis.live import LiveRun, Look
from sphframe.cli.app import app
from sphframe.cli.watch import WatchServer
from sphframe.errors import InputError
from sphframe.output.schema import RunStatus

browser = importlib.util.module_from_spec(
    spec := importlib.util.spec_from_file_location(  # type: ignore[arg-type]
        "sphframe_browser", Path(__file__).parents[1] / "studies" / "browser.py"
    )
)
spec.loader.exec_module(browser)  # type: ignore[union-attr]

TANK = {"particle_spacing": 0.03, "until": 0.02, "frame_interval": 0.01, "courant_number": 0.3}


class Looker:
    """A hook plugin that looks at the running run at every frame."""

    def __init__(self, path: Path) -> None:
        self.path, self.looks = path, list[Look]()

    @sphframe.hookimpl
    def sphframe_frame_due(self) -> None:
        self.looks.append(LiveRun(self.path).look())


@pytest.fixture(scope="module")
def watched(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Look]]:
    path = tmp_path_factory.mktemp("watch") / "tank.nc"
    looker = Looker(path)
    sphframe.run("hydrostatic-tank", output=path, threads=1, hooks=[looker], **TANK).dataset.close()
    return path, looker.looks


@pytest.fixture
def run_file(watched: tuple[Path, list[Look]], tmp_path: Path) -> Path:
    return Path(shutil.copy(watched[0], tmp_path / "tank.nc"))


@pytest.fixture
def server(run_file: Path) -> Iterator[WatchServer]:
    with WatchServer(LiveRun(run_file, field="speed"), 0) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        yield server
        server.shutdown()
        thread.join()


def mark(path: Path, status: RunStatus, message: str = "") -> None:
    with netCDF4.Dataset(path, "r+") as file:
        file.set_auto_chartostring(False)
        file["run_status"][...] = int(status)
        file["run_message"][: len(message)] = list(message)


def get(server: WatchServer, path: str) -> tuple[str, bytes]:
    with urlopen(server.address + path) as answer:
        return answer.headers["Content-Type"], answer.read()


def test_a_run_is_shown_while_it_is_running(watched: tuple[Path, list[Look]]) -> None:
    first, second, last = watched[1]
    assert [look.status for look in (first, second, last)] == ["running"] * 3
    assert first.facts["time"].startswith("0 of 0.02 s (0 %), step 0")
    assert second.facts["time"].startswith("0.01")
    assert "2 frames" in second.facts["time"]
    assert "steps/s" in second.facts["rate"]
    assert "s left" in second.facts["rate"]
    assert second.facts["warnings"] == "none"
    assert first.picture != second.picture != last.picture
    end = LiveRun(watched[0]).look()
    assert (end.status, end.message) == ("completed", "")
    assert end.facts["time"].startswith("0.02 of 0.02 s (100 %)")
    assert "left" not in end.facts["rate"]


def test_only_what_has_changed_is_drawn_again(run_file: Path) -> None:
    run = LiveRun(run_file)
    assert [run.look().drawn, run.look().drawn] == [1, 1]
    mark(run_file, RunStatus.FAILED, "the particles have left")
    stopped = run.look()
    assert (stopped.status, stopped.message, stopped.drawn) == ("stopped", "the particles have left", 2)


def test_a_run_that_writes_nothing_for_long_is_reported(run_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mark(run_file, RunStatus.RUNNING)
    now = time.time()
    monkeypatch.setattr("sphframe.analysis.live.time.time", lambda: now + 3600.0)
    assert "sphframe resume tank.nc" in LiveRun(run_file).look().message


def test_warnings_are_shown(run_file: Path) -> None:
    with netCDF4.Dataset(run_file, "r+") as file:
        file["particles_outside"][1] = 7
    assert LiveRun(run_file).look().facts["warnings"] == "7 particles behind walls"


def test_the_last_picture_of_a_deleted_file_stays(run_file: Path) -> None:
    run = LiveRun(run_file)
    seen = run.look()
    run_file.write_bytes(run_file.read_bytes()[:3000])
    damaged = run.look()
    run_file.unlink()
    gone = run.look()
    for look in (damaged, gone):
        assert look.status == "unreadable"
        assert run_file.name in look.message
        assert look.picture == seen.picture


def test_what_cannot_be_watched(run_file: Path, server: WatchServer) -> None:
    with pytest.raises(InputError, match="does not exist"):
        LiveRun(run_file.with_name("other.nc"))
    with pytest.raises(InputError, match="no field 'colour'"):
        LiveRun(run_file, field="colour")
    taken = CliRunner().invoke(app, ["watch", str(run_file), "--port", str(server.server_port), "--no-open"])
    assert taken.exit_code == 2
    assert f"port {server.server_port} is taken by another program; give another --port" in taken.stderr


def test_what_the_server_answers(server: WatchServer) -> None:
    kind, page = get(server, "")
    assert kind == "text/html; charset=utf-8"
    assert not {"link", "iframe", "object"} & browser.Page(page.decode()).elements
    kind, state = get(server, "state.json")
    look = json.loads(state)
    assert (kind, look["file"], look["status"], look["drawn"]) == ("application/json", "tank.nc", "completed", 1)
    kind, picture = get(server, "picture.png?1")
    assert kind == "image/png"
    assert matplotlib.image.imread(io.BytesIO(picture), format="png").shape[1] == 630


@pytest.mark.parametrize(
    ("path", "host", "status"), [("/picture.png", None, 404), ("/other", None, 404), ("/", "elsewhere.example", 403)]
)
def test_what_the_server_refuses(server: WatchServer, path: str, host: str | None, status: int) -> None:
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port)
    connection.request("GET", path, headers={"Host": host} if host else {})
    assert connection.getresponse().status == status
    connection.close()


def test_ctrl_c_ends_the_page(run_file: Path) -> None:
    command = [sys.executable, "-m", "sphframe", "watch", str(run_file), "--port", "0", "--no-open"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert "is shown at http://127.0.0.1:" in process.stdout.readline()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate()
    assert (process.returncode, errors) == (0, "")


@pytest.mark.skipif(browser.browser() is None, reason="no Chromium with playwright; the page is parsed instead")
def test_a_browser_follows_the_run(run_file: Path, server: WatchServer) -> None:
    from playwright.sync_api import sync_playwright

    mark(run_file, RunStatus.RUNNING)
    errors: list[str] = []
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=browser.browser(), args=["--no-sandbox"])
        page = chromium.new_page()
        page.set_default_timeout(0.0)  # none
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(server.address)
        page.wait_for_function("document.getElementById('picture').naturalWidth == 1500")
        assert page.title() == "running: tank.nc"
        assert "improved-shepard, balanced lift" in page.inner_text("#facts")
        assert not page.is_visible("#message")
        mark(run_file, RunStatus.FAILED, "<b>gone</b>")
        page.wait_for_function("document.title == 'stopped: tank.nc'")
        assert page.inner_text("#message") == "<b>gone</b>"
        server.shutdown()
        server.server_close()
        page.wait_for_function("document.getElementById('message').textContent.includes('has ended')")
        assert page.is_visible("#picture")
        chromium.close()
    assert not errors


def test_silent_clients_are_dropped_and_many_are_served(
    server: WatchServer, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(server.RequestHandlerClass, "timeout", 0.2)
    silent = [socket.create_connection(("127.0.0.1", server.server_port)) for _ in range(60)]
    for one in silent[:30]:  # a reset in place of a farewell
        one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        one.close()
    for one in silent[30:]:
        one.settimeout(20.0)
        assert one.recv(1) == b"", "it is closed"
        one.close()
    assert get(server, "state.json")[0] == "application/json"
    assert server.request_queue_size >= 100
    assert "Traceback" not in capfd.readouterr().err
