"""Read every file of a folder, in a process that watches what is opened and taken.

``python hostile_maps.py FOLDER`` prints a line of JSON for each file: its name, what was said, its seconds;
at the end the growth of memory, secret files that were opened, and programs that were started.
"""

import json
import resource
import sys
import time
import warnings
from contextlib import suppress
from pathlib import Path

STARTS = {"subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "pickle.find_class"}


def read(path):
    from mcgw import load_scene
    from mcgw.maps import read_heights

    if path.suffix == ".toml":
        return load_scene(path)
    told = path.suffix in (".h5", ".x3p", ".nc") or path.with_suffix(".json").exists()
    return read_heights(path, pixel=None if told else (1e-6, 1e-6))


def main(folder):
    import mcgw

    mcgw.fit  # noqa: B018  # all that is imported is imported before
    with warnings.catch_warnings(), suppress(ImportError):
        warnings.simplefilter("ignore")
        import SurfaceTopography  # noqa: F401
    opened, started = [], []

    def watch(name, arguments):
        if name == "open" and isinstance(arguments[0], str | bytes):
            opened.append(str(arguments[0]))
        if name in STARTS:
            started.append(name)

    sys.addaudithook(watch)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for path in sorted(folder.iterdir()):
        if path.suffix == ".json" or path.name == "secret":
            continue
        began = time.process_time()
        try:
            read(path)
            said = ""
        except (ValueError, OSError) as error:
            said = str(error)
        sys.stdout.write(json.dumps([path.name, said, time.process_time() - began]) + "\n")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    outside = [name for name in opened if "secret" in name]
    sys.stdout.write(json.dumps([peak * 1024, outside, started]) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
