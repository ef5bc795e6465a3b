"""Bandsaw in Python: renders scenes on a farm, from scripts and notebooks.

    import bandsaw
    farm = bandsaw.Farm("bsw1-f-…")                      # the users' join string, or a file with it
    image = farm.render("scene.gltf", samples=64)        # blocks; image.save("picture.png")

    job = farm.submit("scene.textproto", error=0.02)     # returns at once
    for progress in job.progress():                      # about twice a second until the job is over
        print(progress)
    image = job.image()

This one file needs Python 3.8 or later and its standard library. With numpy, `Image.array()` is an
array, and images are converted faster. The farm's coordinator must run its dashboard
(`bandsaw serve --web 0.0.0.0:8787`), because this module sends HTTP requests to the dashboard.
"""

import array
import base64
import binascii
import hashlib
import http.client
import json
import math
import os
import re
import socket
import ssl
import struct
import sys
import time
import urllib.parse
import zlib

try:
    import numpy
except ImportError:
    numpy = None

__all__ = ["BandsawError", "Farm", "Image", "Job", "NoFarm", "Progress", "WrongString", "compare", "image_from_pfm"]

DEFAULT_WEB_PORT = 8787  # of the coordinator's dashboard, as in `bandsaw serve`
OVER = ("done", "failed", "cancelled")  # the final states of a job


class BandsawError(Exception):
    """An error whose message is one sentence for the user."""


class WrongString(BandsawError):
    """The text is no join string, or the farm refuses it."""


class NoFarm(BandsawError):
    """No coordinator answers at the farm's addresses, or another program answers there."""


class Refused(BandsawError):
    """The coordinator answered with an error. `status`: the HTTP status."""

    def __init__(self, status, message):
        super().__init__(message)
        self.status = status


class JoinString:
    """The parts of a users' join string. proto/link/join.h describes its form.

    `addresses`: a list of (host, port) of the farm's gRPC server. `web`: (host, port) of the dashboard; host is None if
    the string names only a port, and `web` is None if the string does not name the dashboard. `certificate`: SHA-256,
    32 bytes; None: the farm runs with --insecure. `secret`: a text."""

    def __init__(self, text):
        rest = text.strip()
        if rest.startswith("bsw1-w-"):
            raise WrongString("this is the workers' join string; the users' one is in the file `farm` of the coordinator's data folder")
        if not rest.startswith("bsw1-f-"):
            raise WrongString("the farm's string must begin with bsw1-f-; it is in the file `farm` of the coordinator's data folder")
        match = re.fullmatch(r"bsw1-f-(.+?)-(plain|[A-Za-z0-9_-]{43})-([A-Za-z0-9_-]{22})", rest)
        if match is None:
            raise WrongString("the farm's string is incomplete; was it cut off?")
        places, digest, self.secret = match.groups()
        self.certificate = None if digest == "plain" else base64.urlsafe_b64decode(digest + "=")
        places, _, web = places.partition("+")
        self.addresses = [_host_and_port(place) for place in places.split(",")]
        self.web = None
        if web:
            self.web = (None, _port(web)) if ":" not in web else _host_and_port(web)


def _port(text):
    if not text.isdigit() or not 1 <= int(text) <= 65535:
        raise WrongString("a port in the farm's string is not a number from 1 to 65535")
    return int(text)


def _host_and_port(text):
    host, colon, port = text.rpartition(":")
    if not colon or not host:
        raise WrongString("an address in the farm's string is not HOST:PORT")
    return host.strip("[]"), _port(port)


def _is_loopback(host):
    return host in ("localhost", "::1") or re.fullmatch(r"127\.[0-9.]+", host) is not None  # not a name such as 127.example.org


class _PinnedConnection(http.client.HTTPSConnection):
    """HTTPS to the holder of one certificate. The certificate's SHA-256 is compared with `digest`
    before anything is sent."""

    def __init__(self, host, port, timeout, digest):
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname = False
        context.verify_mode = ssl.CERT_NONE  # the digest of the certificate is checked instead
        super().__init__(host, port, timeout=timeout, context=context)
        self._digest = digest

    def connect(self):
        super().connect()
        found = hashlib.sha256(self.sock.getpeercert(binary_form=True)).digest()
        if found != self._digest:
            self.close()
            raise NoFarm("it is another farm: its certificate is not the one that the farm's string names")


class Farm:
    """A farm of Bandsaw. `join`: the users' join string, or the name of a file that contains it.
    `web`: "HOST:PORT" of the dashboard; None: as the string says. `timeout`: the seconds after
    which one wait for the coordinator fails. No connection is made before the first request."""

    def __init__(self, join, web=None, timeout=20.0):
        if not join.lstrip().startswith("bsw1-") and os.path.isfile(join):
            with open(join, encoding="utf-8") as file:
                join = file.read()
        self._join = JoinString(join)
        self._timeout = timeout
        if web is not None:
            self._addresses = [_host_and_port(web)]
        elif self._join.web is not None and self._join.web[0] is not None:
            self._addresses = [self._join.web]
        else:
            port = self._join.web[1] if self._join.web else DEFAULT_WEB_PORT
            self._addresses = [(host, port) for host, _ in self._join.addresses]

    def __repr__(self):
        host, port = self._addresses[0]
        return f"<bandsaw.Farm {host}:{port}>"

    # ---- requests ----

    def _connect(self, address, timeout):
        """Returns an open connection to `address`, a pair (host, port), over which nothing was sent.
        `timeout`: seconds. Uses plain HTTP if the farm has no certificate. Otherwise uses TLS for an
        address that is not on loopback, and plain HTTP for a loopback address that the join string
        names as the dashboard's. Any other loopback address may be the end of a tunnel to a
        dashboard with or without TLS, so TLS is tried first, then plain HTTP. Raises OSError if the
        connection fails, NoFarm if the certificate is that of another farm."""
        host, port = address
        loopback = _is_loopback(host)
        if self._join.certificate is not None and not (loopback and address == self._join.web):
            pinned = _PinnedConnection(host, port, timeout, self._join.certificate)
            try:
                pinned.connect()
                return pinned
            except ssl.SSLError:
                if not loopback:
                    raise
        plain = http.client.HTTPConnection(host, port, timeout=timeout)
        plain.connect()
        return plain

    # Sends one request to one address. Returns the HTTP status and the body of the answer.
    # Parameters as request().
    def _send(self, address, method, path, body, headers, timeout):
        connection = self._connect(address, self._timeout if timeout is None else timeout)
        try:
            try:
                connection.request(method, path, body=body() if callable(body) else body, headers=headers)
            except (ConnectionError, ssl.SSLError):
                reply = _early_reply(connection)
                if reply is None:
                    raise
            else:
                reply = connection.getresponse()
            return reply.status, reply.read()
        finally:
            connection.close()

    def request(self, method, path, body=None, length=None, timeout=None):
        """Returns the body of the answer. `body`: bytes, or a function that returns an iterable of
        bytes of `length` bytes in all. Raises NoFarm, WrongString or Refused."""
        headers = {"Authorization": "Bearer " + self._join.secret, "X-Bandsaw": "1"}
        if length is not None:
            headers["Content-Length"] = str(length)
        troubles = []
        for address in list(self._addresses):
            try:
                status, answer = self._send(address, method, path, body, headers, timeout)
                refusal = _refusal(status, answer)
            except (NoFarm, OSError, http.client.HTTPException) as error:
                troubles.append(f"{address[0]}:{address[1]}: {_reason(error)}")
                continue
            self._addresses.remove(address)
            self._addresses.insert(0, address)  # the next request goes first to this address
            if refusal is not None:
                raise refusal
            return answer
        raise NoFarm(
            "no coordinator answers (" + "; ".join(troubles) + "). Is `bandsaw serve` running there, with "
            f"--web 0.0.0.0:{self._addresses[0][1]} if it is another machine?")

    def request_json(self, method, path, message=None):
        """Sends `message`, a dictionary or None, as JSON; returns the answer as a dictionary.
        Raises the errors of request()."""
        body = None if message is None else json.dumps(message).encode()
        if body is None and method == "POST":
            body = b"{}"
        return json.loads(self.request(method, path, body) or b"{}")

    # ---- the farm ----

    def check(self):
        """Returns the farm's version, if the farm answers and accepts its string. Raises
        WrongString, NoFarm or Refused."""
        return self.request_json("GET", "/api/farm").get("version", "")

    def workers(self):
        """Returns a dictionary for each worker: name, state, threads, …"""
        return self.request_json("GET", "/api/farm").get("worker", [])

    def jobs(self):
        """Returns the farm's jobs, newest first."""
        return [Job(self, int(job["status"]["job"])) for job in self.request_json("GET", "/api/farm").get("job", [])]

    def job(self, number):
        return Job(self, int(number))

    def submit(self, scene, samples=None, error=None, seconds=None, width=None, name=None, files=None, title=None, on_progress=None):
        """Submits a scene and returns its Job. `scene`: the name of a scene or model file; files that it refers to are
        sent too. If `files` is given, `scene` is the text of a scene file, `name` is that file's name (default
        scene.textproto), and `files` is a dictionary from the names that the text uses to bytes or paths. `title`: the
        job's name. One of `samples` (a pixel), `error` (0.02: two percent) or `seconds` ends the job; default 64 samples.
        `width`: pixels, default the scene's own. `on_progress`: a function of (bytes sent, bytes in all). Files that the
        farm has are not sent again."""
        if files is None:
            main, files = _files_of(scene)
        else:
            main = name or "scene.textproto"
            files = dict(files)
            files[main] = scene.encode() if isinstance(scene, str) else scene
        digests = {file: _digest(content) for file, content in files.items()}
        wanted = {"width": width, "samples": samples, "error": error, "time": seconds, "title": title}
        path = "/api/scenes/files?" + urllib.parse.urlencode({key: value for key, value in wanted.items() if value is not None})
        message = {"scene": main, "file": [{"name": file, "sha256": digest} for file, digest in sorted(digests.items())]}
        for again in range(60, -1, -1):
            self._send_missing(files, digests, on_progress)
            try:
                answer = json.loads(self.request("POST", path, json.dumps(message).encode(), timeout=600))
                return Job(self, int(answer["job"]), answer.get("warning", []))
            except Refused as refused:
                # 409: the coordinator has just removed an unused file; 503: it is reading other scenes. 429, a full disk, is not tried again.
                if refused.status not in (409, 503) or again == 0:
                    raise
                time.sleep(0.5)
        raise AssertionError

    def render(self, scene, on_progress=None, denoise=False, **wanted):
        """Renders a scene and returns its Image, without its noise if `denoise` is True (Job.clean). Arguments as those of submit;
        `on_progress`: a function of Progress."""
        job = self.submit(scene, **wanted)
        try:
            for progress in job.progress():
                if on_progress is not None:
                    on_progress(progress)
        except KeyboardInterrupt:
            job.cancel()
            raise
        return job.clean() if denoise else job.image()

    # Sends the files that the farm does not have. `files`: from names to bytes or paths; `digests`: from
    # names to SHA-256; `on_progress`: as for submit().
    def _send_missing(self, files, digests, on_progress):
        by_digest = {digest: files[file] for file, digest in digests.items()}
        missing = self.request_json("POST", "/api/files/missing", {"sha256": sorted(by_digest)}).get("sha256", [])
        if not missing:
            return
        sizes = {digest: _size(by_digest[digest]) for digest in missing}
        heads = {digest: f"{digest} {sizes[digest]}\n".encode() for digest in missing}
        total = sum(sizes.values()) + sum(map(len, heads.values()))

        def parts():
            sent = 0
            for digest in missing:
                yield heads[digest]
                for piece in _pieces(by_digest[digest]):
                    yield piece
                    sent += len(piece)
                    if on_progress is not None:
                        on_progress(sent, total)

        # The coordinator gives a body one second for each 32 KiB.
        self.request("POST", "/api/files", parts, total, timeout=max(60.0, total / 32768))


def _early_reply(connection):
    """Returns the answer of a coordinator that refused a request before its whole body was sent, and closed the connection;
    None if it sent no answer."""
    try:
        return connection.getresponse()
    except (OSError, http.client.HTTPException):
        return None


# Returns the reason of a connection's error in a few words.
def _reason(error):
    if isinstance(error, socket.timeout):
        return "no answer in time"
    if isinstance(error, ConnectionRefusedError):
        return "nothing listens there"
    if isinstance(error, ssl.SSLError):
        return "no TLS there"
    return getattr(error, "strerror", None) or str(error) or type(error).__name__


def _refusal(status, answer):
    """Returns the error, WrongString or Refused, that a coordinator's answer stands for; None if the HTTP status is below 300. Raises
    NoFarm if the answer is not that of a coordinator."""
    if status < 300:
        return None
    try:
        message = json.loads(answer)["error"]
    except (ValueError, KeyError, TypeError):
        raise NoFarm(f"what answers there is not a Bandsaw coordinator of this version (HTTP status {status})") from None
    if status == 401:
        return WrongString("the farm refuses this string: its secret is wrong or was rotated (" + message + ")")
    return Refused(status, message)


# ---- files of a scene ----

_REFERENCES = {
    # The key is the suffix of a file. The pattern finds the texts in that file that may name
    # another file.
    ".obj": rb"^\s*mtllib\s+(.+?)\s*$",
    ".mtl": rb"^\s*(?:map_\w+|bump|norm|disp|refl|decal)\s+(.+?)\s*$",  # options, then the name
    ".dae": rb"<init_from>\s*([^<]+?)\s*</init_from>",
    ".textproto": rb'"([^"\n]+)"', ".json": rb'"([^"\n]+)"', ".gltf": rb'"uri"\s*:\s*"([^"\n]+)"',
    ".pbrt": rb'"([^"\n]+)"', ".xml": rb'"([^"\n]+)"',
}
# In these files, text or binary, a picture's name begins after a control character or a quote. The
# pattern begins only there, because a pattern that may begin at every byte would make the search
# slow.
_REFERENCES[".fbx"] = _REFERENCES[".3ds"] = (
    rb'(?i)(?<![^\x00-\x1f"])([^\x00-\x1f"]+?\.(?:png|jpe?g|tga|bmp|tiff?|exr|hdr|webp|dds|gif))')
_ALSO_QUOTED = {".textproto": rb"'([^'\n]+)'"}  # a second pattern, for names in single quotes
_SCENES = (".textproto", ".json", ".pbrt", ".xml")  # scene files; files with other suffixes belong to models
# In scenes of these formats, an included file names files relative to the scene's folder. The folder of the included file is tried too.
_NAMES_FROM_THE_TOP = (".pbrt", ".xml")


def _files_of(scene):
    """Finds the scene file and all files that it refers to, directly or through other files. Returns
    the name of the scene file, and a dictionary that has the path of each file under its name. Names
    are relative to the folder of the scene file."""
    if not os.path.isfile(scene):
        raise BandsawError(f"there is no scene {scene}")
    folder, main = os.path.split(os.path.abspath(scene))
    files, waiting = {}, [main]
    while waiting:
        name = waiting.pop()
        if name in files:
            continue
        path = os.path.join(folder, *name.split("/"))
        files[name] = path
        suffix = os.path.splitext(name)[1].lower()
        for pattern in filter(None, (_REFERENCES.get(suffix), _ALSO_QUOTED.get(suffix))):
            with open(path, "rb") as file:
                text = file.read()
            own = os.path.dirname(name)
            for found in re.findall(pattern, text, re.MULTILINE):
                for beside in {own, ""} if suffix in _NAMES_FROM_THE_TOP else {own}:
                    waiting.extend(_below(folder, beside, found, suffix not in _SCENES))
    return main, files


def _below(folder, beside, found, or_last_part):
    """Returns a list with the name, relative to `folder`, of the file that the bytes `found` name;
    an empty list if there is no such file below `folder`. `beside`: the folder of the file that
    contains `found`, relative to `folder`. `or_last_part`: if there is no file of that name, a file
    in `beside` with the last part of the name is taken, because models may name pictures by their
    paths on another machine."""
    try:
        text = found.decode("utf-8")
    except UnicodeDecodeError:
        return []
    words = text.split(" ")
    rests = [" ".join(words[at:]) for at in range(len(words))]  # what precedes a name may be options
    spellings = [text, urllib.parse.unquote(text)] + rests
    if or_last_part:
        spellings += [re.split(r"[/\\]", spelled)[-1] for spelled in spellings[:2]]
    for spelled in spellings:
        name = os.path.normpath(os.path.join(beside, spelled.replace("\\", "/"))).replace(os.sep, "/")
        if not name.startswith(("../", "/")) and "\0" not in name and os.path.isfile(os.path.join(folder, name)):
            return [name]
    return []


# Returns the size of a file in bytes. `content`: the file's bytes or its path.
def _size(content):
    return len(content) if isinstance(content, (bytes, bytearray, memoryview)) else os.path.getsize(content)


# Yields the bytes of a file in pieces of at most `size` bytes. `content`: as for _size().
def _pieces(content, size=1 << 20):
    if isinstance(content, (bytes, bytearray, memoryview)):
        view = memoryview(content)
        for at in range(0, len(view), size):
            yield view[at:at + size]
        return
    with open(content, "rb") as file:
        for piece in iter(lambda: file.read(size), b""):
            yield piece


def _digest(content):
    digest = hashlib.sha256()
    for piece in _pieces(content):
        digest.update(piece)
    return digest.hexdigest()


# ---- jobs ----


class Progress:
    """The state of a job: `state` ("running", "paused", "finishing", "done", "failed",
    "cancelled"), `reason`, `fraction` (0 to 1), `elapsed`, `remaining` (seconds; None: not known),
    `samples` (a pixel), `samples_done` (of all pixels together), `error` (a fraction; None: not
    known), `workers` (names), `width`, `height`, `warnings` of the import. Job.progress() also uses
    the state "lost"."""

    def __init__(self, status, warnings):
        self.state = status.get("state", "").replace("JOB_STATE_", "").lower()
        self.reason = status.get("reason", "")
        self.fraction = float(status.get("fraction", 0))
        self.elapsed = float(status.get("elapsed_s", 0))
        self.remaining = _known(status.get("remaining_s", 0))
        self.samples = int(status.get("samples_per_pixel", 0))
        self.samples_done = int(status.get("samples_done", 0))
        self.error = _known(status.get("error", 0))
        self.workers = [worker["name"] for worker in status.get("worker", [])]
        settings = status.get("settings", {})
        self.width, self.height = int(settings.get("width", 0)), int(settings.get("height", 0))
        self.warnings = warnings

    @property
    def over(self):
        return self.state in OVER

    def __str__(self):
        parts = [self.state, f"{100 * self.fraction:.0f} %"]
        if self.samples:
            parts.append(f"{self.samples} samples")
        if self.error is not None and self.error > 0:
            parts.append(f"error {100 * self.error:.2g} %")
        if not self.over and self.remaining is not None and self.fraction > 0:
            parts.append(f"{_duration(self.remaining)} left")
        if not self.over:
            count = len(self.workers)
            parts.append(f"{count} worker" + ("" if count == 1 else "s"))
        return " · ".join(parts) + (f" ({self.reason})" if self.reason else "")


# Returns a number of the coordinator. The coordinator's negative numbers mean "unknown" and become
# None.
def _known(number):
    number = float(number)
    return None if number < 0 or not math.isfinite(number) else number


def _duration(seconds):
    seconds = int(seconds + 0.5)
    if seconds < 60:
        return f"{seconds} s"
    if seconds < 3600:
        return f"{seconds // 60}:{seconds % 60:02d} min"
    return f"{seconds // 3600}:{seconds // 60 % 60:02d} h"


class Job:
    """A job of a farm. `number`: the job's number on the farm; `warnings`: sentences that name the
    things that the import of the scene left out."""

    def __init__(self, farm, number, warnings=()):
        self.farm, self.number, self.warnings = farm, number, list(warnings)

    def __repr__(self):
        return f"<bandsaw.Job {self.number}>"

    def _path(self, rest=""):
        return f"/api/jobs/{self.number}{rest}"

    def status(self):
        """Returns the job's Progress now."""
        return Progress(self.farm.request_json("GET", self._path())["job"]["status"], self.warnings)

    def why(self):
        """Returns the reasons why the job is not done, in sentences."""
        return self.farm.request_json("GET", self._path()).get("why", [])

    def progress(self, interval=0.5, patience=60.0, stop=None):
        """Yields a Progress about every `interval` seconds until the job is over. While the coordinator cannot be
        reached, progress() tries again for `patience` seconds and yields a Progress with the state "lost", then raises
        NoFarm. Raises BandsawError if the job failed or was cancelled. `stop`: a function that is called often. The
        iteration ends when `stop` returns True."""
        loss, last = _Loss(patience), None
        while stop is None or not stop():
            try:
                last = self.status()
                loss.over()
            except NoFarm as error:
                if last is None or loss.is_too_long():
                    raise
                last.state, last.reason = "lost", str(error)
            yield last
            if last.state in ("failed", "cancelled"):
                raise BandsawError(f"job {self.number} {'has failed' if last.state == 'failed' else 'was cancelled'}"
                                   + (": " + last.reason if last.reason else ""))
            if last.state == "done":
                return
            _wait(interval, stop)

    def frames(self):
        """Returns the frames of a job that was submitted with --frames: a list of (number, state, Job or None, reason); state is expected,
        waiting, rendering, done or failed. The Job of a frame has its image."""
        return [(int(frame["frame"]), frame["state"].replace("FRAME_STATE_", "").lower(),
                 Job(self.farm, int(frame["job"])) if int(frame["job"]) else None, frame["reason"])
                for frame in self.farm.request_json("GET", self._path("/frames")).get("frame", [])]

    def preview(self, side=2048):
        """Returns the present state as an Image of at most about `side` pixels a side; None: no pixels yet."""
        try:
            return image_from_pfm(self.farm.request("GET", self._path(f"/preview.pfm?side={side}")))
        except Refused as error:
            if error.status == 404:
                return None
            raise

    def image(self):
        """Returns the finished image with its exact values: linear light, 32-bit floats."""
        return image_from_pfm(self.farm.request("GET", self._path("/image.pfm"), timeout=120))

    def clean(self, on_state=None, interval=0.3, patience=60.0, stop=None):
        """Returns the finished image without its noise (denoised), an Image. The farm renders the guides that the denoiser needs (images of the
        albedo and the shape of the surfaces), then the coordinator filters the image. image() still returns the image as rendered.

        `on_state`: a function of the dictionary that clean_state() returns, called about every `interval` seconds. In its last call, the
        dictionary has the errors. `stop`: a function that is called often. Soon after `stop` has returned True, clean() returns None. While the
        coordinator cannot be reached, clean() tries again for `patience` seconds, then raises NoFarm. Raises Refused if the job is not done, or
        if its image cannot be cleaned or is too large. Raises BandsawError if the cleaning fails."""
        loss = _Loss(patience)
        while stop is None or not stop():
            try:
                state = self.clean_state()
                if state["state"] == "none":  # not requested, or the coordinator does not keep it any more
                    self.farm.request_json("POST", self._path("/clean"))
                loss.over()
                if on_state is not None:
                    on_state(state)
                if state["state"] == "ready":
                    return image_from_pfm(self.farm.request("GET", self._path("/clean.pfm"), timeout=120))
                if state["state"] == "failed":
                    raise BandsawError(f"the image of job {self.number} was not denoised: {state['reason']}")
            except NoFarm:
                if loss.is_too_long():
                    raise
            _wait(interval, stop)
        return None

    def clean_state(self):
        """Returns the state of the clean (denoised) image as a dictionary. `state` is "none" (the image was not requested), "guides" (the farm
        renders the guides, see clean()), "filtering", "ready" or "failed". `fraction` is the fraction of the guides that is rendered (0 to 1).
        `reason` says why the cleaning failed. The other values are known when the image is ready. `error_raw` is the estimated error of the
        image as rendered, and `error_clean` is that of the clean image; both are fractions (0.02: two percent). `bias_share` is the part
        of the squared `error_clean` that is bias."""
        message = self.farm.request_json("GET", self._path("/clean"))
        return {"state": message.get("state", "none"), "fraction": float(message.get("fraction", 0)), "reason": message.get("reason", ""),
                "error_raw": float(message.get("relative_rmse_raw", 0)), "error_clean": float(message.get("relative_rmse_clean", 0)),
                "bias_share": float(message.get("bias_share", 0))}

    def report(self):
        """Returns the report that `bandsaw submit` writes, as a dictionary."""
        return json.loads(self.farm.request("GET", self._path("/report.json")))

    def layer(self, kind, samples=16):
        """Submits a job for another picture of the same scene: "albedo", "normals" or "depth". Returns its Job."""
        query = urllib.parse.urlencode({"kind": kind, "samples": samples})
        return Job(self.farm, int(self.farm.request_json("POST", self._path("/layer?" + query))["job"]))

    def cancel(self):
        self.farm.request_json("POST", self._path("/cancel"))

    def _repr_png_(self):
        picture = self.preview()
        return picture.png() if picture is not None else None

    def show(self, interval=1.0):
        """In a notebook: shows the picture and the progress while it forms, until the job is over; returns the Image."""
        from IPython.display import display  # only notebooks have it
        place = display(self, display_id=True)
        for progress in self.progress(interval):
            place.update(self if progress.state != "lost" else str(progress))
        picture = self.image()
        place.update(picture)
        return picture


class _Loss:
    """Measures for how long the coordinator cannot be reached. `patience`: the longest time in seconds."""

    def __init__(self, patience):
        self._patience, self._since = patience, None

    def over(self):
        self._since = None

    def is_too_long(self):
        """To be called after each request that was not answered."""
        now = time.monotonic()
        self._since = self._since or now
        return now - self._since > self._patience


# Waits until `seconds` have passed or stop() returns True.
def _wait(seconds, stop):
    end = time.monotonic() + seconds
    while time.monotonic() < end and (stop is None or not stop()):
        time.sleep(min(0.1, seconds))


# ---- images ----


class Image:
    """Linear light with sRGB primaries. `pixels`: 3 * width * height 32-bit floats, rows from the top: an array.array, or a
    numpy array if numpy is there."""

    def __init__(self, width, height, pixels):
        self.width, self.height, self.pixels = width, height, pixels

    def __repr__(self):
        return f"<bandsaw.Image {self.width} x {self.height}>"

    def array(self):
        """Returns a numpy array of shape (height, width, 3)."""
        if numpy is None:
            raise BandsawError("numpy is not installed here")
        return numpy.asarray(self.pixels, dtype=numpy.float32).reshape(self.height, self.width, 3)

    def mean(self):
        """Returns the mean of each channel."""
        count = self.width * self.height
        if numpy is not None:
            return tuple(float(x) for x in self.array().reshape(-1, 3).mean(axis=0, dtype=numpy.float64))
        return tuple(math.fsum(self.pixels[channel::3]) / count for channel in range(3))

    def bytes8(self):
        """Returns 8-bit sRGB, rows from the top."""
        if numpy is not None:
            x = numpy.clip(numpy.nan_to_num(self.array()), 0, 1)
            y = numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * numpy.power(x, 1 / 2.4) - 0.055)
            return (255 * y + 0.5).astype(numpy.uint8).tobytes()
        return bytes(_srgb8(x) for x in self.pixels)

    def png(self):
        """Returns the bytes of a PNG file."""
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", binascii.crc32(kind + data))
        rows, line = self.bytes8(), 3 * self.width
        raw = b"".join(b"\0" + rows[at:at + line] for at in range(0, len(rows), line))
        head = struct.pack(">IIBBBBB", self.width, self.height, 8, 2, 0, 0, 0)
        return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw, 6)) + chunk(b"IEND", b"")

    _repr_png_ = png

    def pfm(self):
        """Returns the bytes of a PFM file, which has the exact values."""
        head = f"PF\n{self.width} {self.height}\n-1.0\n".encode()
        if numpy is not None:
            return head + self.array()[::-1].astype("<f4").tobytes()
        line = 3 * self.width
        rows = [self.pixels[row * line:(row + 1) * line] for row in range(self.height)]
        if sys.byteorder == "big":
            for row in rows:
                row.byteswap()
        return head + b"".join(row.tobytes() for row in reversed(rows))

    def save(self, path):
        """Writes a .png (8-bit sRGB) or a .pfm (exact) file, whole or not at all."""
        suffix = os.path.splitext(path)[1].lower()
        if suffix not in (".png", ".pfm"):
            raise BandsawError(f"{path}: the name must end in .png or .pfm")
        data = self.png() if suffix == ".png" else self.pfm()
        part = path + ".part"
        with open(part, "wb") as file:
            file.write(data)
        os.replace(part, path)


def _srgb8(x):
    x = 0.0 if not x > 0 else min(x, 1.0)
    return int(255 * (12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055) + 0.5)


def image_from_pfm(data):
    """Returns the Image in the bytes of a PFM file with three channels."""
    match = re.match(rb"PF\s(\d+)\s(\d+)\s(\S+)\s", data)
    if match is None:
        raise BandsawError("not a PFM file with three channels")
    width, height, little = int(match[1]), int(match[2]), float(match[3]) < 0
    if len(data) - match.end() != 12 * width * height:
        raise BandsawError("the PFM file is incomplete")
    if numpy is not None:
        flat = numpy.frombuffer(data, "<f4" if little else ">f4", offset=match.end())
        return Image(width, height, flat.reshape(height, width, 3)[::-1].astype(numpy.float32))
    flat = array.array("f", data[match.end():])
    if little != (sys.byteorder == "little"):
        flat.byteswap()
    line, pixels = 3 * width, array.array("f")
    for row in reversed(range(height)):
        pixels.extend(flat[row * line:(row + 1) * line])
    return Image(width, height, pixels)


def compare(a, b):
    """Returns how two images of the same size differ, as a dictionary: `mean_a` and `mean_b` (means
    over all channels), `rmse`, `relative_rmse` (the rmse divided by `mean_b`), `largest` (the
    largest difference of two values) and `equal` (all values are equal)."""
    if (a.width, a.height) != (b.width, b.height):
        raise BandsawError(f"the images have different sizes: {a.width} x {a.height} and {b.width} x {b.height}")
    if numpy is not None:
        x, y = a.array().astype(numpy.float64), b.array().astype(numpy.float64)
        rmse, largest = float(numpy.sqrt(((x - y) ** 2).mean())), float(abs(x - y).max())
        equal = bool((a.array() == b.array()).all())
    else:
        differences = [x - y for x, y in zip(a.pixels, b.pixels)]
        rmse = math.sqrt(math.fsum(d * d for d in differences) / len(differences))
        largest, equal = max(map(abs, differences)), a.pixels == b.pixels
    mean_a, mean_b = sum(a.mean()) / 3, sum(b.mean()) / 3
    return {"mean_a": mean_a, "mean_b": mean_b, "rmse": rmse, "relative_rmse": rmse / mean_b if mean_b else math.inf,
            "largest": largest, "equal": equal}
