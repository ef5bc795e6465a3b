"""A coordinator for tests of its clients (the Python module, and the add-on for Blender). It answers the HTTP requests of proto/web.proto, but it
renders nothing: the pixels of its images are made up. `python3 fake_farm.py SECONDS` prints the string with which clients connect, and serves until
its standard input ends. SECONDS: the time that a job takes."""

import array
import hashlib
import http.server
import json
import re
import struct
import sys
import threading
import time
import urllib.parse

SECRET = "abcdefghijklmnopqrst-_"


class FakeFarm:
    """A job takes `seconds`. If `seconds` is 0, each request for the state of a job completes a quarter of the job. Tests may set four variables.
    `refusals`: the HTTP statuses with which the next scenes are refused. `full`: True if the disk of the coordinator is full, so that files are
    refused. `warnings`: the warnings in the answer to every accepted scene. `clean_failure`: the reason why denoising fails, or "" if it
    does not fail. `scenes`, `jobs` and `requests` hold all that the coordinator has received."""

    def __init__(self, seconds=0.0):
        self.seconds, self.refusals, self.warnings, self.full, self.clean_failure = seconds, [], [], False, ""
        self.files, self.scenes, self.jobs, self.requests = {}, [], {}, []
        self.lock = threading.Lock()
        farm = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                farm.answer(self, b"")

            def do_POST(self):
                if farm.full and self.path == "/api/files":
                    farm.answer(self, self.rfile.read(1))  # sends the answer and closes the connection before the rest of the body arrives
                else:
                    farm.answer(self, self.rfile.read(int(self.headers.get("Content-Length", 0))))

            def log_message(self, *ignored):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.port = self.server.server_address[1]
        self.string = f"bsw1-f-127.0.0.1:1+127.0.0.1:{self.port}-plain-{SECRET}"
        self.thread = threading.Thread(target=self.server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True)
        self.thread.start()

    def stop(self):
        self.server.shutdown()
        self.server.server_close()
        self.thread.join()

    # ---- requests ----

    def answer(self, request, body):
        path, _, query = request.path.partition("?")
        parameters = dict(urllib.parse.parse_qsl(query))
        with self.lock:
            self.requests.append((request.command, path))
            if request.headers.get("Authorization") != "Bearer " + SECRET:
                status, kind, data = self.problem(401, "the secret is wrong")
            elif request.command == "POST" and "X-Bandsaw" not in request.headers:
                status, kind, data = self.problem(403, "a POST needs the header X-Bandsaw")
            else:
                status, kind, data = self.route(request.command, path, parameters, body)
        request.send_response(status)
        request.send_header("Content-Type", kind)
        request.send_header("Content-Length", str(len(data)))
        request.end_headers()
        try:
            request.wfile.write(data)
        except OSError:
            pass  # the client has gone

    def problem(self, status, text):
        return status, "application/json", json.dumps({"error": text}).encode()

    def reply(self, message):
        return 200, "application/json", json.dumps(message).encode()

    def route(self, method, path, parameters, body):
        if path == "/api/farm":
            return self.reply({"version": "fake", "job": [{"status": {"job": str(n)}} for n in self.jobs], "worker": [{"name": "desk", "state": "idle"}]})
        if path == "/api/files/missing":
            return self.reply({"sha256": [one for one in json.loads(body)["sha256"] if one not in self.files]})
        if path == "/api/files":
            return self.take_files(body)
        if path == "/api/scenes/files":
            return self.take_scene(parameters, json.loads(body))
        match = re.fullmatch(r"/api/jobs/(\d+)(?:/(.*))?", path)
        job = self.jobs.get(int(match[1])) if match else None
        if job is None:
            return self.problem(404, "there is nothing here")
        return self.job(job, method, match[2] or "", parameters)

    def take_files(self, body):
        if self.full:
            return self.problem(429, "the disk is full")
        taken = []
        while body:
            head, body = body.split(b"\n", 1)
            digest, size = head.decode().split(" ")
            content, body = body[:int(size)], body[int(size):]
            if hashlib.sha256(content).hexdigest() != digest:
                return self.problem(400, "the digest differs")
            self.files[digest] = content
            taken.append(digest)
        return self.reply({"sha256": taken})

    def take_scene(self, parameters, message):
        if self.refusals:
            status = self.refusals.pop(0)
            if status == 409:  # a file of the scene is not there any more
                self.files.clear()
            return self.problem(status, "not now")
        files = {file["name"]: self.files[file["sha256"]] for file in message["file"]}
        self.scenes.append({"files": files, "main": message["scene"], **parameters})
        width, height = 64, 48
        if message["scene"].endswith(".json"):
            image = json.loads(files[message["scene"]]).get("image", {})
            width, height = image.get("width", width), image.get("height", height)
        return self.reply({"job": str(self.add(width, height, "path")), "warning": self.warnings})

    def add(self, width, height, kind):
        number = len(self.jobs) + 1
        self.jobs[number] = {"number": number, "width": width, "height": height, "kind": kind, "state": "running", "looks": 0, "began": time.monotonic()}
        return number

    # ---- jobs ----

    def fraction(self, job):
        """Returns the finished share of a job. "looks" is the number of requests for the state of the job."""
        if self.seconds == 0 or job["kind"] != "path":
            return min(job["looks"] / 4, 1.0)
        return min((time.monotonic() - job["began"]) / self.seconds, 1.0)

    def job(self, job, method, what, parameters):
        if what == "":
            job["looks"] += 1
            if job["state"] == "running" and self.fraction(job) >= 1:
                job["state"] = "done"
            share, running = self.fraction(job), job["state"] == "running"
            status = {"job": str(job["number"]), "state": "JOB_STATE_" + job["state"].upper(), "fraction": share, "remaining_s": 4 * (1 - share), "error": 0.05,
                      "samples_done": str(int(share * 64 * job["width"] * job["height"])), "samples_per_pixel": str(int(64 * share)),
                      "settings": {"width": job["width"], "height": job["height"]}, "worker": [{"name": "desk"}] if running else []}
            return self.reply({"job": {"status": status}, "why": []})
        if what == "cancel":
            job["state"] = "cancelled"
            return self.reply({"status": {}})
        if what == "layer":
            return self.reply({"job": str(self.add(job["width"], job["height"], parameters["kind"]))})
        if what == "clean":
            return self.clean(job, method)
        share = self.fraction(job)
        if what == "clean.pfm" and job.get("clean", 0) > 2:
            return 200, "image/x-portable-floatmap", self.picture({**job, "kind": "clean"}, 1)
        if what == "preview.pfm" and share > 0:
            return 200, "image/x-portable-floatmap", self.picture(job, share)
        if what == "image.pfm" and job["state"] == "done":
            return 200, "image/x-portable-floatmap", self.picture(job, 1)
        return self.problem(404 if what == "preview.pfm" else 409, "it is not there yet")

    def clean(self, job, method):
        """Answers a request about the denoised picture of a job. A POST begins the denoising. After that, each request for the state of the denoising
        advances it to the next state."""
        if job["state"] != "done":
            return self.problem(409, "the job is not done")
        if method == "POST":
            job["clean"] = job.get("clean", 0)
        elif "clean" in job:
            job["clean"] += 1
        if self.clean_failure and job.get("clean", 0) > 1:
            return self.reply({"state": "failed", "reason": self.clean_failure})
        if "clean" not in job:
            return self.reply({"state": "none"})
        states = ({"state": "guides"}, {"state": "guides", "fraction": 0.5}, {"state": "filtering", "fraction": 1.0},
                  {"state": "ready", "fraction": 1.0, "relative_rmse_raw": 0.05, "relative_rmse_clean": 0.02, "bias_share": 0.25})
        return self.reply(states[min(job["clean"], 3)])

    def picture(self, job, share):
        """Returns a PFM file. Red grows to the right and green upwards. The upper part `share` of the rows is rendered, and the other rows are
        black. Layers and denoised pictures are constant."""
        width, height = job["width"], job["height"]
        constants = {"albedo": (0.5, 0.25, 0.125), "normals": (0.5, 1.0, 0.5), "depth": (7.0, 7.0, 7.0), "clean": (0.75, 0.5, 0.25)}
        rows = bytearray()
        for y in range(height):  # from the bottom
            if job["kind"] in constants:
                rows += struct.pack("<3f", *constants[job["kind"]]) * width
            elif height - y > share * height:
                rows += bytes(12 * width)
            else:
                line = array.array("f", [v for x in range(width) for v in (x / width, y / height, 0.25)])
                rows += line.tobytes()
        return f"PF\n{width} {height}\n-1.0\n".encode() + bytes(rows)


if __name__ == "__main__":
    fake = FakeFarm(float(sys.argv[1]))
    print(fake.string, flush=True)
    sys.stdin.read()
