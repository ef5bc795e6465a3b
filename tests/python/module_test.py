"""Tests the Python module (deploy/python) without a farm: the string of a farm, the files of scenes, requests, images. Tests also those modules of
the add-on (deploy/blender) that do not need Blender."""

import array
import json
import os
import socket
import struct
import sys
import tempfile
import threading
import time
import types
import unittest
import unittest.mock
import zlib

SOURCE = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.path.insert(0, os.path.join(SOURCE, "deploy", "python"))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bandsaw  # noqa: E402
import fake_farm  # noqa: E402

DIGEST, SECRET = "A" * 42 + "-", "abcdefghijklmnopqrst-_"


def string(places="10.0.0.1:7878", digest=DIGEST):
    """Returns the string of a farm. `places`: the addresses HOST:PORT of the coordinator, then + and the address or the port of the dashboard."""
    return f"bsw1-f-{places}-{digest}-{SECRET}"


class JoinStrings(unittest.TestCase):
    def test_a_string_has_addresses_dashboard_certificate_and_secret(self):
        join = bandsaw.JoinString(string("my-host.lan:1,[fe80::1]:65535+8787") + "\n")
        self.assertEqual(join.addresses, [("my-host.lan", 1), ("fe80::1", 65535)])
        self.assertEqual((join.web, join.secret, len(join.certificate)), ((None, 8787), SECRET, 32))
        self.assertEqual(bandsaw.JoinString(string("h:1+127.0.0.1:99")).web, ("127.0.0.1", 99))
        self.assertIsNone(bandsaw.JoinString(string("h:1")).web)
        self.assertIsNone(bandsaw.JoinString(string("h:1+8787", "plain")).certificate)

    def test_errors_of_wrong_strings_do_not_show_the_secret(self):
        for text, word in (("", "begin"), (string().replace("-f-", "-w-", 1), "workers'"), (string()[:-1], "cut off"), (string("h"), "HOST:PORT"),
                           (string("h:0"), "port"), (string("h:1+x"), "port"), (string("h:1").replace(DIGEST, "AAA"), "cut off")):
            with self.assertRaises(bandsaw.WrongString) as caught:
                bandsaw.Farm(text)
            self.assertIn(word, str(caught.exception), text)
            self.assertNotIn(SECRET, str(caught.exception))

    def test_the_string_may_be_in_a_file(self):
        with tempfile.NamedTemporaryFile("w", suffix=".farm") as file:
            file.write(string("127.0.0.1:1+5") + "\n")
            file.flush()
            self.assertIn(":5", repr(bandsaw.Farm(file.name)))


class NoFarms(unittest.TestCase):
    def test_a_port_at_which_nothing_listens_is_reported(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        with self.assertRaises(bandsaw.NoFarm) as caught:
            bandsaw.Farm(string(f"127.0.0.1:1+127.0.0.1:{port}")).check()
        self.assertIn("nothing listens there", str(caught.exception))
        self.assertIn("bandsaw serve", str(caught.exception))

    def answer_with(self, reply, connections=1):
        """Returns the port of a server that answers the first `connections` connections with `reply`. The server appends the first bytes of each
        connection to `self.received`."""
        server = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(server.close)
        self.received = received = []

        def serve():
            while len(received) < connections:
                connection, _ = server.accept()
                received.append(connection.recv(4096))
                connection.sendall(reply)
                connection.close()

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        self.addCleanup(thread.join)
        return server.getsockname()[1]

    def test_another_program_at_the_port_is_reported(self):
        port = self.answer_with(b"HTTP/1.1 404 Not Found\r\nContent-Length: 5\r\n\r\nhello")
        with self.assertRaises(bandsaw.NoFarm) as caught:
            bandsaw.Farm(string(f"127.0.0.1:1+127.0.0.1:{port}")).check()
        self.assertIn("not a Bandsaw coordinator", str(caught.exception))

    def test_through_a_tunnel_the_secret_is_sent_only_after_tls_has_failed(self):
        port = self.answer_with(b'HTTP/1.1 400 Bad Request\r\nContent-Length: 15\r\n\r\n{"error": "no"}', connections=2)
        with self.assertRaises(bandsaw.Refused):
            bandsaw.Farm(string(f"127.0.0.1:1+{port}")).check()
        self.assertEqual([SECRET.encode() in one for one in self.received], [False, True])

    def test_the_secret_is_not_sent_in_plain_text_to_other_machines(self):
        self.assertEqual([bandsaw._is_loopback(host) for host in ("127.0.0.2", "localhost", "::1", "127.example.org", "10.0.0.1")],
                         [True, True, True, False, False])
        for web in ("{}", "127.0.0.1:{}"):
            port = self.answer_with(b"HTTP/1.1 400 Bad Request\r\n\r\n")
            with unittest.mock.patch.object(bandsaw, "_is_loopback", lambda host: False), self.assertRaises(bandsaw.NoFarm) as caught:
                bandsaw.Farm(string("127.0.0.1:1+" + web.format(port))).check()
            self.assertIn("no TLS there", str(caught.exception))
            self.assertNotIn(SECRET.encode(), self.received[0])

    def test_a_program_that_does_not_speak_http_is_no_farm(self):
        port = self.answer_with(b"SSH-2.0-x\r\n")
        with self.assertRaises(bandsaw.NoFarm):
            bandsaw.Farm(string(f"127.0.0.1:1+127.0.0.1:{port}")).check()


class Files(unittest.TestCase):
    def make(self, **files):
        """Makes a temporary folder with these files and returns its path. In the names of the files "__" stands for "."."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        for name, text in files.items():
            path = os.path.join(folder.name, *name.replace("__", ".").split("/"))
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w") as file:
                file.write(text)
        return folder.name

    def test_files_that_other_files_name_are_found(self):
        folder = self.make(**{"scene__textproto": 'model { file: "things/a.obj" } texture { image { file: "no.png" } }',
                              "things/a__obj": "mtllib a.mtl\nv 0 0 0\n", "things/a__mtl": "newmtl x\nmap_Kd -s 1 1 1 wood 1.png\n",
                              "things/wood 1__png": "p", "other__png": "o"})
        main, files = bandsaw._files_of(os.path.join(folder, "scene.textproto"))
        self.assertEqual(main, "scene.textproto")
        self.assertEqual(sorted(files), ["scene.textproto", "things/a.mtl", "things/a.obj", "things/wood 1.png"])

    def test_gltf_names_are_decoded_and_stay_below_the_folder(self):
        folder = self.make(**{"in/a__gltf": '{"buffers": [{"uri": "my%20mesh.bin"}, {"uri": "../secret.bin"}]}', "in/my mesh__bin": "b",
                              "secret__bin": "s"})
        _, files = bandsaw._files_of(os.path.join(folder, "in", "a.gltf"))
        self.assertEqual(sorted(files), ["a.gltf", "my mesh.bin"])

    def test_included_files_name_files_from_the_folder_of_the_scene(self):
        folder = self.make(**{"main__pbrt": 'Include "geometry/g.pbrt"', "geometry/g__pbrt": 'Shape "plymesh" "string filename" "geometry/m.ply"',
                              "geometry/m__ply": "m", "main__xml": '<include filename="sub/a.xml"/>',
                              "sub/a__xml": '<string name="filename" value="meshes/b.obj"/> <string name="filename" value="c.obj"/>',
                              "meshes/b__obj": "b", "sub/c__obj": "c"})
        _, files = bandsaw._files_of(os.path.join(folder, "main.pbrt"))
        self.assertEqual(sorted(files), ["geometry/g.pbrt", "geometry/m.ply", "main.pbrt"])
        _, files = bandsaw._files_of(os.path.join(folder, "main.xml"))
        self.assertEqual(sorted(files), ["main.xml", "meshes/b.obj", "sub/a.xml", "sub/c.obj"])

    def test_pictures_of_binary_models_are_found(self):
        # An FBX file has the length of each text before the text. In a 3DS file texts end with a zero byte.
        fbx = 'S\x0e\0\0\0C:\\x\\Wood 1.PNGS\x0d\0\0\0maps\\bump.jpeg R\x01\x02.png\0'
        folder = self.make(**{"in/a__fbx": fbx, "in/Wood 1__PNG": "w", "in/maps/bump__jpeg": "b", "in/other__png": "o",
                              "in/b__3ds": "\0\xa3\x0d\0\0\0stone.tga\0", "in/stone__tga": "s",
                              "in/s__textproto": 'model { file: "b.3ds" } model { file: "/x/other.png" }'})
        _, files = bandsaw._files_of(os.path.join(folder, "in", "a.fbx"))
        self.assertEqual(sorted(files), ["Wood 1.PNG", "a.fbx", "maps/bump.jpeg"])
        _, files = bandsaw._files_of(os.path.join(folder, "in", "s.textproto"))
        self.assertEqual(sorted(files), ["b.3ds", "s.textproto", "stone.tga"])

    def test_a_long_line_of_a_model_is_searched_once(self):
        folder = self.make(**{"a__fbx": "a: " + "0.5," * 250000 + '\n"a.png"', "a__png": "p"})
        began = time.monotonic()
        _, files = bandsaw._files_of(os.path.join(folder, "a.fbx"))
        self.assertEqual(sorted(files), ["a.fbx", "a.png"])
        self.assertLess(time.monotonic() - began, 10)  # it would take minutes if a search began at every byte of the line

    def test_a_missing_scene_is_named(self):
        with self.assertRaises(bandsaw.BandsawError) as caught:
            bandsaw._files_of("nothing.glb")
        self.assertIn("nothing.glb", str(caught.exception))


class Jobs(unittest.TestCase):
    """The requests of a client, at a coordinator that renders nothing."""

    def setUp(self):
        self.fake = fake_farm.FakeFarm()
        self.addCleanup(self.fake.stop)
        self.farm = bandsaw.Farm(self.fake.string)

    def posts(self):
        return [path for method, path in self.fake.requests if method == "POST"]

    def test_after_the_address_of_another_program_the_next_address_is_tried(self):
        with socket.create_server(("127.0.0.1", 0)) as server:
            def serve():
                connection, _ = server.accept()
                connection.recv(4096)
                connection.sendall(b"HTTP/1.1 302 Found\r\nContent-Length: 0\r\n\r\n")
                connection.close()

            thread = threading.Thread(target=serve, daemon=True)
            thread.start()
            self.farm._addresses.insert(0, server.getsockname()[:2])
            self.assertEqual(self.farm.check(), "fake")
            thread.join()
        self.assertEqual(self.farm._addresses[0][1], self.fake.port)

    def test_after_the_address_of_another_farm_the_next_address_is_tried(self):
        send = self.farm._send

        def send_or_refuse(address, *more):
            if address[0] == "other":
                raise bandsaw.NoFarm("it is another farm")
            return send(address, *more)

        self.farm._send = send_or_refuse
        self.farm._addresses.insert(0, ("other", 1))
        self.assertEqual(self.farm.check(), "fake")
        self.farm._addresses = [("other", 1)]
        with self.assertRaises(bandsaw.NoFarm) as caught:
            self.farm.check()
        self.assertIn("other:1: it is another farm", str(caught.exception))

    def test_files_are_sent_once(self):
        files = {"a.glb": b"mesh", "b.png": b"image"}
        self.farm.submit("one", files=files, samples=3, title="first one")
        self.assertEqual(self.posts(), ["/api/files/missing", "/api/files", "/api/scenes/files"])
        self.fake.requests.clear()
        self.farm.submit("one", files=files, error=0.5)
        self.assertEqual(self.posts(), ["/api/files/missing", "/api/scenes/files"])
        first, second = self.fake.scenes
        self.assertEqual(first["files"], {"scene.textproto": b"one", **files})
        self.assertEqual((first["main"], first["samples"], first["title"]), ("scene.textproto", "3", "first one"))
        self.assertEqual((second["error"], "samples" in second), ("0.5", False))

    def test_a_file_that_was_removed_is_sent_again(self):
        self.farm.submit("one", files={})
        self.fake.refusals = [409]
        self.farm.submit("one", files={})
        self.assertEqual(len(self.fake.scenes), 2)

    def test_a_busy_coordinator_is_asked_again(self):
        self.fake.refusals = [503]
        self.assertEqual(self.farm.submit("one", files={}).number, 1)

    def test_a_full_disk_is_reported_without_another_try(self):
        self.fake.refusals = [429, 429]
        with self.assertRaises(bandsaw.Refused):
            self.farm.submit("one", files={})
        self.assertEqual(self.fake.refusals, [429])

    def test_the_error_of_an_upload_that_is_refused_early_has_the_reason(self):
        self.fake.full = True
        with self.assertRaises(bandsaw.Refused) as caught:
            self.farm.submit("one", files={"large.bin": bytes(64 << 20)})
        self.assertEqual((caught.exception.status, str(caught.exception)), (429, "the disk is full"))

    def test_an_error_of_the_scene_is_reported(self):
        self.fake.refusals = [400]
        with self.assertRaises(bandsaw.Refused) as caught:
            self.farm.submit("one", files={})
        self.assertEqual((caught.exception.status, str(caught.exception)), (400, "not now"))

    def test_progress_ends_with_the_job(self):
        job = self.farm.submit("one", files={})
        self.assertIsNone(job.preview())
        seen = [(progress.state, progress.fraction) for progress in job.progress(0)]
        self.assertEqual(seen, [("running", 0.25), ("running", 0.5), ("running", 0.75), ("done", 1.0)])
        self.assertEqual((job.image().width, job.image().height), (64, 48))

    def test_a_preview_has_the_rows_that_are_there(self):
        job = self.farm.submit("one", files={})
        next(iter(job.progress(0)))  # now a quarter of the 48 rows is rendered: the upper 12
        whole, part = fake_farm.FakeFarm.picture(None, self.fake.jobs[1], 1), job.preview()
        again = bandsaw.image_from_pfm(whole)
        line = 3 * 64
        flat = [list(bandsaw.numpy.asarray(p.pixels).reshape(-1)) if bandsaw.numpy is not None else list(p.pixels) for p in (part, again)]
        self.assertEqual(flat[0][:12 * line], flat[1][:12 * line])
        self.assertEqual(set(flat[0][12 * line:]), {0.0})
        self.assertTrue(job._repr_png_().startswith(b"\x89PNG"))

    def test_a_cancelled_job_is_an_error(self):
        job = self.farm.submit("one", files={})
        job.cancel()
        with self.assertRaises(bandsaw.BandsawError) as caught:
            list(job.progress(0))
        self.assertIn("was cancelled", str(caught.exception))

    def test_stop_ends_the_progress(self):
        job = self.farm.submit("one", files={})
        # The submission makes three requests, and each progress makes one. So `stop` is true after the second progress, before the job ends.
        self.assertEqual(len(list(job.progress(0, stop=lambda: len(self.fake.requests) > 4))), 2)

    def test_a_lost_coordinator_is_first_a_state_and_then_an_error(self):
        job = self.farm.submit("one", files={})
        seen = []
        with self.assertRaises(bandsaw.NoFarm):
            for progress in job.progress(0, patience=0.3):
                if not seen:
                    self.fake.server.server_close()
                    self.fake.server.shutdown()
                seen.append(progress.state)
        self.assertEqual(seen[0], "running")
        self.assertEqual(set(seen[1:]), {"lost"})

    def test_a_wrong_secret_is_not_reported_as_a_lost_farm(self):
        with self.assertRaises(bandsaw.WrongString):
            bandsaw.Farm(self.fake.string[:-1] + "x").check()

    def test_layers_are_jobs(self):
        layer = self.farm.submit("one", files={}).layer("depth", 4)
        list(layer.progress(0))
        self.assertEqual(layer.image().mean(), (7, 7, 7))

    def test_a_clean_image_is_requested_once_and_followed_until_it_is_ready(self):
        job = self.farm.submit("one", files={})
        list(job.progress(0))
        seen = []
        image = job.clean(seen.append, interval=0)
        self.assertEqual([(state["state"], state["fraction"]) for state in seen], [("none", 0), ("guides", 0.5), ("filtering", 1), ("ready", 1)])
        self.assertEqual(image.mean(), (0.75, 0.5, 0.25))
        self.assertEqual(self.fake.requests.count(("POST", "/api/jobs/1/clean")), 1)
        self.assertEqual(job.clean_state(), {"state": "ready", "fraction": 1, "reason": "", "error_raw": 0.05, "error_clean": 0.02, "bias_share": 0.25})
        self.assertNotEqual(job.image().mean(), image.mean())

    def test_a_render_may_be_denoised(self):
        self.assertEqual(self.farm.render("one", files={}, denoise=True).mean(), (0.75, 0.5, 0.25))

    def test_the_reason_why_an_image_is_not_denoised_is_told(self):
        job = self.farm.submit("one", files={})
        with self.assertRaises(bandsaw.Refused) as caught:
            self.clean_after_progress(job, 0)
        self.assertEqual(str(caught.exception), "the job is not done")
        self.fake.clean_failure = "a guide has failed"
        with self.assertRaises(bandsaw.BandsawError) as caught:
            self.clean_after_progress(job, 4)
        self.assertEqual(str(caught.exception), "the image of job 1 was not denoised: a guide has failed")

    def clean_after_progress(self, job, states):
        """Requests `states` states of the job, then its clean image."""
        for _ in range(states):
            job.status()
        return job.clean(interval=0)

    def test_stop_ends_the_denoising(self):
        job = self.farm.submit("one", files={})
        self.assertIsNone(job.clean(stop=lambda: True))

    def test_a_coordinator_that_is_lost_during_the_denoising_is_an_error(self):
        job = self.farm.submit("one", files={})
        list(job.progress(0))

        def stop_the_farm(state):
            self.fake.server.server_close()
            self.fake.server.shutdown()

        with self.assertRaises(bandsaw.NoFarm):
            job.clean(stop_the_farm, interval=0, patience=0.3)

    def test_an_interrupted_render_cancels_its_job(self):
        def stop(progress):
            raise KeyboardInterrupt
        with self.assertRaises(KeyboardInterrupt):
            self.farm.render("one", files={}, on_progress=stop)
        self.assertEqual(self.fake.jobs[1]["state"], "cancelled")


def image(width, height, values):
    """Returns an image with these values, three for each pixel, with rows from the top."""
    floats = array.array("f", values)
    if bandsaw.numpy is not None:
        floats = bandsaw.numpy.array(floats, dtype="float32")
    return bandsaw.Image(width, height, floats)


class Images(unittest.TestCase):
    def pixels(self, picture):
        return list(bandsaw.numpy.asarray(picture.pixels).reshape(-1)) if bandsaw.numpy is not None else list(picture.pixels)

    def test_pfm_round_trips_exactly(self):
        values = [i / 7 for i in range(3 * 4 * 3)]
        picture = image(4, 3, values)
        again = bandsaw.image_from_pfm(picture.pfm())
        self.assertEqual((again.width, again.height), (4, 3))
        self.assertEqual(self.pixels(again), self.pixels(picture))

    def test_pfm_rows_begin_at_the_bottom(self):
        data = b"PF\n1 2\n-1.0\n" + struct.pack("<6f", 1, 1, 1, 2, 2, 2)
        self.assertEqual(self.pixels(bandsaw.image_from_pfm(data)), [2, 2, 2, 1, 1, 1])
        big = b"PF\n1 1\n1.0\n" + struct.pack(">3f", 1, 2, 3)
        self.assertEqual(self.pixels(bandsaw.image_from_pfm(big)), [1, 2, 3])

    def test_damaged_pfm_is_an_error(self):
        for data in (b"", b"P6 1 1 255 xxx", b"PF\n2 2\n-1.0\n1234"):
            with self.assertRaises(bandsaw.BandsawError):
                bandsaw.image_from_pfm(data)

    def test_png_holds_srgb(self):
        data = image(2, 1, [0, 0.5, 1, 2, -1, 0.0031308]).png()
        self.assertTrue(data.startswith(b"\x89PNG\r\n\x1a\n"))
        at, raw = 8, b""
        while at < len(data):
            size, kind = struct.unpack(">I4s", data[at:at + 8])
            body = data[at + 8:at + 8 + size]
            self.assertEqual(struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0], zlib.crc32(kind + body))
            raw += body if kind == b"IDAT" else b""
            at += 12 + size
        # A byte for the filter, and the codes: 0.5 is 188; 2 and -1 are clamped; 0.0031308 is the end of sRGB's linear part.
        self.assertEqual(list(zlib.decompress(raw)), [0, 0, 188, 255, 255, 0, 10])

    def test_compare_returns_the_differences_and_refuses_other_sizes(self):
        a, b = image(1, 1, [1, 2, 3]), image(1, 1, [1, 2, 6])
        found = bandsaw.compare(a, b)
        self.assertAlmostEqual(found["rmse"], 3 ** 0.5)
        self.assertAlmostEqual(found["relative_rmse"], 3 ** 0.5 / 3)
        self.assertEqual((found["largest"], found["equal"]), (3, False))
        self.assertTrue(bandsaw.compare(a, a)["equal"])
        with self.assertRaises(bandsaw.BandsawError):
            bandsaw.compare(a, image(1, 2, [0] * 6))

    def test_files_are_whole_or_absent(self):
        with tempfile.TemporaryDirectory() as folder:
            image(1, 1, [0, 0, 0]).save(os.path.join(folder, "a.png"))
            self.assertEqual(os.listdir(folder), ["a.png"])
            with self.assertRaises(bandsaw.BandsawError):
                image(1, 1, [0, 0, 0]).save(os.path.join(folder, "a.jpg"))


class Texts(unittest.TestCase):
    def test_progress_is_a_line(self):
        status = {"state": "JOB_STATE_RUNNING", "fraction": 0.25, "remaining_s": 75, "samples_per_pixel": "16", "error": 0.031,
                  "worker": [{"name": "desk"}]}
        self.assertEqual(str(bandsaw.Progress(status, [])), "running · 25 % · 16 samples · error 3.1 % · 1:15 min left · 1 worker")
        self.assertIsNone(bandsaw.Progress({"remaining_s": -1, "error": "NaN"}, []).remaining)


@unittest.skipIf(bandsaw.numpy is None, "numpy is not installed")
class AddOn(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # The package's own __init__ needs Blender; these modules do not.
        import importlib
        package = types.ModuleType("bandsaw_blender")
        package.__path__ = [os.path.join(SOURCE, "deploy", "blender", "bandsaw_blender")]
        sys.modules["bandsaw_blender"] = package
        cls.files, cls.geometry, cls.noise, cls.evaluate = (importlib.import_module("bandsaw_blender." + name)
                                                            for name in ("files", "geometry", "noise", "evaluate"))

    def test_exr_has_a_chunk_for_each_line(self):
        np = bandsaw.numpy
        pixels = np.arange(2 * 3 * 3, dtype=np.float32).reshape(2, 3, 3)
        # The file ends with two chunks, one for each line: two numbers of 4 bytes, line and size, and 36 bytes of pixels. Before them are the
        # chunks' offsets, 8 bytes each. The pixels of a line are all blues, then all greens, then all reds.
        data = self.files.exr(pixels)
        self.assertEqual(struct.unpack("<i", data[:4])[0], 20000630)
        offsets = struct.unpack("<2Q", data[-2 * (8 + 36) - 16:-2 * (8 + 36)])
        self.assertEqual(offsets, (len(data) - 88, len(data) - 44))
        y, size = struct.unpack("<ii", data[offsets[1]:offsets[1] + 8])
        self.assertEqual((y, size), (1, 36))
        blue = struct.unpack("<3f", data[offsets[1] + 8:offsets[1] + 20])
        self.assertEqual(blue, (11, 14, 17))

    def test_each_texel_of_an_atlas_belongs_to_its_triangle(self):
        np = bandsaw.numpy
        atlas = self.geometry.Atlas(7, 64)
        places = atlas.uvs.reshape(7, 3, 2) * atlas.side
        y, x = np.divmod(np.arange(atlas.side ** 2), atlas.side)
        centres = np.stack([x + 0.5, y + 0.5], axis=1)
        shown = atlas.triangle >= 0
        spread = atlas.spread(places.reshape(-1, 2))
        self.assertLess(np.abs(spread - centres)[shown].max(), 1e-4)  # the weights give back the place
        # All four texels of a bilinear look-up inside a triangle belong to this triangle.
        for number in range(7):
            corners = places[number]
            for weights in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (0.5, 0.5, 0), (0, 0.5, 0.5), (0.5, 0, 0.5), (1 / 3, 1 / 3, 1 / 3)):
                low = np.floor(np.array(weights) @ corners - 0.5 + 1e-4).astype(int)
                for dx in (0, 1):
                    for dy in (0, 1):
                        weight = np.prod(np.where(np.array([dx, dy]) == 1, np.array(weights) @ corners - 0.5 - low, 1 - (np.array(weights) @ corners - 0.5 - low)))
                        if weight > 1e-3:
                            self.assertEqual(atlas.triangle[(low[1] + dy) * atlas.side + low[0] + dx], number)

    def test_noise_is_in_its_range_and_zero_on_the_lattice(self):
        np = bandsaw.numpy
        points = np.random.default_rng(1).uniform(-100, 100, (20000, 3))
        value, colors = self.noise.texture(points, 2, 0.5, 0)
        self.assertTrue((value > 0).all() and (value < 1).all() and (colors > 0).all() and (colors < 1).all())
        self.assertAlmostEqual(value.mean(), 0.5, delta=0.01)  # probability of a false alarm: 1e-7
        self.assertEqual(abs(self.noise.signed(np.array([[1.0, -2.0, 3.0]]))).max(), 0)

    def test_a_mesh_without_seams_keeps_its_vertices(self):
        np = bandsaw.numpy
        positions = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float32)
        corners = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
        uv = positions[:, :2].copy()
        pose = types.SimpleNamespace(positions=positions, undeformed=None, normals=None)
        kept = self.geometry._indexed(pose, [uv], corners, corners, None)
        self.assertEqual(len(kept.positions), 4)
        # Now each triangle has loops of its own, and one uv differs at a shared vertex.
        corners6, of_corner = np.array([[0, 1, 2], [3, 4, 5]], dtype=np.int32), np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
        uv6 = uv[[0, 1, 2, 0, 2, 3]].copy()
        uv6[3] = (5, 5)
        split = self.geometry._indexed(pose, [uv6], corners6, of_corner, None)
        self.assertEqual(len(split.positions), 5)
        found = split.uvs[0][split.indices.reshape(-1)]
        self.assertTrue((found == uv6).all())
        self.assertTrue((split.positions[split.indices.reshape(-1)] == positions[of_corner.reshape(-1)]).all())

    def test_a_mesh_that_deforms_is_a_morph_target(self):
        np, geometry = bandsaw.numpy, self.geometry
        positions = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float32)
        corners = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
        up = np.tile(np.array([[0, 0, 1]], dtype=np.float32), (4, 1))
        # Each corner has a loop of its own. When the shutter closes, the third vertex has two
        # normals, so it is split.
        of_corner, loops = np.array([0, 1, 2, 0, 2, 3]), np.arange(6).reshape(2, 3)
        pose = types.SimpleNamespace(positions=positions, undeformed=None, normals=up[[0, 0, 0, 0, 0, 0]])
        bent = pose.normals.copy()
        bent[4] = (1, 0, 0)
        ends = geometry.Vertices(positions - 1, pose.normals), geometry.Vertices(positions * 3, bent)
        made = geometry._indexed(pose, [], loops, corners, ends)
        self.assertEqual(len(made.positions), 5)
        flat = made.indices.reshape(-1)
        for (end, expected) in zip(made.ends, ends):
            self.assertTrue((end.positions[flat] == expected.positions[of_corner]).all())
            self.assertTrue((end.normals[flat] == expected.normals).all())
        self.assertTrue((made.compact().corners().ends[1].normals == bent).all())

        data = geometry.glb(made)
        size = int.from_bytes(data[12:16], "little")
        root, binary = json.loads(data[20:20 + size]), data[28 + size:]

        def vectors(accessor):
            start = root["bufferViews"][root["accessors"][accessor]["bufferView"]]["byteOffset"]
            return np.frombuffer(binary, dtype="<f4", offset=start, count=15).reshape(5, 3)

        primitive = root["meshes"][0]["primitives"][0]
        for name, last in (("POSITION", made.ends[1].positions), ("NORMAL", made.ends[1].normals)):
            self.assertTrue((vectors(primitive["attributes"][name]) + vectors(primitive["targets"][0][name]) == last).all())
        self.assertEqual(root["animations"][0]["name"], geometry.DEFORMS)
        self.assertEqual(len(data), int.from_bytes(data[8:12], "little"))

    def test_conversion_to_hsv_and_back_changes_no_color(self):
        np = bandsaw.numpy
        colors = np.random.default_rng(2).uniform(0, 1, (1000, 3))
        self.assertLess(abs(self.evaluate.from_hsv(self.evaluate.to_hsv(colors)) - colors).max(), 1e-12)

    def test_a_vector_becomes_a_number_by_its_mean_and_a_colour_by_its_luminance(self):
        np, node = bandsaw.numpy, types.SimpleNamespace

        def socket_after(kind, output_type, type="VALUE", **more):
            output = node(node=node(type=kind, mute=False, as_pointer=lambda: kind, **more), type=output_type, identifier="", name="Position",
                          is_output=True)
            return node(type=type, is_linked=True, links=[node(is_valid=True, is_muted=False, from_socket=output)])

        points = self.evaluate.Points(2, position=np.array([[3.0, 1.0, 2.0], [0.0, 0.0, -3.0]]))
        values = self.evaluate.Evaluator(points, None, self.fail)
        vector = socket_after("NEW_GEOMETRY", "VECTOR")
        self.assertEqual(self.evaluate.number(values.socket(vector)).tolist(), [2, -1])
        color = socket_after("RGB", "RGBA", outputs=[node(default_value=(1, 0, 0, 1))])
        self.assertEqual(self.evaluate.number(values.socket(color)).tolist(), [0.2126])
        kept = socket_after("NEW_GEOMETRY", "VECTOR", "VECTOR")
        self.assertEqual(values.socket(kept).tolist(), [[3, 1, 2], [0, 0, -3]])


if __name__ == "__main__":
    unittest.main()
