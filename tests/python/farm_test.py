"""Tests the Python module (deploy/python) on a real farm of one worker on loopback: farm_test.py BIN-FOLDER."""

import base64
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.path.insert(0, os.path.join(SOURCE, "deploy", "python"))
sys.dont_write_bytecode = True
import bandsaw  # noqa: E402

BIN = sys.argv.pop(1)
CORNELL = os.path.join(SOURCE, "renderlib", "gallery", "cornell.textproto")


class LoopbackFarm:
    """A coordinator and a worker. `web`, `listen`: the addresses for the options --web and --listen of the coordinator."""

    def __init__(self, folder, web="127.0.0.1:0", listen="127.0.0.1:0"):
        self.folder, self.data, self.listen, self.web = folder, os.path.join(folder, "farm"), listen, web
        self.processes, self.coordinator = [], None
        self.serve()
        self.worker()

    def serve(self):
        self.coordinator = self.start(["bandsaw", "serve", "--data", self.data, "--listen", self.listen, "--web", self.web])
        for line in self.coordinator.stdout:  # it prints this line when it is ready
            if line.startswith(b"join with"):
                return
        raise AssertionError("the coordinator has not started")

    def worker(self):
        return self.start(["bandsaw-worker", "--join", os.path.join(self.data, "join"), "--name", "desk", "--threads", "2"])

    def start(self, command):
        log = open(os.path.join(self.folder, "log"), "ab")
        process = subprocess.Popen([os.path.join(BIN, command[0])] + command[1:], stdout=subprocess.PIPE, stderr=log, stdin=subprocess.DEVNULL)
        log.close()
        self.processes.append(process)
        return process

    @property
    def string(self):
        with open(os.path.join(self.data, "farm")) as file:
            return file.read().strip()

    def stop(self):
        for process in self.processes:
            process.kill()
            process.wait()
            process.stdout.close()


def refuse_early(test, farm):
    """Sends a file that is too large. The coordinator refuses the file at once and closes the connection after two seconds. Checks that
    the error has the coordinator's reason, although this function goes on sending after the refusal."""
    size = 1 << 40

    def body():
        yield f"{'0' * 64} {size}\n".encode()
        for _ in range(200):
            yield bytes(4096)
            time.sleep(0.05)

    with test.assertRaises(bandsaw.Refused) as caught:
        farm.request("POST", "/api/files", body, size + 100)
    test.assertIn("at most", str(caught.exception))


class OnAFarm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.loopback = LoopbackFarm(cls.folder.name)
        cls.farm = bandsaw.Farm(cls.loopback.string)

    @classmethod
    def tearDownClass(cls):
        cls.loopback.stop()
        cls.folder.cleanup()

    def test_a_rendered_image_has_the_bytes_of_bandsaw_render(self):
        seen = []
        image = self.farm.render(CORNELL, samples=16, width=48, on_progress=seen.append)
        whole = os.path.join(self.folder.name, "whole.pfm")
        subprocess.run([os.path.join(BIN, "bandsaw"), "render", CORNELL, "--samples", "16", "--width", "48", "--report", "none", "--quiet", "-o", whole],
                       check=True, stdout=subprocess.DEVNULL)
        with open(whole, "rb") as file:
            self.assertTrue(bandsaw.compare(image, bandsaw.image_from_pfm(file.read()))["equal"])
        self.assertEqual(seen[-1].state, "done")
        self.assertEqual((seen[-1].fraction, seen[-1].samples), (1, 16))
        self.assertTrue(image.png().startswith(b"\x89PNG"))

    def test_a_clean_image_has_the_bytes_of_bandsaw_render(self):
        image = self.farm.render(CORNELL, samples=16, width=48, denoise=True)
        whole = os.path.join(self.folder.name, "clean.pfm")
        subprocess.run([os.path.join(BIN, "bandsaw"), "render", CORNELL, "--samples", "16", "--width", "48", "--denoise", "--report", "none", "--quiet",
                        "-o", whole], check=True, stdout=subprocess.DEVNULL)
        with open(whole, "rb") as file:
            self.assertTrue(bandsaw.compare(image, bandsaw.image_from_pfm(file.read()))["equal"])

    def test_an_image_of_one_sample_cannot_be_denoised(self):
        job = self.farm.submit(CORNELL, samples=1, width=8)
        list(job.progress(0.05))
        with self.assertRaises(bandsaw.Refused) as caught:
            job.clean()
        self.assertIn("samples", str(caught.exception))

    def test_a_model_is_sent_with_its_files_once(self):
        pergola = os.path.join(SOURCE, "renderlib", "gallery", "pergola.gltf")
        sent = []
        first = self.farm.submit(pergola, samples=1, width=16, on_progress=lambda done, total: sent.append(done))
        self.assertGreater(len(sent), 0)
        del sent[:]
        again = self.farm.submit(pergola, samples=2, width=16, on_progress=lambda done, total: sent.append(done))
        self.assertEqual(sent, [])
        # Waits until both jobs have ended.
        self.assertEqual(len(list(first.progress(0.05))[-1:] + list(again.progress(0.05))[-1:]), 2)
        self.assertEqual((again.image().width, again.status().samples), (16, 2))

    def test_a_scene_may_be_a_text(self):
        text = 'background { constant { rgb: [0.25, 0.5, 1] } } camera { look_at: [0, 0, 1] } shape { sphere { center: [9, 9, 9] radius: 1 } material: "m" }' \
               'material { name: "m" diffuse {} }'
        mean = self.farm.render(text, files={}, samples=1, width=8).mean()
        self.assertEqual(mean, (0.25, 0.5, 1))

    def test_layers_are_jobs(self):
        job = self.farm.submit(CORNELL, samples=1, width=16)
        layers = [job.layer(kind, 1) for kind in ("albedo", "normals", "depth")]
        for layer in layers:
            list(layer.progress(0.05))
            self.assertEqual(layer.image().width, 16)

    def test_a_job_has_a_preview_before_it_is_cancelled(self):
        job = self.farm.submit(CORNELL, samples=1 << 20, width=64)
        seen = None
        with self.assertRaises(bandsaw.BandsawError) as caught:
            for progress in job.progress(0.05):
                seen = seen or job.preview(64)
                if seen is not None and not progress.over:
                    job.cancel()
        self.assertIn("was cancelled", str(caught.exception))
        self.assertEqual((seen.width, seen.height), (64, 64))
        self.assertGreater(sum(seen.mean()), 0)

    def test_the_error_of_a_broken_scene_names_the_line_and_column(self):
        with self.assertRaises(bandsaw.Refused) as caught:
            self.farm.submit("shape { sfere {} }", files={})
        self.assertIn("1:9", str(caught.exception))

    def test_a_wrong_secret_is_reported(self):
        wrong = self.loopback.string[:-4] + "AAAA"
        with self.assertRaises(bandsaw.WrongString) as caught:
            bandsaw.Farm(wrong).check()
        self.assertIn("secret", str(caught.exception))


    def test_the_error_of_an_upload_that_is_refused_early_has_the_reason(self):
        refuse_early(self, self.farm)

    def test_a_loopback_address_may_be_a_tunnel(self):
        # The changed string names only the port of the dashboard, not its address. The client cannot know that this dashboard has no TLS,
        # so it must try TLS and then plain HTTP.
        places, rest = self.loopback.string.split("+", 1)
        web, rest = rest.split("-", 1)
        self.assertRegex(web, r"^127\.0\.0\.1:\d+$")
        self.assertEqual(bandsaw.Farm(f"{places}+{web.split(':')[1]}-{rest}").check(), self.farm.check())


class Tunnelled(unittest.TestCase):
    """The dashboard listens on all addresses, so it has TLS. The client connects to it on loopback, as through a tunnel."""

    def test_a_loopback_address_may_have_tls(self):
        with tempfile.TemporaryDirectory() as folder:
            loopback = LoopbackFarm(folder, web="0.0.0.0:0")
            try:
                farm = bandsaw.Farm(loopback.string)
                self.assertEqual(farm._addresses, [("127.0.0.1", farm._join.web[1])])
                self.assertNotEqual(farm.check(), "")
                refuse_early(self, farm)
                digest = base64.urlsafe_b64encode(farm._join.certificate).decode().rstrip("=")
                with self.assertRaises(bandsaw.NoFarm) as caught:
                    bandsaw.Farm(loopback.string.replace(digest, "A" * 43)).check()
                self.assertIn("another farm", str(caught.exception))
            finally:
                loopback.stop()


class Restarted(unittest.TestCase):
    """The coordinator listens on all addresses, so it has TLS. It is killed and restarted while a job runs."""

    def test_a_job_ends_although_its_coordinator_is_killed_and_restarted(self):
        with tempfile.TemporaryDirectory() as folder:
            loopback = LoopbackFarm(folder, web="0.0.0.0:0", listen="0.0.0.0:0")
            try:
                string = loopback.string
                farm = bandsaw.Farm(string)
                if not farm._addresses or bandsaw._is_loopback(farm._addresses[0][0]):
                    self.skipTest("this machine has only loopback addresses")
                ports = (farm._join.addresses[0][1], farm._join.web[1])
                job = farm.submit(CORNELL, samples=512, width=64)
                states = []
                for progress in job.progress(0.05):
                    states.append(progress.state)
                    if progress.state == "running" and "lost" not in states and progress.samples_done > 0:
                        loopback.coordinator.send_signal(signal.SIGKILL)
                        loopback.coordinator.wait()
                    if progress.state == "lost" and states.count("lost") == 1:
                        loopback.listen, loopback.web = f"0.0.0.0:{ports[0]}", f"0.0.0.0:{ports[1]}"
                        loopback.serve()
                self.assertIn("lost", states)
                self.assertEqual(states[-1], "done")
                self.assertEqual(job.image().width, 64)
                # Another certificate is refused before the secret is sent.
                digest = base64.urlsafe_b64encode(farm._join.certificate).decode().rstrip("=")
                with self.assertRaises(bandsaw.NoFarm) as caught:
                    bandsaw.Farm(string.replace(digest, "A" * 43)).check()
                self.assertIn("another farm", str(caught.exception))
            finally:
                loopback.stop()


if __name__ == "__main__":
    unittest.main()
