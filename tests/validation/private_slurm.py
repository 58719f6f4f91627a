#!/usr/bin/env python3
"""A Slurm of one's own: munged, slurmctld and slurmd on the loopback device, in a temporary directory and on free ports.

usage: private_slurm.py COMMAND [ARGUMENT ...]     runs the command with this Slurm, then takes it down

Needs Debian's packages munge, slurmctld, slurmd and slurm-client; neither systemd nor accounting nor control groups. Nothing outside
the temporary directory is touched, another Slurm on the machine is not disturbed, and the daemons end with the program that
started them, whatever ends that.
"""
import contextlib
import ctypes
import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo"]
PATH = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
SKIPPED = 77
CPUS = 4   # of the node: as Slurm counts, not as there are

CONFIGURATION = """\
ClusterName=feldspar
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={home}/munge/socket
CryptoType=crypto/munge
CredType=cred/munge
StateSaveLocation={home}/state
SlurmdSpoolDir={home}/spool
SlurmctldPidFile={home}/slurmctld.pid
SlurmdPidFile={home}/slurmd.pid
SlurmctldLogFile={home}/slurmctld.log
SlurmdLogFile={home}/slurmd.log
ProctrackType=proctrack/{tracking}
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=1,sched_interval=1,sched_min_interval=0,batch_sched_delay=0
ReturnToService=2
MinJobAge=30
KillWait=5
InactiveLimit=0
SlurmctldTimeout=30
SlurmdTimeout=60
SlurmdParameters=config_overrides
NodeName=loopback NodeHostname={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=debug Nodes=loopback Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
"""


def missing_programs():
    """Those programs of Slurm that are not installed."""
    return [name for name in PROGRAMS if shutil.which(name, path=PATH) is None]


def free_ports(count):
    """So many ports of the loopback device that nobody listens on."""
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


def end_with_parent():
    """In the child: a kill of this program, even by SIGKILL, ends the daemon too."""
    ctypes.CDLL(None).prctl(1, signal.SIGTERM)   # PR_SET_PDEATHSIG


class PrivateSlurm:
    """with PrivateSlurm() as slurm: subprocess.run(["sbatch", ...], env=slurm.environment)"""

    def __init__(self, cpus=CPUS):
        self.cpus = cpus
        self.daemons = []

    def __enter__(self):
        self.home = pathlib.Path(tempfile.mkdtemp(prefix="feldspar-slurm-"))
        self.home.chmod(0o755)   # munge asks for a path that everybody may pass
        self.environment = {**os.environ, "PATH": PATH, "SLURM_CONF": str(self.home / "slurm.conf")}
        for name in [name for name in self.environment if name.startswith(("SLURM_", "SBATCH_", "SQUEUE_")) and name != "SLURM_CONF"]:
            del self.environment[name]   # of a job of another Slurm in which this may be running
        try:
            self.configure()
            self.start("munged", "--foreground", f"--key-file={self.home}/munge/key", f"--socket={self.home}/munge/socket",
                       f"--pid-file={self.home}/munge/pid", f"--log-file={self.home}/munge/log", f"--seed-file={self.home}/munge/seed")
            self.wait_for("munged", lambda: (self.home / "munge/socket").exists())
            self.start("slurmctld", "-D", "-c", "-f", self.environment["SLURM_CONF"])
            self.wait_for("slurmctld", lambda: self.ask("scontrol", "ping").returncode == 0)
            self.start("slurmd", "-D", "-c", "-f", self.environment["SLURM_CONF"])
            self.wait_for("slurmd", lambda: self.ask("sinfo", "-h", "-o", "%t").stdout.strip() == "idle")
        except BaseException:
            self.__exit__(*sys.exc_info())
            raise
        return self

    def __exit__(self, *_):
        if self.daemons and self.environment:
            self.ask("scancel", "--full", "--signal=KILL", "--user", pwd.getpwuid(os.getuid()).pw_name)
            self.ask("scancel", "--user", pwd.getpwuid(os.getuid()).pw_name)
            self.patiently(lambda: not self.ask("squeue", "-h").stdout.strip(), 15)
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        shutil.rmtree(self.home, ignore_errors=True)

    def configure(self):
        """Writes slurm.conf, munge's key and the directories."""
        for name in ["munge", "state", "spool"]:
            (self.home / name).mkdir(mode=0o755)
        key = self.home / "munge/key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        controller_port, node_port = free_ports(2)
        (self.home / "slurm.conf").write_text(CONFIGURATION.format(
            host=socket.gethostname(), user=pwd.getpwuid(os.getuid()).pw_name, home=self.home, cpus=self.cpus,
            tracking="linuxproc" if os.getuid() == 0 else "pgid", controller_port=controller_port, node_port=node_port))
        (self.home / "cgroup.conf").write_text("CgroupAutomount=no\n")

    def start(self, program, *arguments):
        with open(self.home / f"{program}.out", "wb") as output:
            self.daemons.append(subprocess.Popen([shutil.which(program, path=PATH), *arguments], stdin=subprocess.DEVNULL, stdout=output,
                                                 stderr=output, env=self.environment, preexec_fn=end_with_parent))

    def ask(self, *command, timeout=20):
        """Runs one of Slurm's programs."""
        try:
            return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=timeout)
        except subprocess.TimeoutExpired as late:
            return subprocess.CompletedProcess(command, 1, "", str(late))

    @staticmethod
    def patiently(condition, seconds):
        """Whether the condition holds within so many seconds."""
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                return False
            time.sleep(0.1)
        return True

    def wait_for(self, program, condition):
        ended = lambda: self.daemons[-1].poll() is not None
        if not self.patiently(lambda: ended() or condition(), 60) or ended():
            raise RuntimeError(f"{program} does not start:\n{self.logs()}")

    def logs(self):
        """What the daemons have said last."""
        return "\n".join(f"--- {log.name}\n{log.read_text(errors='replace')[-3000:]}"
                         for log in sorted([*self.home.glob("*.out"), *self.home.glob("*.log")]))


def main():
    missing = missing_programs()
    if missing:
        print(f"skipped: {', '.join(missing)} not installed", file=sys.stderr)
        return SKIPPED
    with PrivateSlurm() as slurm:
        return subprocess.run(sys.argv[1:], env=slurm.environment).returncode


if __name__ == "__main__":
    sys.exit(main())
