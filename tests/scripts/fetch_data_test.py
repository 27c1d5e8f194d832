#!/usr/bin/python3
"""scripts/fetch-data against servers on loopback: fetch_data_test.py SCRIPT DOCUMENTS."""

import hashlib
import http.server
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.parse

SCRIPT, DOCUMENTS = pathlib.Path(sys.argv[1]), [pathlib.Path(it) for it in sys.argv[2:]]
COMMIT = "0123456789abcdef0123456789abcdef01234567"
COLUMNS = ["name", "sha256", "bytes", "repository", "commit", "path", "licence", "citation"]
# Larger than what the server sends at once and than what curl keeps before it writes.
PUNCH, TENDON, POLYMER = (bytes((i * i + k) % 251 for i in range(200_000)) for k in range(3))


class Server(http.server.ThreadingHTTPServer):
    """Gives files by ranges, unless told to do worse, and notes who asked for what."""

    daemon_threads = True

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Answer)
        self.files = {}  # by path
        self.asked = []  # (path, first byte or None)
        self.cuts = []  # after so many bytes of an answer the connection ends, once each
        self.stalls_after = None  # so many bytes the answer does
        self.has_ranges = True
        self.let_go = threading.Event()

    @property
    def address(self):
        return "http://127.0.0.1:%d" % self.server_port


class Answer(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        server, path = self.server, urllib.parse.unquote(self.path)
        asked = re.fullmatch(r"bytes=(\d+)-", self.headers.get("Range", ""))
        server.asked.append((path, int(asked[1]) if asked else None))
        if path not in server.files:
            return self.send_error(404)
        whole = server.files[path]
        first = int(asked[1]) if asked and server.has_ranges else 0
        self.send_response(206 if first else 200)
        if first:
            self.send_header("Content-Range", "bytes %d-%d/%d" % (first, len(whole) - 1, len(whole)))
        self.send_header("Content-Length", str(len(whole) - first))
        self.end_headers()
        rest = whole[first:]
        if server.stalls_after is not None:
            self.wfile.write(rest[:server.stalls_after])
            server.let_go.wait(20)
        elif server.cuts:
            self.wfile.write(rest[:server.cuts.pop(0)])
        else:
            self.wfile.write(rest)

    def log_message(self, *_):
        pass


class FetchData(unittest.TestCase):
    def setUp(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.folder = pathlib.Path(folder)
        self.into = self.folder / "data"
        self.table = self.folder / "table.tsv"
        self.server = self.serve()
        self.rows = []
        self.offer("meniscus/punch.txt", PUNCH, "hand/punch", "runs/a punch, 50 % & more#1?.txt")
        self.offer("tendon/pull.csv", TENDON, "rat/tail", "pull/größe.csv")
        self.offer("tendon/hold.csv", POLYMER, "rat/tail", "hold.csv")
        self.environment = {"PATH": os.environ["PATH"], "HOME": folder, "TMPDIR": folder, "no_proxy": "*"}

    def serve(self):
        server = Server()
        threading.Thread(target=server.serve_forever, args=[0.01], daemon=True).start()

        def end():
            server.let_go.set()
            server.shutdown()
            server.server_close()

        self.addCleanup(end)
        return server

    def offer(self, name, content, repository, path):
        self.server.files["/%s/%s/%s" % (repository, COMMIT, path)] = content
        self.rows.append([name, hashlib.sha256(content).hexdigest(), str(len(content)), repository, COMMIT, path,
                          "of " + repository, "who made " + repository])

    def path_of(self, name):
        row = next(row for row in self.rows if row[0] == name)
        return "/%s/%s/%s" % (row[3], row[4], row[5])

    def command(self, *arguments, base=None):
        self.table.write_text("".join("\t".join(row) + "\n" for row in [COLUMNS, *self.rows]), encoding="utf-8")
        return [str(SCRIPT), "--table", str(self.table), "--into", str(self.into), "--base", base or self.server.address,
                *arguments]

    def run_it(self, *arguments, base=None):
        return subprocess.run(self.command(*arguments, base=base), env=self.environment, capture_output=True, text=True,
                              timeout=30)

    def start(self, *arguments):
        running = subprocess.Popen(self.command(*arguments), env=self.environment, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)

        def end():
            running.kill()
            running.communicate()

        self.addCleanup(end)
        return running

    def ended(self, done, status, *words):
        """With this status and one line, of all that is said, that has these words."""
        self.assertEqual(done.returncode, status, done.stderr)
        lines = [line for line in done.stderr.splitlines() if all(word in line for word in words)]
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertNotIn("Traceback", done.stderr)

    def holds(self, name, content):
        self.assertEqual((self.into / name).read_bytes(), content)
        self.assertFalse(self.partial(name).exists())

    def partial(self, name):
        return self.into / (name + ".partial")

    def leave_partial(self, name, content):
        self.partial(name).parent.mkdir(parents=True)
        self.partial(name).write_bytes(content)

    def start_on_the_first(self):
        """The run, and the file that it has begun to fill."""
        running, part = self.start("meniscus"), self.partial("meniscus/punch.txt")
        self.wait_until(lambda: part.exists() and part.stat().st_size > 0)
        return running, part

    @staticmethod
    def wait_until(fact):
        end = time.monotonic() + 10
        while not fact():
            assert time.monotonic() < end, "waited for nothing"
            time.sleep(0.005)

    # What is fetched

    def test_brings_every_file_and_says_once_whose_they_are(self):
        done = self.run_it()
        self.ended(done, 0, "3 of 3 files", "3 of them new")
        self.holds("meniscus/punch.txt", PUNCH)
        self.holds("tendon/pull.csv", TENDON)
        self.holds("tendon/hold.csv", POLYMER)
        self.assertEqual(done.stdout,
                         "hand/punch, commit 0123456\n  licence: of hand/punch\n  cite: who made hand/punch\n"
                         "rat/tail, commit 0123456\n  licence: of rat/tail\n  cite: who made rat/tail\n")

    def test_asks_by_repository_commit_and_path_whatever_the_path_is_written_with(self):
        self.run_it("meniscus/punch.txt")
        self.assertEqual(self.server.asked, [("/hand/punch/%s/runs/a punch, 50 %% & more#1?.txt" % COMMIT, None)])
        self.holds("meniscus/punch.txt", PUNCH)

    def test_brings_a_folder_and_nothing_else(self):
        self.assertEqual(self.run_it("tendon").returncode, 0)
        self.assertEqual(sorted(it.name for it in self.into.iterdir()), ["tendon"])
        self.holds("tendon/pull.csv", TENDON)
        self.holds("tendon/hold.csv", POLYMER)

    def test_takes_the_server_from_the_environment(self):
        command = self.command("meniscus")
        command.remove("--base")
        command.remove(self.server.address)
        there = "/mirror" + self.path_of("meniscus/punch.txt")
        self.server.files = {there: PUNCH}
        environment = {**self.environment, "KERF_DATA_BASE": self.server.address + "/mirror/"}
        self.assertEqual(subprocess.run(command, env=environment, capture_output=True).returncode, 0)
        self.assertEqual(self.server.asked, [(there, None)])
        self.holds("meniscus/punch.txt", PUNCH)

    def test_asks_nobody_for_what_is_there(self):
        self.run_it()
        self.server.asked.clear()
        done = self.run_it()
        self.ended(done, 0, "3 of 3 files", "0 of them new")
        self.assertEqual(done.stdout, "")
        self.assertEqual(self.server.asked, [])

    def test_lists_and_fetches_nothing(self):
        done = self.run_it("--list", "tendon")
        self.assertEqual(done.returncode, 0)
        self.assertIn("tendon/pull.csv", done.stdout)
        self.assertIn("cite: who made rat/tail", done.stdout)
        self.assertNotIn("punch", done.stdout)
        self.assertFalse(self.into.exists())
        self.assertEqual(self.server.asked, [])

    # Cut off

    def test_goes_on_where_the_connection_was_cut(self):
        self.server.cuts = [50_000, 70_000]
        self.assertEqual(self.run_it("meniscus").returncode, 0)
        self.holds("meniscus/punch.txt", PUNCH)
        self.assertEqual([first for _, first in self.server.asked], [None, 50_000, 120_000])

    def test_keeps_what_arrived_for_the_next_run(self):
        self.server.cuts = [50_000, 0]
        self.ended(self.run_it("meniscus"), 4, "meniscus/punch.txt", "run this again")
        self.assertFalse((self.into / "meniscus/punch.txt").exists())
        self.assertEqual(self.partial("meniscus/punch.txt").read_bytes(), PUNCH[:50_000])
        self.server.asked.clear()
        self.ended(self.run_it("meniscus"), 0, "from byte 50000 on")
        self.assertEqual([first for _, first in self.server.asked], [50_000])
        self.holds("meniscus/punch.txt", PUNCH)

    def test_begins_anew_where_a_server_knows_no_ranges(self):
        self.server.has_ranges = False
        self.leave_partial("meniscus/punch.txt", PUNCH[:1000])
        self.assertEqual(self.run_it("meniscus").returncode, 0)
        self.holds("meniscus/punch.txt", PUNCH)

    def test_gives_up_on_a_server_that_knows_no_ranges_and_always_cuts(self):
        self.server.has_ranges = False
        self.server.cuts = [50_000] * 20
        self.ended(self.run_it("meniscus"), 4, "meniscus/punch.txt", "cut off again and again", "--base")
        self.assertFalse((self.into / "meniscus/punch.txt").exists())

    def test_begins_anew_where_what_was_left_is_of_another_file(self):
        for left in (TENDON[:1000], TENDON, TENDON + b"more"):
            with self.subTest(bytes=len(left)):
                shutil.rmtree(self.into, ignore_errors=True)
                self.leave_partial("meniscus/punch.txt", left)
                self.assertEqual(self.run_it("meniscus").returncode, 0)
                self.holds("meniscus/punch.txt", PUNCH)

    def test_stopped_by_hand_leaves_nothing_half_under_the_name(self):
        self.server.stalls_after = 50_000
        running, part = self.start_on_the_first()
        running.send_signal(signal.SIGINT)
        _, errors = running.communicate(timeout=10)
        self.assertEqual(running.returncode, -signal.SIGINT)
        self.assertIn("stopped; what has arrived is kept", errors)
        self.assertNotIn("Traceback", errors)
        self.assertEqual([it.name for it in (self.into / "meniscus").iterdir()], ["punch.txt.partial"])
        arrived = part.stat().st_size
        self.server.stalls_after = None
        self.assertEqual(self.run_it("meniscus").returncode, 0)
        self.assertEqual(self.server.asked[-1][1], arrived)
        self.holds("meniscus/punch.txt", PUNCH)

    def test_two_at_once_fetch_each_file_once(self):
        self.server.stalls_after = 50_000
        one = self.start()
        self.wait_until(lambda: self.server.asked)
        two = self.start()
        line = two.stderr.readline()
        self.assertIn("waiting for another fetch-data", line)
        self.server.stalls_after = None
        self.server.let_go.set()  # the first answer ends there, and the rest is asked for
        for running in (one, two):
            running.communicate(timeout=20)
            self.assertEqual(running.returncode, 0)
        self.assertEqual([path for path, first in self.server.asked if first is None], [self.path_of(row[0]) for row in self.rows])
        self.holds("tendon/hold.csv", POLYMER)

    def test_waits_for_what_a_run_that_was_killed_left_running(self):
        self.server.stalls_after = 50_000
        killed, _ = self.start_on_the_first()
        killed.kill()
        killed.wait()
        after = self.start("meniscus")
        self.assertIn("waiting for another fetch-data", after.stderr.readline())
        self.server.stalls_after = None
        self.server.let_go.set()
        after.communicate(timeout=20)
        self.assertEqual(after.returncode, 0)
        self.holds("meniscus/punch.txt", PUNCH)

    # Refused

    def test_refuses_a_wrong_sum_in_one_line_and_brings_the_others(self):
        wrong = TENDON[:-1] + b"!"
        self.server.files[self.path_of("tendon/pull.csv")] = wrong
        done = self.run_it()
        self.ended(done, 1, "tendon/pull.csv", hashlib.sha256(wrong).hexdigest(), hashlib.sha256(TENDON).hexdigest(),
                   self.server.address, "--base")
        self.assertEqual([it.name for it in (self.into / "tendon").iterdir()], ["hold.csv"])
        self.holds("meniscus/punch.txt", PUNCH)

    def test_refuses_an_answer_that_is_too_long_too_short_or_empty(self):
        for answer, word in ((TENDON + b"more", "more than"), (TENDON[:-1], "(199999 bytes)"), (b"", "(0 bytes)")):
            with self.subTest(word):
                self.server.files[self.path_of("tendon/pull.csv")] = answer
                self.ended(self.run_it("tendon/pull.csv"), 1, "tendon/pull.csv", word, "expected", "200000 bytes", "--base")
                self.assertEqual(list((self.into / "tendon").iterdir()), [])

    def test_leaves_alone_another_file_in_its_place(self):
        self.leave_partial("tendon/pull.csv", b"")
        (self.into / "tendon/pull.csv").write_bytes(b"a lab's own")
        self.ended(self.run_it("tendon/pull.csv"), 1, "tendon/pull.csv is not the file of the table", "move it away")
        self.assertEqual((self.into / "tendon/pull.csv").read_bytes(), b"a lab's own")
        self.assertEqual(self.server.asked, [])

    def test_says_what_a_server_does_not_have_and_brings_the_others(self):
        del self.server.files[self.path_of("meniscus/punch.txt")]
        self.ended(self.run_it(), 4, "meniscus/punch.txt", "404", self.server.address)
        self.assertEqual(list((self.into / "meniscus").iterdir()), [])
        self.holds("tendon/pull.csv", TENDON)

    def test_stops_at_once_where_no_server_is(self):
        gone = Server()
        gone.server_close()
        done = self.run_it(base=gone.address)
        self.ended(done, 4, "meniscus/punch.txt", "Failed to connect", "run this again")
        self.assertNotIn("tendon", done.stderr)

    def test_stops_at_once_where_the_disk_is_full(self):
        self.partial("meniscus/punch.txt").parent.mkdir(parents=True)
        self.partial("meniscus/punch.txt").symlink_to("/dev/full")
        done = self.run_it()
        self.ended(done, 4, "cannot write", "punch.txt.partial", "--into")
        self.assertNotIn("tendon", done.stderr)
        self.assertFalse((self.into / "meniscus/punch.txt").exists())

    def test_says_that_it_cannot_make_the_folder(self):
        self.into.write_text("a file")
        self.ended(self.run_it(), 4, str(self.into))

    def test_names_curl_where_it_is_missing(self):
        self.environment["PATH"] = str(self.folder)
        self.ended(self.run_it(), 4, "curl is missing", "apt-get install curl")

    # Bad usage

    def test_fetches_nothing_where_a_name_is_unknown(self):
        for name in ("tendon/pul.csv", "tend", "../tendon", ""):
            with self.subTest(name=name):
                self.ended(self.run_it("meniscus", name), 2, "has no '%s'" % name, "--list")
        self.assertEqual(self.server.asked, [])

    def test_refuses_options_that_it_does_not_have(self):
        for arguments in (["--form"], ["--into"], ["--list=yes"]):
            with self.subTest(arguments=arguments):
                done = subprocess.run([SCRIPT, *arguments], capture_output=True, text=True)
                self.ended(done, 2, "--help")
                self.assertEqual(done.stderr.count("\n"), 1)

    def test_refuses_a_row_that_is_not_whole_or_leaves_the_folder(self):
        good = self.rows[1]
        for column, value in enumerate(["../pull.csv", "abc", "0", "", "main", "", "", ""]):
            with self.subTest(column=COLUMNS[column]):
                self.rows[1] = [*good[:column], value, *good[column + 1:]]
                self.ended(self.run_it(), 2, "table.tsv:3: expected a name below the folder")
        for name in ("/tmp/pull.csv", "tendon/../../pull.csv", "tendon/"):
            with self.subTest(name=name):
                self.rows[1] = [name, *good[1:]]
                self.ended(self.run_it(), 2, "table.tsv:3")
        self.rows[1] = good[:-1]
        self.ended(self.run_it(), 2, "table.tsv:3")
        self.assertEqual(self.server.asked, [])

    # The house's own table

    def test_knows_every_file_that_the_documents_name(self):
        done = subprocess.run([SCRIPT, "--list"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        known = set(re.findall(r"^(\S+) +\d+ bytes", done.stdout, re.M))
        folders = "|".join({name.partition("/")[0] for name in known})
        texts = [file for place in DOCUMENTS for file in ([place] if place.is_file() else place.rglob("*.md"))]
        named = {name for file in texts
                 for name in re.findall(r"\bdata/((?:%s)/\w+\.\w+)" % folders, file.read_text(encoding="utf-8"))}
        self.assertTrue(named)
        self.assertLessEqual(named, known)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
