"""What scripts/test.d/run_tests.py says of a run, from JUnit files as ctest 3.25 writes them."""

import os
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts" / "test.d"
sys.path.insert(0, str(SCRIPTS))

import run_tests  # noqa: E402
from run_tests import Allowance, Failure, Outcome, Skip  # noqa: E402


def junit(*cases):
    return '<?xml version="1.0"?><testsuite name="(empty)">' + "".join(cases) + "</testsuite>"


def case(name, status, output="", skipped=None):
    reason = f'<skipped message="{skipped}"/>' if skipped else ""
    return f'<testcase name="{name}" status="{status}">{reason}<system-out>{output}</system-out></testcase>'


SKIPPED_CASE = """[ RUN      ] Grasper.IsRead
/house/tests/import_test.cpp:26: Skipped
no measured data at /house/data
the second line of the message

[  SKIPPED ] Grasper.IsRead (0 ms)
[  PASSED  ] 0 tests.
[  SKIPPED ] 1 test, listed below:
[  SKIPPED ] Grasper.IsRead
"""

SUITE = SKIPPED_CASE.split("[  PASSED")[0] + """[ RUN      ] Grasper.Turns
[       OK ] Grasper.Turns (3 ms)
[ RUN      ] Grasper.Holds
/house/a.cpp:7: Failure
Expected: 1
[  FAILED  ] Grasper.Holds (0 ms)
[ RUN      ] Grasper.Opens/0
/house/a.cpp:9: Failure
[  FAILED  ] Grasper.Opens/0, where GetParam() = 4 (0 ms)
[  FAILED  ] 2 tests, listed below:
[  FAILED  ] Grasper.Holds
"""


class Outcomes(unittest.TestCase):
    def test_counts_what_passed_failed_and_was_skipped(self):
        outcome = run_tests.outcome_of(junit(case("A", "run"), case("B", "run"), case("C", "fail"),
                                             case("D", "notrun", "skipped: no Chromium\n", "SKIP_RETURN_CODE=77")))
        self.assertEqual(outcome, Outcome(2, [Failure("C", ())], [Skip("D", "no Chromium")]))

    def test_takes_the_reason_of_an_exit_status_from_the_last_line(self):
        output = "building\nno virtual time here\n\n"
        outcome = run_tests.outcome_of(junit(case("usb.U6", "notrun", output, "SKIP_RETURN_CODE=77")))
        self.assertEqual(outcome.skips, [Skip("usb.U6", "no virtual time here")])

    def test_takes_the_reason_of_a_googletest_skip_from_its_first_line(self):
        outcome = run_tests.outcome_of(
            junit(case("Grasper.IsRead", "notrun", SKIPPED_CASE, "SKIP_REGULAR_EXPRESSION_MATCHED")))
        self.assertEqual(outcome, Outcome(0, [], [Skip("Grasper.IsRead", "no measured data at /house/data")]))

    def test_finds_the_skip_inside_a_suite_that_passed_or_failed(self):
        for status in ("run", "fail"):
            outcome = run_tests.outcome_of(junit(case("usb.Grasper", status, SKIPPED_CASE)))
            self.assertEqual(outcome.passed, 0)
            self.assertEqual(len(outcome.failures), status == "fail")
            self.assertEqual(outcome.skips, [Skip("usb.Grasper: Grasper.IsRead", "no measured data at /house/data")])

    def test_counts_and_names_each_case_of_a_suite(self):
        outcome = run_tests.outcome_of(junit(case("Grasper", "fail", SUITE)))
        self.assertEqual(outcome, Outcome(1, [Failure("Grasper.Holds", ("/house/a.cpp:7: Failure", "Expected: 1")),
                                              Failure("Grasper.Opens/0", ("/house/a.cpp:9: Failure",))],
                                          [Skip("Grasper.IsRead", "no measured data at /house/data")]))

    def test_names_the_case_in_which_a_program_ended(self):
        output = "[ RUN      ] Grasper.Holds\n[       OK ] Grasper.Holds (1 ms)\n[ RUN      ] Grasper.Opens\nheap-use-after-free\n"
        self.assertEqual(run_tests.outcome_of(junit(case("Grasper", "fail", output))),
                         Outcome(1, [Failure("Grasper.Opens", ("heap-use-after-free",))], []))

    def test_a_suite_that_fails_after_its_cases_has_failed(self):
        output = "[ RUN      ] Grasper.Holds\n[       OK ] Grasper.Holds (1 ms)\ndetected memory leaks\n"
        self.assertEqual(run_tests.outcome_of(junit(case("Grasper", "fail", output))).failures[0].name, "Grasper")

    def test_a_skip_without_a_message_borrows_none(self):
        output = SKIPPED_CASE + "\n[ RUN      ] Other.SaysNothing\n/house/b.cpp:3: Skipped\n\n[  SKIPPED ] Other.SaysNothing (0 ms)\n"
        self.assertEqual(run_tests.outcome_of(junit(case("usb.Grasper", "run", output))).skips[1],
                         Skip("usb.Grasper: Other.SaysNothing", "it says nothing"))

    def test_a_program_that_is_missing_has_failed(self):
        outcome = run_tests.outcome_of(junit(case("A", "notrun", "", "Unable to find executable")))
        self.assertEqual(outcome, Outcome(0, [Failure("A", ())], []))

    def test_a_disabled_test_is_skipped(self):
        self.assertEqual(run_tests.outcome_of(junit(case("A", "disabled", "Disabled"))).skips, [Skip("A", "it is disabled")])


    def test_keeps_the_first_failure_of_googletest_and_else_the_last_lines(self):
        output = "noise\n/house/a_test.cpp:7: Failure\nExpected: 1\n" + "more\n" * 30
        self.assertEqual(run_tests.telling_lines(output)[:2], ("/house/a_test.cpp:7: Failure", "Expected: 1"))
        self.assertEqual(run_tests.telling_lines("\n".join(map(str, range(100))))[-1], "99")


class ClosingLines(unittest.TestCase):
    skips = [Skip("Grasper.IsRead", "no measured data at /house/data"), Skip("usb.U6", "it does not start"),
             Skip("usb.Falcon", "it does not start")]

    def test_count_by_reason_and_end_with_the_sums(self):
        lines, passes = run_tests.closing_lines(Outcome(7, [], self.skips), [], skip_is_failure=False)
        self.assertTrue(passes)
        self.assertEqual(lines, [
            "Skipped, by reason:",
            "     2  it does not start: usb.U6, usb.Falcon",
            "     1  no measured data at /house/data (scripts/fetch-data brings it): Grasper.IsRead",
            "7 passed, 0 failed, 3 skipped"])

    def test_are_one_line_where_nothing_was_skipped(self):
        self.assertEqual(run_tests.closing_lines(Outcome(7, [], []), [], True), (["7 passed, 0 failed, 0 skipped"], True))

    def test_name_what_failed_and_what_it_said(self):
        lines, _ = run_tests.closing_lines(Outcome(7, [Failure("A.B", ("it broke",))], []), [], True)
        self.assertEqual(lines, ["Failed: A.B", "    it broke", "7 passed, 1 failed, 0 skipped"])

    def test_refuse_a_skip_that_the_list_does_not_name(self):
        lines, passes = run_tests.closing_lines(Outcome(7, [], self.skips), [Allowance("usb.*", "does not start")], True)
        self.assertFalse(passes)
        self.assertIn("On CI a skip is a failure unless tests/skips-allowed.txt names it, and 1 it does not: Grasper.IsRead", lines)

    def test_refuse_a_named_test_that_gives_another_reason(self):
        allowances = [Allowance("usb.*", "qemu"), Allowance("*", "measured data")]
        self.assertFalse(run_tests.closing_lines(Outcome(7, [], self.skips), allowances, True)[1])

    def test_let_pass_what_the_list_names_and_tell_what_was_not_needed(self):
        allowances = [Allowance("usb.*", "does not start"), Allowance("*", "measured data"), Allowance("*", "no disk")]
        lines, passes = run_tests.closing_lines(Outcome(7, [], self.skips), allowances, True)
        self.assertTrue(passes)
        self.assertEqual(lines[-2:], ["Allowed to be skipped, and was not: * | no disk", "7 passed, 0 failed, 3 skipped"])

    def test_name_three_of_many(self):
        many = [Skip(f"T{number}", "so") for number in range(5)]
        self.assertIn("     5  so: T0, T1, T2 and 2 more", run_tests.closing_lines(Outcome(0, [], many), [], False)[0])


class Allowances(unittest.TestCase):
    def test_are_a_pattern_and_a_part_of_the_reason(self):
        self.assertEqual(run_tests.read_allowances("# why\n\nusb.* | others took\n"), [Allowance("usb.*", "others took")])

    def test_without_a_reason_are_refused(self):
        for line in ("usb.*", "usb.* |", "| reason"):
            with self.assertRaisesRegex(ValueError, "line 2"):
                run_tests.read_allowances("\n" + line)

    def test_of_the_house_can_be_read(self):
        run_tests.read_allowances(run_tests.ALLOWED.read_text())


class Runs(unittest.TestCase):
    """The whole program, on a project with tests that are shell commands."""

    project = """cmake_minimum_required(VERSION 3.25)
project(tried NONE)
enable_testing()
add_test(NAME passes COMMAND true)
add_test(NAME fails COMMAND false)
add_test(NAME skips COMMAND sh -c "seq 1000; echo no such thing here; exit 77")
set_tests_properties(skips PROPERTIES SKIP_RETURN_CODE 77)
"""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        Path(cls.folder.name, "CMakeLists.txt").write_text(cls.project)
        subprocess.run(["cmake", "-S", cls.folder.name, "-B", f"{cls.folder.name}/build"], check=True, capture_output=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_program(self, *arguments, ci="false"):
        environment = {**os.environ, "CI": ci}
        for name in [name for name in environment if name.startswith("CTEST_")]:
            del environment[name]
        result = subprocess.run([sys.executable, SCRIPTS / "run_tests.py", *arguments], cwd=f"{self.folder.name}/build",
                                env=environment, capture_output=True, text=True, check=False)
        return result.returncode, result.stdout

    def test_keep_the_last_lines_of_ctest_and_end_with_the_sums(self):
        status, output = self.run_program("-E", "fails")
        self.assertEqual(status, 0)
        self.assertIn("\n100% tests passed, 0 tests failed out of 2\n", output)
        self.assertTrue(output.endswith("     1  no such thing here: skips\n1 passed, 0 failed, 1 skipped\n"), output)

    def test_are_all_run_where_they_end_in_time(self):
        status, output = self.run_program("--until", str(time.time() + 600), "-E", "fails")
        self.assertEqual(status, 0)
        self.assertTrue(output.endswith("     1  no such thing here: skips\n1 passed, 0 failed, 1 skipped\n"), output)

    def test_are_counted_where_the_time_is_up(self):
        totals = Path(self.folder.name, "late")
        status, output = self.run_program("--until", "0", "--totals", str(totals))
        self.assertEqual(status, run_tests.TIME_IS_UP)
        self.assertIn("The time was up: 3 of 3 tests were not run\n0 passed, 0 failed, 0 skipped\n", output)
        self.assertEqual(totals.read_text(), "0 0 0\nThe time was up: 3 of 3 tests were not run\n")

    def test_fail_where_a_test_fails_before_the_time_is_up(self):
        def fails_for_eleven_seconds(_):
            clock.return_value = 11.0
            return 8

        with mock.patch.object(run_tests.time, "time", return_value=0.0) as clock, \
                mock.patch.object(run_tests, "run_without_terminal", fails_for_eleven_seconds):
            self.assertEqual(run_tests.run_parts([], Path(), 10.0, 25), (8, [Path("junit1.xml")], 22))

    def test_fail_where_a_test_fails(self):
        status, output = self.run_program()
        self.assertNotEqual(status, 0)
        self.assertTrue(output.endswith("1 passed, 1 failed, 1 skipped\n"), output)

    def test_pass_on_ci_where_what_failed_beside_others_passes_alone(self):
        for says, status in (("too late", 0), ("AddressSanitizer: heap-use-after-free", 8)):
            with tempfile.TemporaryDirectory() as folder:
                once = Path(folder, "once.sh")
                once.write_text(f'test -e {folder}/met && exit 0\ntouch {folder}/met\necho "{says}"\nexit 1\n')
                Path(folder, "CTestTestfile.cmake").write_text(f'add_test(once sh "{once}")\nadd_test(passes true)\n')
                for ci, expected in (("false", 8), ("true", status)):
                    Path(folder, "met").unlink(missing_ok=True)
                    ended, output = self.run_program("--test-dir", folder, "-R", "once|passes", ci=ci)
                    self.assertEqual(ended, expected, output)
                    self.assertEqual("Failed beside others, and passed alone: once\n" in output, expected == 0)
                    self.assertIn(f"\n{2 if expected == 0 else 1} passed, {0 if expected == 0 else 1} failed, 0 skipped\n", output)

    def test_fail_on_ci_what_fails_alone_too(self):
        status, output = self.run_program("-E", "skips", ci="true")
        self.assertNotEqual(status, 0)
        self.assertIn("Once more, alone: fails\n", output)
        self.assertTrue(output.endswith("\n1 passed, 1 failed, 0 skipped\n"), output)

    def test_fail_on_ci_where_a_test_is_skipped(self):
        self.assertEqual(self.run_program("-E", "fails", ci="true")[0], 1)
        self.assertEqual(self.run_program("-R", "passes", ci="true")[0], 0)

    def test_fail_where_there_is_nothing_to_run(self):
        self.assertNotEqual(self.run_program("-R", "no-such-test")[0], 0)

    def test_add_up_in_a_file(self):
        totals = Path(self.folder.name, "totals")
        self.run_program("--totals", str(totals))
        self.run_program("--totals", str(totals), "-R", "passes")
        self.assertEqual(totals.read_text(), "1 1 1\nfailed fails\n1 0 0\n")


if __name__ == "__main__":
    unittest.main()
