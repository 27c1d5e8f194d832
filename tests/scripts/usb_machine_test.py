"""Which guest scripts/usb-machine takes: user-mode Linux where it starts, else qemu, else none, and why.

The kernel, its build and qemu are played by shell scripts that run the guest's job here or die as the real ones do.
"""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"

DIES_AS_WITH_AMX = """echo 'Checking PROT_EXEC mmap in /tmp...OK'
echo 'ptrace set fp regs failed, errno = 14'
echo 'Aborted'
exit 134
"""
RUNS_THE_JOB = """for word in "$@"; do [[ $word != kerf_job=* ]] || KERF_JOB=${word#*=}; done
: >"$KERF_JOB/started"
bash "$KERF_JOB/command" >"$KERF_JOB/output" 2>&1
echo $? >"$KERF_JOB/status"
"""


def script(path, text):
    path.write_text("#!/usr/bin/env bash\n" + text)
    path.chmod(0o755)


class UsbMachine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        parts = self.folder / "scripts" / "usb-machine.d"
        parts.mkdir(parents=True)
        shutil.copy(SCRIPTS / "usb-machine", parts.parent)
        for name in ("find-kernel", "run-uml"):
            shutil.copy(SCRIPTS / "usb-machine.d" / name, parts)
        self.parts = parts
        script(parts / "build-kernel", f"echo {self.folder}/linux")
        script(parts / "run-qemu", "echo qemu >&2\n" + RUNS_THE_JOB)

    def kernel(self, text):
        script(self.folder / "linux", f"echo boot >>{self.folder}/boots\n" + text)

    def boots(self):
        return len((self.folder / "boots").read_text().splitlines())

    def run_machine(self, *arguments):
        environment = {**os.environ, "TMPDIR": str(self.folder)}
        return subprocess.run([self.folder / "scripts" / "usb-machine", *arguments], env=environment, capture_output=True,
                              text=True, check=False)

    def test_is_user_mode_linux_where_it_starts(self):
        self.kernel(RUNS_THE_JOB)
        result = self.run_machine("sh", "-c", "echo within; exit 5")
        self.assertEqual((result.returncode, result.stdout, result.stderr), (5, "within\n", ""))

    def test_tries_a_kernel_once(self):
        self.kernel(RUNS_THE_JOB)
        for _ in range(3):
            self.assertEqual(self.run_machine("--virtual-time", "true").returncode, 0)
        self.assertEqual(self.boots(), 1 + 3)

    def test_is_qemu_where_the_kernel_is_built_and_does_not_start(self):
        self.kernel(DIES_AS_WITH_AMX)
        result = self.run_machine("sh", "-c", "echo within; exit 5")
        self.assertEqual((result.returncode, result.stdout), (5, "within\n"))
        self.assertEqual(result.stderr, "usb-machine: user-mode Linux does not start on this machine (ptrace set fp regs failed, "
                                        "errno = 14); taking qemu instead\nqemu\n")
        before = self.boots()
        self.assertEqual(self.run_machine("true").returncode, 0)
        self.assertEqual(self.boots(), before, "what the trial said was not kept")

    def test_has_no_virtual_time_where_the_kernel_does_not_start(self):
        self.kernel(DIES_AS_WITH_AMX)
        result = self.run_machine("--virtual-time", "true")
        self.assertEqual(result.returncode, 77)
        self.assertEqual(result.stderr.splitlines()[-1],
                         "usb-machine: no virtual time here, for qemu has none and user-mode Linux does not start on this "
                         "machine (ptrace set fp regs failed, errno = 14)")

    def test_says_why_the_kernel_cannot_be_built(self):
        script(self.parts / "build-kernel", "echo 'there is no compiler'\nexit 1")
        self.assertIn("there is no compiler; taking qemu instead", self.run_machine("true").stderr)
        result = self.run_machine("--virtual-time", "true")
        self.assertEqual(result.returncode, 77)
        self.assertTrue(result.stderr.endswith("qemu has none and there is no compiler\n"), result.stderr)

    def test_tries_again_after_a_day(self):
        self.kernel(DIES_AS_WITH_AMX)
        self.assertEqual(self.run_machine("--virtual-time", "true").returncode, 77)
        self.kernel(RUNS_THE_JOB)
        self.assertEqual(self.run_machine("--virtual-time", "true").returncode, 77)
        (verdict,) = self.folder.glob("linux-on-*")
        os.utime(verdict, (0, 0))
        self.assertEqual(self.run_machine("--virtual-time", "true").returncode, 0)

    def test_fails_where_a_kernel_that_did_start_dies(self):
        self.kernel(RUNS_THE_JOB)
        self.assertEqual(self.run_machine("true").returncode, 0)
        self.kernel(DIES_AS_WITH_AMX)
        result = self.run_machine("true")
        self.assertEqual(result.returncode, 1)
        self.assertIn("errno = 14", result.stderr)

    def test_there_is_none_where_qemu_does_not_start_either(self):
        self.kernel(DIES_AS_WITH_AMX)
        script(self.parts / "run-qemu", "echo 'usb-machine: it could not be downloaded' >&2\nexit 77")
        result = self.run_machine("true")
        self.assertEqual(result.returncode, 77)
        self.assertTrue(result.stderr.endswith("it could not be downloaded\n"), result.stderr)
        script(self.parts / "run-qemu", "echo 'no acceleration' >$KERF_JOB/console\nexit 1")
        result = self.run_machine("true")
        self.assertEqual(result.returncode, 77)
        self.assertIn("no acceleration\nusb-machine: qemu does not start here", result.stderr)


if __name__ == "__main__":
    unittest.main()
