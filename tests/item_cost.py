"""What each item costs: seconds of CPU, its children's too, in units of a loop timed in the same process.

`python -m pytest --cost` lists the dearest items and fails those of the default tier beyond `LIMIT` units. A
plain pytest measures nothing. What fixtures of a module or session take is shared and listed by itself. Which
item compiles a loop first differs from run to run: what workers found too dear is measured again, alone.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from importlib import import_module
from pathlib import Path

import pytest

LIMIT = 15  # units, each a tenth of a second on a machine of 2023
NOISE = 2.5  # by which a busy machine may make an item dearer than it is: seen with four at work on two cores
AGAIN = "MCGW_TESTS_COSTS"  # file to which a second measurement writes
# Imported before the first item, which would pay for those after it.
EVERYBODYS = ("h5py", "matplotlib.pyplot", "numba", "pandas", "scipy.optimize", "scipy.stats", "xarray")

# Items that must be dearer, and why. Everything else that is dear belongs to the tier `slow` or `site`.
DEARER = {
    "test_maps_fit.py::test_where_summits_hide_the_bias_is_stated": "no smaller map has so many caps",
    "test_python_scenes.py::test_a_name_is_shown_and_nothing_else": "a name through run, show, compare",
    "test_what_users_read.py::test_commands": "whole tables of solve: exact means at several loads",
    "test_solution.py::test_a_metal_under_an_elastic_law_is_not_said_to_be_within": "two loads",
    "test_solution.py::test_the_answer_is_the_mean_of_specimens": "exact means beside drawn ones",
    "test_door_results.py::test_one_load_by_four_names": "a dozen answers, each exact",
    "test_report_figures.py::test_curves_are_values_and_specimens_of_solve": "exact answers at several loads",
    "test_rude_surroundings.py::test_a_doubted_unit_is_told_by_every_command_that_speaks_of_the_scene": "six",
    "test_architecture.py::test_packages_are_layers": "reads the imports of the whole house",
    "test_tradeoff.py::test_a_sampler_that_is_off_by_a_percent_is_not_advised": "a study of every way",
    "tradeoff.py::mcgw.statistics.tradeoff.tradeoff": "each way is run and timed, the exact law too",
}


def cpu():
    """Seconds of this process and of all children that have ended."""
    own, children = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime


def unit():
    """CPU seconds of the reference loop; the quickest of three, for others may be at work."""

    def once():
        began = time.process_time()
        sum(i * i for i in range(1_500_000))
        return time.process_time() - began

    return min(once() for _ in range(3))


def tier(item):
    return next((name for name in ("slow", "site") if item.get_closest_marker(name)), "default")


class Meter:
    """In each process that runs items: notes the cost of every item beside its report."""

    def __init__(self):
        for name in EVERYBODYS:
            import_module(name)
        self.unit = unit()

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef, request):
        before, began = self.apart, cpu()
        try:
            return (yield)
        finally:
            if fixturedef.scope != "function":
                within = self.apart - before  # shared fixtures that this one asked for
                spent = cpu() - began - within
                self.apart += spent
                name = f"{request.node.nodeid or 'session'}: {fixturedef.argname}"
                request._pyfuncitem.user_properties.append(("shared", (name, spent / self.unit)))

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_setup(self):
        self.began, self.apart = cpu(), 0.0
        return (yield)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_teardown(self, item):
        try:
            return (yield)
        finally:
            spent = max(cpu() - self.began - self.apart, 0.0)
            # A neighbour that came meanwhile slows the loop too: what looks dear is measured against it now.
            against = self.unit if spent <= LIMIT * self.unit else max(self.unit, unit())
            item.user_properties.append(("cost", (tier(item), spent / against)))


def measured_again(names):
    """Costs of these items in a process of their own, after all loops were compiled."""
    with tempfile.TemporaryDirectory() as folder:
        costs = Path(folder, "costs.json")
        command = [sys.executable, "-m", "pytest", "-q", "--cost", "-n0", "-p", "no:cacheprovider", *names]
        subprocess.run(command, env=os.environ | {AGAIN: str(costs)}, stdout=subprocess.DEVNULL)
        return json.loads(costs.read_text()) if costs.exists() else {}


class Bill:
    """In the process that reports: the sum, the dearest, and what is beyond the limit."""

    def __init__(self, alone):
        self.alone = alone
        self.items, self.shared = {}, {}

    def pytest_runtest_logreport(self, report):
        if report.when != "teardown":
            return
        for key, value in report.user_properties:
            if key == "cost":
                self.items[report.nodeid] = value
            elif key == "shared":
                name, spent = value
                self.shared[name] = max(spent, self.shared.get(name, 0.0))

    def dear(self):
        """Items of the default tier beyond the limit that no list excuses."""
        return [
            name
            for name, (tier, cost) in self.items.items()
            if tier == "default" and cost > NOISE * LIMIT and Path(name.partition("[")[0]).name not in DEARER
        ]

    def pytest_sessionfinish(self, session, exitstatus):
        if self.alone and AGAIN in os.environ:
            Path(os.environ[AGAIN]).write_text(json.dumps(self.items))
        elif not self.alone and self.dear():
            self.items |= {name: tuple(cost) for name, cost in measured_again(self.dear()).items()}
        if exitstatus == 0 and self.dear():
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter):
        write = terminalreporter.write_line
        if not self.items:
            return
        total = sum(cost for _, cost in self.items.values())
        shared = sum(self.shared.values())
        terminalreporter.section("cost in units of the reference loop")
        write(f"{len(self.items)} items {total:.0f}, shared fixtures {shared:.0f}; limit of an item {LIMIT}")
        for name, (_, cost) in sorted(self.items.items(), key=lambda x: -x[1][1])[:20]:
            write(f"{cost:7.1f} {name}")
        for name, cost in sorted(self.shared.items(), key=lambda x: -x[1])[:10]:
            write(f"{cost:7.1f} shared, {name}")
        for name in self.dear():
            write(
                f"TOO DEAR ({self.items[name][1]:.1f} > {LIMIT}): {name}; make it cheaper or mark it slow",
                red=True,
            )
