"""A Slurm of one node on this machine, run by the current user in a temporary folder, without systemd or cgroups."""
import getpass
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import time

CONF = """\
ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge/socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
KillWait=5
MinJobAge=3600
SchedulerParameters=sched_min_interval=100000,batch_sched_delay=1
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=60 State=UP
"""


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def wait_until(condition, what, seconds=120):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(f"{what}: not within {seconds} s")
        time.sleep(0.2)


class OneNodeSlurm:
    """Context manager with a folder of its own; `environment` makes Slurm's commands talk to this Slurm."""

    def __init__(self, cpus):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="one-node-slurm-"))
        # munged wants a socket that everybody can reach.
        self.folder.chmod(0o711)
        self.daemons = []
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}
        for name in ("munge", "state", "spool"):
            (self.folder / name).mkdir(mode=0o755)
        key = self.folder / "munge" / "key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        conf = CONF.format(folder=self.folder, host=socket.gethostname().split(".")[0], user=getpass.getuser(), cpus=cpus,
                           controller_port=free_port(), node_port=free_port())
        (self.folder / "slurm.conf").write_text(conf)

    def start(self, *command):
        log = open(self.folder / (os.path.basename(command[0]) + ".out"), "wb")
        path = os.environ["PATH"] + ":/usr/sbin:/sbin"
        self.daemons.append(subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                             env={**self.environment, "PATH": path}, start_new_session=True))
        log.close()

    def __enter__(self):
        munge = self.folder / "munge"
        try:
            self.start("/usr/sbin/munged", "--foreground", "--num-threads=2", f"--key-file={munge}/key", f"--socket={munge}/socket",
                       f"--pid-file={munge}/pid", f"--log-file={munge}/log", f"--seed-file={munge}/seed")
            wait_until(lambda: self.alive() and (munge / "socket").exists(), "munged's socket", 30)
            self.start("/usr/sbin/slurmctld", "-D", "-i")
            self.start("/usr/sbin/slurmd", "-D")
            wait_until(lambda: self.alive() and "idle" in self.run("sinfo", "-h", "-o", "%T", check=False), "an idle node", 60)
        except BaseException:
            print(self.logs())
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if len(self.daemons) > 1:
            subprocess.run(["scancel", "--user", getpass.getuser()], env=self.environment, capture_output=True, timeout=60)
            try:
                wait_until(lambda: not self.run("squeue", "-h", check=False).strip(), "an empty queue", 20)
            except TimeoutError:
                pass
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        self.daemons = []
        shutil.rmtree(self.folder, ignore_errors=True)

    def run(self, *command, check=True, **options):
        done = subprocess.run(command, env={**self.environment, **options.pop("environment", {})}, capture_output=True,
                              text=True, **options)
        if check and done.returncode != 0:
            raise RuntimeError(f"{command}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    def alive(self):
        """Raises if a daemon ended by itself."""
        for daemon in self.daemons:
            if daemon.poll() is not None:
                raise RuntimeError(f"{daemon.args[0]} ended with exit status {daemon.returncode}")
        return True

    def logs(self):
        files = sorted([*self.folder.glob("*.out"), *self.folder.glob("*.log"), *self.folder.glob("munge/log")])
        return "\n".join(f"-- {file.name}\n{file.read_text(errors='replace')}" for file in files)
