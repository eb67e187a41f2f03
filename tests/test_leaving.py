"""A process that leaves at once still runs what was asked of its end, and its output is written."""

import subprocess
import sys

ENDS = """
import atexit, sys
from mcgw.machine.leaving import leave
class Slow:
    def __del__(self): print("taken down")
sys.modules["slow"] = Slow()
atexit.register(lambda: print("asked for"))
print("written", end=" ")
print("error", end=" ", file=sys.stderr)
"""


def end_of(code):
    done = subprocess.run([sys.executable, "-c", ENDS + code], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def test_what_was_asked_for_is_done_and_the_rest_is_not_taken_down():
    assert end_of("leave(3)") == (3, "written asked for\n", "error ")


def test_a_plain_end_takes_down_everything():
    assert end_of("sys.exit(3)") == (3, "written asked for\ntaken down\n", "error ")


def test_closed_output_is_no_mistake_of_the_end():
    assert end_of("sys.stdout.close()\natexit._clear()\nleave(0)") == (0, "written ", "error ")


def test_matplotlib_without_help_draws_and_tells_help_later():
    code = """
from mcgw.machine.late import without_help
with without_help():
    import matplotlib.figure
from matplotlib.artist import kwdoc
from matplotlib.lines import Line2D
print("antialiased" in Line2D.set.__doc__, "antialiased" in kwdoc(Line2D), Line2D([0], [0], lw=3).get_lw())
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False True 3.0\n"
