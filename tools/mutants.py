"""Change one small thing at a time in a module and see whether a test notices.

    python tools/mutants.py units                   all mutants of railbridge/units.py
    python tools/mutants.py beams.mesh --sample 80  80 of them, the same ones each time
    python tools/mutants.py units --again           only those that the last run left alive
    python tools/mutants.py --map                   note again which test runs which line

The changes are those of mutmut, without its other capital letters in strings, and one more: a call
of one argument is replaced by the argument (`escape(text)` by `text`). They are made everywhere in
the file; mutmut itself passes by what is decorated (each property, each dataclass) and what stands
outside of functions (tables of units, ranges of fields), and that is half of this package. What is
left out: annotations, decorators, docstrings and the wording of errors.

Each mutant is tested in a process of its own that shares the imports of the libraries: first by
the mirroring file, then by the other tests that run its line, the fastest first. The first run
notes which those are (some minutes); `--map` does so again after tests were added elsewhere than in
mirroring files. Notebooks and browser take no part, and what a test does in yet another process is
not seen. Results are in build/mutants/MODULE.json. Not for Windows, which cannot share imports.
"""

import argparse
import difflib
import importlib.util
import itertools
import json
import os
import random
import signal
import subprocess
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import versions

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "helpers" / "railbridge"
FOLDER = ROOT / "build" / "mutants"
MAP = FOLDER / "map.json"
NEEDED = ("mutmut>=3.8,<4",)
PASSED_BY = ("tests/browser", "tests/project")
# Imported once, before any mutant: they cost more than most tests.
SHARED = (
    "numpy", "scipy.linalg", "scipy.signal", "scipy.sparse.linalg", "scipy.interpolate",
    "scipy.optimize", "scipy.integrate", "pandas", "pydantic", "matplotlib.pyplot", "PIL.Image",
    "ipywidgets", "IPython", "nbformat", "jsonschema", "hypothesis.strategies", "pytest",
    "nbval.plugin", "xdist.plugin", "_hypothesis_pytestplugin", "anyio.pytest_plugin",
    "hypothesis.internal.conjecture.engine", "matplotlib.backends.backend_agg",
)  # fmt: skip
# What these are taken from is mostly equal to what they give.
CONVERSIONS = ("float", "int", "bool", "tuple", "list")
DIFF_HEADS = ("---", "+++")
SECONDS = 40.0  # what the tests of one mutant may take by themselves
OPTIONS = ["-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist"]


@dataclass(frozen=True)
class Mutant:
    """One change: the line where it is, both texts of the lines changed, and what became of it."""

    line: int
    before: str
    after: str
    result: str = ""


# ---- which changes there are


def changes(source):
    """Yield ``(line, mutated source)``."""
    import libcst as cst
    from libcst.metadata import MetadataWrapper, PositionProvider
    from mutmut.mutation.mutators import mutation_operators

    wrapper = MetadataWrapper(cst.parse_module(source))
    positions = wrapper.resolve(PositionProvider)
    operators = [*mutation_operators, (cst.Call, without_call)]

    class Finder(cst.CSTVisitor):
        def __init__(self):
            self.nodes = []

        def on_visit(self, node):
            if is_left_out(node):
                return False
            self.nodes.append(node)
            return True

    begins = [0, *itertools.accumulate(map(len, source.splitlines(keepends=True)))]

    def place(mark):
        return begins[mark.line - 1] + mark.column

    finder = Finder()
    wrapper.module.visit(finder)
    for node in finder.nodes:
        for kind, operator in operators:
            if not isinstance(node, kind):
                continue
            found = operator(node)
            if isinstance(node, cst.BaseString):
                found = list(found)[:1]  # the others change capitals only
            start, end = (place(mark) for mark in (positions[node].start, positions[node].end))
            for mutated in found:
                text = source[:start] + wrapper.module.code_for_node(mutated) + source[end:]
                if text != source and compiles(text):
                    yield positions[node].start.line, text


def is_left_out(node):
    """Annotations, decorators, imports, and the wording of what is raised or warned about."""
    import libcst as cst

    if isinstance(node, (cst.Annotation, cst.Decorator, cst.Import, cst.ImportFrom)):
        return True
    if isinstance(node, (cst.SimpleString, cst.ConcatenatedString)):
        return False
    if isinstance(node, cst.Assign):
        return any(getattr(target.target, "value", "") == "__all__" for target in node.targets)
    return isinstance(node, cst.Raise)


def without_call(node):
    kept = getattr(node.func, "value", None) in CONVERSIONS
    if not kept and len(node.args) == 1 and not node.args[0].star and not node.args[0].keyword:
        yield node.args[0].value


def compiles(text):
    try:
        compile(text, "mutant", "exec")
    except SyntaxError:
        return False
    return True


def as_mutant(source, line, text):
    old, new = source.splitlines(), text.splitlines()
    lines = [d for d in difflib.unified_diff(old, new, lineterm="", n=0) if d[:3] not in DIFF_HEADS]
    before, after = (
        "\n".join(d[1:].strip() for d in lines if d.startswith(sign)) for sign in ("-", "+")
    )
    return Mutant(line, before, after)


# ---- which tests run which line


class Contexts:
    """A pytest plugin: coverage notes the test, and each test its time."""

    def __init__(self, measured):
        self.measured, self.seconds = measured, {}

    def pytest_runtest_logstart(self, nodeid):
        self.measured.switch_context(function_of(nodeid))

    def pytest_runtest_logreport(self, report):
        name = function_of(report.nodeid)
        self.seconds[name] = self.seconds.get(name, 0.0) + report.duration


def function_of(nodeid):
    """The test without its parameters."""
    return nodeid.split("[")[0]


def write_map():
    """Run all tests once, and note for every line the tests that run it."""
    import coverage
    import pytest

    FOLDER.mkdir(parents=True, exist_ok=True)
    measured = coverage.Coverage(data_file=None, source=[str(PACKAGE)], config_file=False)
    contexts = Contexts(measured)
    measured.start()
    ignored = [f"--ignore={ROOT / path}" for path in PASSED_BY]
    options = [option for option in OPTIONS if option != "-x"]
    code = pytest.main([*options, *ignored, str(ROOT / "tests")], plugins=[contexts])
    measured.stop()
    if code:
        sys.exit("Tests fail before anything was changed.")
    data, lines = measured.get_data(), {}
    for file in data.measured_files():
        module = Path(file).relative_to(PACKAGE).as_posix()
        lines[module] = {
            line: sorted(set(names) - {""}) for line, names in data.contexts_by_lineno(file).items()
        }
    MAP.write_text(json.dumps({"lines": lines, "time": contexts.seconds}))


def read_map():
    return json.loads(MAP.read_text())


def mirror(module):
    """The test file of a module."""
    *rooms, name = module.split(".")
    return "/".join(["tests", *rooms, f"test_{name}.py"])


def tests_of(known, file, line, home):
    """Two lists of tests, those of the mirroring file first; together no longer than `SECONDS`."""
    lines = known["lines"].get(file, {})
    names = lines.get(str(line), [])
    if not names:  # it is run when the module is imported
        names = sorted({name for found in lines.values() for name in found})
    names = sorted(names, key=lambda name: known["time"].get(name, 0.0))
    total, kept = 0.0, []
    for name in names:
        total += known["time"].get(name, 0.0)
        if kept and total > SECONDS:
            break
        kept.append(name)
    at_home = [home] if (ROOT / home).exists() else []
    return [at_home, [name for name in kept if not name.startswith(home + "::")]]


# ---- one mutant, one process


class Mutated:
    """Import one module from a text instead of its file."""

    def __init__(self, name, path, text):
        self.name, self.path, self.text = name, path, text

    def find_spec(self, name, path=None, target=None):
        if name != self.name:
            return None
        folder = [str(self.path.parent)] if self.path.name == "__init__.py" else None
        return importlib.util.spec_from_file_location(
            name, self.path, loader=self, submodule_search_locations=folder
        )

    def create_module(self, spec):
        return None

    def exec_module(self, module):
        exec(compile(self.text, str(self.path), "exec"), module.__dict__)


def tested(name, path, text, groups):
    """What became of a mutant: "killed", "killed, too slow" or "alive"."""
    for tests in filter(None, groups):
        child = os.fork()
        if child == 0:
            os.setpgid(0, 0)
            quiet = os.open(os.devnull, os.O_RDWR)
            for stream in (0, 1, 2):
                os.dup2(quiet, stream)
            sys.meta_path.insert(0, Mutated(name, path, text))
            code = 1
            try:
                import pytest

                code = int(pytest.main([*OPTIONS, *tests]))
            finally:
                os._exit(code)
        code = waited(child, 3 * SECONDS)
        if code != 0:
            return "killed, too slow" if code is None else "killed"
    return "alive"


def waited(child, seconds):
    """The exit code of a process, or None if it was still running and was ended."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return None


# ---- the run


def run(module, sample=None, again=False):
    path = PACKAGE.joinpath(*module.split(".")).with_suffix(".py")
    if not path.exists():
        path = PACKAGE.joinpath(*module.split("."), "__init__.py")
    stored = FOLDER / f"{module}.json"
    source, known = path.read_text(encoding="utf-8"), read_map()
    found = [(as_mutant(source, *change), change[1]) for change in changes(source)]
    count = len(found)
    if again:
        alive = {(m["before"], m["after"]) for m in json.loads(stored.read_text())["alive"]}
        found = [pair for pair in found if (pair[0].before, pair[0].after) in alive]
    elif sample is not None and sample < count:
        found = random.Random(0).sample(found, sample)
    name = ".".join(["railbridge", module])
    file = path.relative_to(PACKAGE).as_posix()
    results = []
    for mutant, text in sorted(found, key=lambda pair: pair[0].line):
        groups = tests_of(known, file, mutant.line, mirror(module))
        what = tested(name, path, text, groups)
        results.append(Mutant(mutant.line, mutant.before, mutant.after, what))
        if what == "alive":
            print(f"{file}:{mutant.line}\n  - {mutant.before}\n  + {mutant.after}", flush=True)
    alive = [m for m in results if m.result == "alive"]
    killed = len(results) - len(alive)
    summary = {"module": module, "mutants": count, "tested": len(results), "killed": killed}
    stored.write_text(json.dumps({**summary, "alive": [asdict(m) for m in alive]}, indent=1))
    print(f"{module}: {killed} of {len(results)} killed, {count} mutants in all", flush=True)


def main(arguments):
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("modules", nargs="*", metavar="MODULE")
    parser.add_argument("--sample", type=int)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--map", action="store_true")
    asked = parser.parse_args(arguments)
    if importlib.util.find_spec("mutmut") is None:
        python = versions.make("mutants", more=NEEDED)
        clean = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
        done = subprocess.run([python, __file__, *arguments], env={**clean, "OMP_NUM_THREADS": "1"})
        sys.exit(done.returncode)
    if asked.map or not MAP.exists():
        # In a process of its own: here the package must not be imported yet.
        write = "import mutants, os; os.chdir(mutants.ROOT); mutants.write_map()"
        subprocess.run([sys.executable, "-c", write], cwd=ROOT / "tools", check=True)
    os.chdir(ROOT)
    for name in SHARED:
        importlib.import_module(name)
    for module in asked.modules:
        run(module, asked.sample, asked.again)


if __name__ == "__main__":
    main(sys.argv[1:])
