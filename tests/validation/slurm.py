#!/usr/bin/env python3
"""A study on a real Slurm (private_slurm.py): the same rows as here, nothing twice in the queue, and what is killed is run again.

usage: slurm.py FELDSPAR

Exit code 0: fine; 1: something is wrong (said in words); 77: Slurm is not installed (skipped).
"""
import os
import pathlib
import re
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

from private_slurm import SKIPPED, PrivateSlurm, missing_programs

JOB = """\
[specimen]
shape = "rectangle"
width = "50 mm"
height = "100 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "7 mm", maximum = "11 mm" }
porosity = 0.10
[material.grain]
E = "25.8 GPa"
nu = 0.23
[material.contact]
Kn = "18.00e4 GPa/m"
eta = 0.28
sigma_nt = "8.5 MPa"
tau = "29.75 MPa"
mu = 0.40
Gfn = "20 N/m"
Gfs = "800 N/m"
[numerics]
kind = "adaptive"
accuracy = "ACCURACY"
[[test]]
kind = "uniaxial-compression"
[[test]]
kind = "direct-tension"
[[test]]
kind = "brazilian"
diameter = "50 mm"
"""
STUDY = """\
job = "job.toml"
seeds = [1, 2, 3]
[[axis]]
name = "grains"
[[axis.value]]
label = "rigid"
set = { model.kind = "rigid" }
[[axis.value]]
label = "flexible"
set = { model.kind = "flexible" }
"""
# Runs of seconds, so that there is time to disturb them.
LONG_STUDY = """\
job = "job.toml"
seeds = [1, 2, 3, 4]
tests = ["uniaxial-compression"]
"""
# What a run's row says of the machine and the moment, not of the rock.
CIRCUMSTANCES = {"wall_s", "ms_per_step", "threads", "started", "command_line", "holder", "heard"}


class Study:
    """A small study in a directory of its own, and the program that runs it."""

    def __init__(self, program, slurm, place, accuracy, study=STUDY):
        self.program, self.slurm, self.place = program, slurm, pathlib.Path(place)
        self.place.mkdir()
        (self.place / "job.toml").write_text(JOB.replace("ACCURACY", accuracy))
        (self.place / "study.toml").write_text(study)

    def run(self, *arguments, code=0):
        """Calls the program and asks for this exit code. Returns what it printed."""
        command = [self.program, "study", *arguments]
        done = subprocess.run(command, cwd=self.place, env=self.slurm.environment, capture_output=True, text=True, timeout=300)
        check(done.returncode == code, f"exit code {done.returncode}, not {code}: {' '.join(command)}\n{done.stdout}{done.stderr}{self.output()}")
        return done.stdout

    def submit(self, *arguments, **options):
        return self.run("study.toml", "--results", "there", "--on", "slurm", *arguments, **options)

    def rows(self, results):
        """The ledger's rows by the run's number, every digit."""
        ledger = sqlite3.connect(f"file:{self.place / results / 'ledger.sqlite'}?mode=ro", uri=True)
        ledger.row_factory = sqlite3.Row
        rows = [dict(row) for row in ledger.execute("SELECT * FROM run")]
        ledger.close()
        return {row["id"]: {key: value for key, value in row.items() if key not in CIRCUMSTANCES} for row in rows}

    def output(self):
        """What the elements and the gathering jobs have printed, for messages."""
        return "".join(f"--- {file}\n{file.read_text()}" for file in sorted(self.place.glob("there/slurm/*/*.out")))


def check(holds, message):
    if not holds:
        raise SystemExit(message)


def job_number(printed):
    found = re.search(r"of job (\d+); job (\d+)", printed)
    check(found, f"no job was submitted: {printed}")
    return found.group(1)


def element_state(slurm, job, element):
    return slurm.ask("squeue", "-h", "-o", "%T", "-j", f"{job}_{element}").stdout.strip()


def program_of_element(place, element):
    """The number of the process that runs an element's group below this directory, if there is one."""
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().decode().split("\0")
            if words[1:5] == ["study", "element", ".", str(element)] and pathlib.Path(os.readlink(process / "cwd")).is_relative_to(place):
                return int(process.name)
        except OSError:
            continue   # has just ended
    return None


def has_the_same_rows(program, slurm, place):
    study = Study(program, slurm, place / "rows", "2 %")
    start = time.monotonic()
    study.run("study.toml", "--results", "here")
    middle = time.monotonic()
    study.submit("--wait", "--group-minutes", "0.02")
    end = time.monotonic()
    here, there = study.rows("here"), study.rows("there")
    check(len(here) == 18, f"{len(here)} rows, not 18")
    check(here == there, "the rows differ:\n" + "\n".join(
        f"{run} {key}: {here[run][key]!r} here, {there.get(run, {}).get(key)!r} there"
        for run in here for key in here[run] if here[run][key] != there.get(run, {}).get(key)))
    check("Nothing to submit" in study.submit(), "a study that is done was submitted again")
    print(f"the same rows: {len(here)} runs, {middle - start:.1f} s here, {end - middle:.1f} s by way of Slurm")


def submits_nothing_twice(program, slurm, place):
    study = Study(program, slurm, place / "twice", "10 %")
    slurm.ask("scontrol", "update", "partition=debug", "state=down")
    first = job_number(study.submit("--group-minutes", "0.001", "--array-limit", "2"))
    again = study.submit("--group-minutes", "0.001")
    check("18 runs already in Slurm's queue" in again and "Nothing to submit" in again, f"submitted twice: {again}")
    check(f"Slurm job {first}: 0/18 runs" in study.run("status", "study.toml", "--results", "there"), "the status does not tell of the queue")
    slurm.ask("scontrol", "update", "partition=debug", "state=up")
    study.submit("--wait")
    check(all(row["state"] == "done" for row in study.rows("there").values()), "not all runs are done")
    print("nothing twice")


def ends_before_its_time_is_over(program, slurm, place):
    """A run that would take hours, with a minute to live: Slurm says when there is half a minute left."""
    study = Study(program, slurm, place / "late", "0.05 %", LONG_STUDY.replace("[1, 2, 3, 4]", "[1]"))
    job_file = study.place / "job.toml"
    job_file.write_text(job_file.read_text().replace('kind = "adaptive"\naccuracy = "0.05 %"', 'kind = "paper"\nspeed = "1e-12 m"'))
    printed = study.submit("--wait", "--time", "1", code=3)
    check("it was asked to stop, near its time limit" in printed, f"no word of the time limit: {printed}")
    check("0 done now, 0 before, 0 failed, 1 left" in study.output(), f"the element did not end cleanly: {study.output()}")
    check(not list(study.place.glob("there/runs/*")), "an interrupted run has left something")
    print("ended before its time was over")


def runs_again_what_was_killed(program, slurm, place):
    """One element cancelled, one requeued, and the program of a third killed."""
    study = Study(program, slurm, place / "killed", "0.05 %", LONG_STUDY)
    job = job_number(study.submit("--group-minutes", "0.0001"))
    check(slurm.patiently(lambda: all(program_of_element(study.place, k) for k in (0, 1, 3)), 30),
          f"the elements do not run:\n{slurm.ask('squeue').stdout}")
    slurm.ask("scancel", f"{job}_0")
    slurm.ask("scontrol", "requeue", f"{job}_1")
    os.kill(program_of_element(study.place, 3), signal.SIGKILL)
    check(slurm.patiently(lambda: element_state(slurm, job, 1) == "PENDING" and "1 left" in study.output(), 30), "the requeued element does not wait")
    time.sleep(2)   # for what Slurm has to clear away
    slurm.ask("scontrol", "update", f"jobid={job}_1", "starttime=now")   # Slurm lets it wait for two minutes
    check(slurm.patiently(lambda: not slurm.ask("squeue", "-h").stdout.strip(), 120), f"the jobs do not end:\n{slurm.ask('squeue').stdout}")
    gathered = study.run("gather", "study.toml", "--results", "there", code=3)
    check(f"element {job}_0: it was cancelled" in gathered, f"no word of the cancelled element: {gathered}")
    check(re.search(rf"element {job}_3: Slurm says FAILED, exit code 0:9", gathered), f"no word of the killed element: {gathered}")
    check("2 not done" in gathered, f"not two runs are missing: {gathered}")
    again = study.submit("--wait")
    check("Submitted 2 runs" in again, f"not only what is missing was submitted: {again}")
    study.run("study.toml", "--results", "here")
    check(study.rows("here") == study.rows("there"), "the rows differ after a cancelled, a requeued and a killed element")
    print("killed, requeued and run again")


def main():
    missing = missing_programs()
    if missing:
        print(f"skipped: {', '.join(missing)} not installed (Debian: munge slurmctld slurmd slurm-client)")
        return SKIPPED
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))   # a test that takes too long still takes its daemons down
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory(prefix="feldspar-slurm-studies-") as place, PrivateSlurm() as slurm:
        for proof in (has_the_same_rows, submits_nothing_twice, runs_again_what_was_killed, ends_before_its_time_is_over):
            proof(program, slurm, pathlib.Path(place))
    return 0


if __name__ == "__main__":
    sys.exit(main())
