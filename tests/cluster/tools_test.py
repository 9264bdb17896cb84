"""The tools of scripts/cluster by themselves: odd names, odd lists, scans that end in an error, what is done again and what not."""
import csv
import importlib.util
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

from cohort_scans import ROOT

TOOLS = ROOT / "scripts" / "cluster"
PROGRAM = pathlib.Path(os.environ.get("VITRUVIAN_BUILD", ROOT / "build" / "native")) / "vitruvian"

specification = importlib.util.spec_from_file_location("cohort", TOOLS / "cohort.py")
cohort = importlib.util.module_from_spec(specification)
specification.loader.exec_module(cohort)


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, content=b"not a scan"):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
        return path


class List(InFolder):
    def test_every_scan_has_a_name_of_its_own_that_can_be_a_folders(self):
        names = ["a.ply", "a/scan.ply.gz", "b/scan.PLY", "b/Zoë Müller.obj", "-x.stl", ".hidden.ply", "notes.txt", "b/scan.mtl"]
        for name in names:
            self.write(name)
        listed = dict(cohort.scans_below(str(self.folder)))
        self.assertEqual(set(listed), {"s-x", "a", "a__scan", "b__scan", "b__Zo--M-ller"})
        self.assertEqual({os.path.relpath(p, self.folder) for p in listed.values()}, set(names[:5]))
        for own in listed:
            self.assertRegex(own, r"^[A-Za-z0-9][A-Za-z0-9._+@=-]*$")

    def test_two_scans_of_one_name_are_refused(self):
        self.write("a/scan.ply")
        self.write("a__scan.ply")
        with self.assertRaisesRegex(SystemExit, "a__scan.ply.*rename|a/scan.ply.*rename"):
            cohort.scans_below(str(self.folder))

    def test_a_path_that_cannot_be_listed_is_named(self):
        self.write("a\tb.ply")
        with self.assertRaisesRegex(SystemExit, r"a\\tb.ply.*rename"):
            cohort.scans_below(str(self.folder))

    def test_a_list_that_is_not_one_is_refused_with_the_line(self):
        for text, problem in (("a\tx.ply\nb\n", "line 2"), ("a\tx\n\na\ty\n", "line 2"), ("a\tx\na\ty\n", "line 2.*before")):
            path = self.write("scans.tsv", text.encode())
            with self.assertRaisesRegex(SystemExit, problem):
                cohort.read_list(path)

    def test_a_result_that_is_cut_off_is_named(self):
        self.write("scans.tsv", b"a\tx.ply\n")
        self.write("out/scans/a/status.json", b'{"id": "a", ')
        with self.assertRaisesRegex(SystemExit, "a/status.json"):
            cohort.merge(str(self.folder / "scans.tsv"), str(self.folder / "out"))


class RegisterOne(InFolder):
    def one(self, own, scan, *options, **environment):
        return subprocess.run([TOOLS / "register_one", own, scan, self.folder / "out", *options], capture_output=True, text=True,
                              env={**os.environ, "VITRUVIAN": str(PROGRAM), **environment})

    def made(self, own):
        return (self.folder / "out" / "scans" / own / "status.json").stat().st_mtime_ns

    def test_an_error_is_a_result_until_something_changes(self):
        scan = self.write("broken scan.ply")
        self.assertEqual(self.one("a", scan).returncode, 0)
        status = json.loads((self.folder / "out/scans/a/status.json").read_text())
        self.assertEqual((status["outcome"], status["exit_status"]), ("error", 3))
        self.assertIn(str(scan), status["message"])

        begin = self.made("a")
        self.assertEqual(self.one("a", scan).returncode, 0)
        self.assertEqual(self.made("a"), begin)
        for change in (lambda: self.one("a", scan, RETRY="1"), lambda: self.one("a", scan, "--seed", "2"),
                       lambda: (scan.write_bytes(b"another"), self.one("a", scan, "--seed", "2"))):
            before = self.made("a")
            change()
            self.assertNotEqual(self.made("a"), before)
        self.assertEqual([p.name for p in (self.folder / "out/scans").iterdir()], ["a"])

    def test_a_missing_scan_is_a_row_of_the_table(self):
        self.write("scans.tsv", f"a\t{self.folder}/none.ply\n".encode())
        self.assertEqual(self.one("a", self.folder / "none.ply").returncode, 0)
        self.assertEqual(cohort.merge(str(self.folder / "scans.tsv"), str(self.folder / "out")), 0)
        with open(self.folder / "out/cohort.csv", newline="") as file:
            row, = csv.DictReader(file)
        self.assertEqual(row["verdict"], "error")
        self.assertIn("none.ply", row["reasons"])

    def test_wrong_use_leaves_nothing(self):
        scan = self.write("scan.ply")
        for own, options, environment in (("../up", (), {}), ("a", ("--no-such-option",), {}), ("a", (), {"VITRUVIAN": "/none"})):
            done = self.one(own, scan, *options, **environment)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertNotEqual(done.stderr, "")
        left = self.folder / "out" / "scans"
        self.assertEqual(list(left.iterdir()) if left.exists() else [], [])


if __name__ == "__main__":
    unittest.main()
