"""Real browsers of this machine, without a network: how each is started, told to be light, ended.

Firefox gets a screen of its own (Xvfb), since without one it has no WebGL.
"""

import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import urllib.request
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import IO

import pytest
from bidi import Bidi

NOWHERE = "127.0.0.1:9"  # a proxy where nobody listens: every request fails
WANTED = os.environ.get("RIBBONOPT_BROWSERS") == "on"  # a missing browser is a failure
NEEDED = {"chromium": ("chromium", "chromedriver"), "firefox": ("firefox-esr", "Xvfb")}
FLAGS = (
    "--headless=new",
    "--no-sandbox",  # refused to root otherwise, as in containers
    "--disable-dev-shm-usage",
    "--use-angle=swiftshader",  # WebGL without a graphics card
    "--enable-unsafe-swiftshader",
    "--force-device-scale-factor=1",
    f"--proxy-server={NOWHERE}",
)
PREFERENCES = {
    "browser.shell.checkDefaultBrowser": False,
    "browser.aboutwelcome.enabled": False,
    "datareporting.policy.dataSubmissionEnabled": False,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
    "network.proxy.type": 1,
    "network.proxy.http": "127.0.0.1",
    "network.proxy.http_port": 9,
    "network.proxy.ssl": "127.0.0.1",
    "network.proxy.ssl_port": 9,
    "remote.log.truncate": False,
    "webgl.force-enabled": True,
    "widget.use-xdg-desktop-portal": False,
}


def require(name: str) -> None:
    """Skip, or fail where browsers are wanted, if a browser or what drives it is not there."""
    missing = [program for program in NEEDED[name] if not shutil.which(program)]
    if not missing and find_spec("websocket"):
        return
    said = f"no {' and no '.join(missing)}: scripts/browsers installs them"
    if not missing:
        said = "no websocket-client: the extra `test` has it"
    if WANTED:
        pytest.fail(said)
    pytest.skip(said)


@contextlib.contextmanager
def started(name: str, folder: Path) -> Iterator[Bidi]:
    """Start a browser with an empty profile in a folder, and end it."""
    with contextlib.ExitStack() as stack:
        bidi = {"chromium": _chromium, "firefox": _firefox}[name](folder, stack)
        stack.callback(bidi.close)
        yield bidi


def _run(words: list[str], folder: Path, stack: contextlib.ExitStack) -> IO[bytes]:
    """Start a program, of which nothing is left at the end; return what it says."""
    home = {"HOME": str(folder), "XDG_RUNTIME_DIR": str(folder), "MOZ_ENABLE_WAYLAND": "0"}
    process = subprocess.Popen(
        words,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env=os.environ | home | _screen(folder),
        start_new_session=True,
    )

    def end() -> None:
        # A screen gives its number back; browsers would take seconds to say goodbye.
        gently = words[0] == "Xvfb"
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGTERM if gently else signal.SIGKILL)
        process.wait()
        if process.stdout:
            process.stdout.close()

    stack.callback(end)
    assert process.stdout
    return process.stdout


def _screen(folder: Path) -> dict[str, str]:
    place = folder / "screen"
    return {"DISPLAY": f":{place.read_text()}"} if place.exists() else {}


def _said(output: IO[bytes], pattern: str) -> str:
    """Return what a program says: the first group of a pattern in a line."""
    lines = []
    for line in output:
        lines.append(line.decode(errors="replace"))
        if found := re.search(pattern, lines[-1]):
            return found[1]
    raise RuntimeError("".join(lines)[-2000:])


def _chromium(folder: Path, stack: contextlib.ExitStack) -> Bidi:
    output = _run(["chromedriver", "--port=0"], folder, stack)
    port = _said(output, r"successfully on port (\d+)")
    flags = [*FLAGS, f"--user-data-dir={folder / 'profile'}"]
    asked = {"webSocketUrl": True, "goog:chromeOptions": {"args": flags}}
    body = json.dumps({"capabilities": {"alwaysMatch": asked}}).encode()
    request = urllib.request.Request(f"http://127.0.0.1:{port}/session", body)
    request.add_header("Content-Type", "application/json")
    direct = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    with direct.open(request, timeout=60) as answer:
        address = json.load(answer)["value"]["capabilities"]["webSocketUrl"]
    return Bidi(address)


def _firefox(folder: Path, stack: contextlib.ExitStack) -> Bidi:
    words = ["Xvfb", "-displayfd", "1", "-screen", "0", "2000x1600x24", "-nolisten", "tcp"]
    number = _said(_run(words, folder, stack), r"^(\d+)$")
    (folder / "screen").write_text(number)
    profile = folder / "profile"
    profile.mkdir()
    lines = [f"user_pref({json.dumps(k)}, {json.dumps(v)});" for k, v in PREFERENCES.items()]
    (profile / "user.js").write_text("\n".join(lines))
    words = ["firefox-esr", "--profile", str(profile), "--no-remote", "--remote-debugging-port=0"]
    address = _said(_run(words, folder, stack), r"BiDi listening on (ws://\S+)")
    bidi = Bidi(f"{address}/session")
    bidi.call("session.new", {"capabilities": {}})
    return bidi
