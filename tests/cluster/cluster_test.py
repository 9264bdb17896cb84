"""A cohort on a real Slurm of one node, from the installed program: one scan broken, a job killed midway, then resumed."""
import csv
import getpass
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

from cohort_scans import ROOT, write_cohort
from one_node_slurm import OneNodeSlurm, wait_until

CPUS = os.cpu_count() or 1
CHUNK = 3


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Cohort(unittest.TestCase):
    """One Slurm, one installation for all tests; each test has its own scans and results."""

    @classmethod
    def setUpClass(cls):
        place = tempfile.TemporaryDirectory(prefix="cohort-")
        cls.addClassCleanup(place.cleanup)
        cls.place = pathlib.Path(place.name)
        build = os.environ.get("VITRUVIAN_BUILD", ROOT / "build" / "native")
        subprocess.run(["cmake", "--install", build, "--prefix", cls.place / "built"], check=True, stdout=subprocess.DEVNULL)
        # What was installed can be moved.
        cls.prefix = (cls.place / "built").rename(cls.place / "moved")
        cls.tools = cls.prefix / "share" / "vitruvian" / "cluster"
        cls.slurm = OneNodeSlurm(CPUS).__enter__()
        cls.addClassCleanup(cls.slurm.__exit__)
        cls.slurm.environment.update(PATH=f"{cls.prefix}/bin:{os.environ['PATH']}", VITRUVIAN_CLUSTER=str(cls.tools))

    def make(self, name, count, broken):
        """Folder, list and result folder of a cohort whose scan `broken` is cut off."""
        folder = self.place / name
        scans = write_cohort(folder / "scans", count)
        path = scans[broken][0]
        path.write_bytes(path.read_bytes()[:100_000])
        (folder / "scans.tsv").write_text(self.slurm.run(self.tools / "cohort.py", "list", folder / "scans"))
        self.sizes = {str(path): size for path, size in scans}
        self.broken = str(path)
        return folder

    @staticmethod
    def at_work(folder, own="*"):
        return any((folder / "out" / "scans").glob(f".{own}.??????"))

    def merge(self, folder):
        done = subprocess.run([self.tools / "cohort.py", "merge", folder / "scans.tsv", folder / "out"], capture_output=True,
                              text=True)
        print(done.stdout, done.stderr, flush=True)
        return done.returncode, rows_of(folder / "out" / "cohort.csv")

    def check_table(self, folder, rows):
        """Every scan once; sizes in the measurements as the scans were made; the broken one with its reason."""
        listed = [line.split("\t") for line in (folder / "scans.tsv").read_text().splitlines()]
        self.assertEqual([[r["id"], r["scan"]] for r in rows], listed)
        self.assertEqual({r["scan"] for r in rows}, set(self.sizes))
        statures = []
        for row in rows:
            if row["scan"] == self.broken:
                self.assertEqual(row["verdict"], "error")
                self.assertIn(self.broken, row["reasons"])
                self.assertEqual({row["confidence"], row["surface_mean_mm"], row["stature_mm"]}, {"NA"})
                continue
            self.assertEqual(row["verdict"], "ok", row)
            self.assertLess(float(row["surface_mean_mm"]), 5)
            statures.append(float(row["stature_mm"]) / self.sizes[row["scan"]])
        self.assertLess(max(statures) / min(statures), 1.01)
        measurements = rows_of(folder / "out" / "measurements.csv")
        self.assertEqual({m["id"] for m in measurements}, {r["id"] for r in rows if r["verdict"] == "ok"})
        stature = {m["id"]: m["value_mm"] for m in measurements if (m["dimension"], m["posture"]) == ("stature", "standard")}
        self.assertEqual(stature, {r["id"]: r["stature_mm"] for r in rows if r["verdict"] == "ok"})
        self.assertEqual(sorted(p.name for p in (folder / "out" / "scans").iterdir()), sorted(r["id"] for r in rows))

    def test_installed_program_brings_all_but_the_c_library(self):
        listed = subprocess.run(["ldd", self.prefix / "bin" / "vitruvian"], capture_output=True, text=True, check=True).stdout
        resolved = dict(line.strip().split(" => ") for line in listed.splitlines() if " => " in line)
        own = {name for name, where in resolved.items() if os.path.realpath(where.split(" (")[0]).startswith(f"{self.prefix}/lib/")}
        self.assertIn("libopencv_dnn.so.406", own)
        self.assertLessEqual(set(resolved) - own, {"libc.so.6", "libm.so.6", "linux-vdso.so.1"})
        notices = {p.stem for p in (self.prefix / "share/doc/vitruvian/licences/libraries").iterdir()}
        self.assertLessEqual({"libopencv-dnn406", "libprotobuf32", "libstdc++6", "libx11-6"}, notices)

    def test_array_killed_midway_and_resumed(self):
        count = 24
        folder = self.make("array", count, broken=7)
        out, scans = folder / "out", folder / "out" / "scans"
        ids = [line.split("\t")[0] for line in (folder / "scans.tsv").read_text().splitlines()]

        def submit():
            text = self.slurm.run("sbatch", "--parsable", f"--array=0-{(count - 1) // CHUNK}", "--cpus-per-task=1", "--mem=0",
                                  f"--export=ALL,CHUNK={CHUNK}", self.tools / "register_array.sbatch", "scans.tsv", "out",
                                  cwd=folder)
            return text.strip()

        def ended(job):
            return not self.slurm.run("squeue", "-h", "-j", job).strip()

        job = submit()
        # The second chunk's second scan: the job has one result, is at work on the next, and has one before it.
        done, victim, waiting = ids[CHUNK : 2 * CHUNK]
        wait_until(lambda: self.at_work(folder, victim), "the second scan of the second job")
        self.slurm.run("scancel", f"{job}_1")
        print(f"killed {job}_1 at {victim}\n", self.slurm.run("squeue"), flush=True)
        wait_until(lambda: ended(job), "the end of the array", 500)
        jobs = self.slurm.run("scontrol", "show", "job", "-o", job)
        print("\n".join(" ".join(w for w in line.split() if w.startswith(("JobId", "ArrayTaskId", "JobState", "ExitCode", "RunTime")))
                        for line in jobs.splitlines()), flush=True)
        self.assertEqual([jobs.count(f"JobState={s} ") for s in ("CANCELLED", "COMPLETED")], [1, (count - 1) // CHUNK])

        status, rows = self.merge(folder)
        verdicts = {r["id"]: r["verdict"] for r in rows}
        self.assertEqual(status, 1)
        self.assertEqual([i for i in ids if verdicts[i] == "missing"], [victim, waiting])
        self.assertEqual(verdicts[done], "ok")

        kept = {i: (scans / i / "status.json").stat().st_mtime_ns for i in ids if verdicts[i] != "missing"}
        begin = time.monotonic()
        job = submit()
        wait_until(lambda: ended(job), "the end of the second array", 500)
        print(f"resumed in {time.monotonic() - begin:.0f} s")
        status, rows = self.merge(folder)
        self.assertEqual(status, 0)
        self.check_table(folder, rows)
        self.assertEqual(kept, {i: (scans / i / "status.json").stat().st_mtime_ns for i in kept})

        # The same as by hand.
        subprocess.run([self.prefix / "bin" / "vitruvian", "register", rows[0]["scan"], "--out", folder / "hand", "--threads", "1",
                        "--quiet"], check=True)
        by_hand, by_job = (json.loads(p.read_text()) for p in
                           (next((folder / "hand").glob("*/registration.json")), out / "scans" / ids[0] / "registration.json"))
        for registration in (by_hand, by_job):
            del registration["timing_ms"]
        self.assertEqual(by_hand, by_job)

    def test_snakemake_on_slurm_killed_and_resumed(self):
        folder = self.make("snakemake", 4, broken=2)
        profile = folder / "profile"
        shutil.copytree(self.tools / "profile", profile)
        config = (profile / "config.yaml").read_text()
        # This node has no memory to give away, and few cores.
        (profile / "config.yaml").write_text(config.replace("--mem={resources.mem_mb}", "--mem=0"))
        command = ["snakemake", "-s", str(self.tools / "Snakefile"), "--profile", str(profile), "--config", "list=scans.tsv",
                   "out=out", "--set-threads", "register=1", "--groups", "register=scans", "--group-components", "scans=2"]

        def run(log):
            with open(folder / log, "w") as file:
                return subprocess.Popen(command, cwd=folder, env=self.slurm.environment, stdin=subprocess.DEVNULL, stdout=file,
                                        stderr=file, start_new_session=True)

        self.addCleanup(lambda: print(*(f"-- {log.name}\n{log.read_text()}" for log in sorted(folder.glob("*.log"))), sep="\n"))
        # Snakemake and all its jobs are killed, then it is run again.
        first = run("first.log")
        wait_until(lambda: self.at_work(folder), "a scan at work")
        first.kill()
        first.wait()
        self.slurm.run("scancel", "--user", getpass.getuser())
        wait_until(lambda: not self.slurm.run("squeue", "-h").strip(), "an empty queue")
        self.assertEqual(self.merge(folder)[0], 1)

        # One job is killed this time, and Snakemake sends it once more.
        subprocess.run([*command, "--unlock"], cwd=folder, env=self.slurm.environment, check=True, capture_output=True)
        second = run("second.log")
        self.addCleanup(second.kill)
        wait_until(lambda: self.at_work(folder), "a scan at work")
        self.slurm.run("scancel", self.slurm.run("squeue", "-h", "--states=RUNNING", "-o", "%i").split()[0])
        self.assertEqual(second.wait(500), 0)
        self.check_table(folder, rows_of(folder / "out" / "cohort.csv"))


if __name__ == "__main__":
    unittest.main()
