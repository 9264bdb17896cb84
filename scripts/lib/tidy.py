"""Runs clang-tidy over the core's sources, in parallel; a file whose inputs did not change since it passed is skipped.

usage: tidy.py BUILD_FOLDER CACHE_FOLDER   (BUILD_FOLDER holds compile_commands.json and, once built, Ninja's dependencies)
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def project_headers(build):
    """Object file -> our own headers that it was compiled with."""
    listing = subprocess.run(["ninja", "-C", build, "-t", "deps"], capture_output=True, text=True, check=False).stdout
    headers, current = {}, None
    for line in listing.splitlines():
        if not line.startswith(" "):
            current = line.split(":")[0]
            headers[current] = []
        elif line.strip().startswith(str(ROOT / "core")):
            headers[current].append(line.strip())
    return headers


def digest(paths, salt):
    total = hashlib.sha256(salt)
    for path in sorted(set(paths)):
        total.update(path.encode() + b"\0")
        total.update(pathlib.Path(path).read_bytes() if os.path.exists(path) else b"missing")
    return total.hexdigest()


def main():
    build, cache = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    cache.mkdir(parents=True, exist_ok=True)
    salt = (ROOT / ".clang-tidy").read_bytes()
    all_headers = [str(path) for path in (ROOT / "core").rglob("*.h")]
    known = project_headers(build)
    # clang-tidy cannot read the compiler's precompiled header, and without it sees an #include that is missing.
    commands = re.sub(r"-Winvalid-pch -include \S+/cmake_pch\.hxx ", "", (build / "compile_commands.json").read_text())
    (cache / "compile_commands.json").write_text(commands)
    jobs = []
    for entry in json.loads(commands):
        source = entry["file"]
        # The launcher, in C, asks for processor levels by names that this clang does not know yet.
        if not source.startswith(str(ROOT / "core")) or not source.endswith(".cpp") or not os.path.exists(source):
            continue
        stamp = cache / digest([source, *known.get(entry.get("output", ""), all_headers)], salt)
        if not stamp.exists():
            jobs.append((source, stamp))

    def check(job):
        source, stamp = job
        run = subprocess.run(["clang-tidy", "--quiet", "-p", str(cache), source],
                             capture_output=True, text=True, check=False)
        if run.returncode == 0:
            stamp.touch()
        return source, run

    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, run in pool.map(check, jobs):
            if run.returncode != 0:
                failed += 1
                print(os.path.relpath(source, ROOT))
                print(run.stdout or run.stderr, flush=True)
    print(f"clang-tidy: {len(jobs)} files checked, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
