"""Cases of fieldproof as items of pytest: copy it beside your tests and write in conftest.py

    pytest_plugins = ["fieldproof_pytest"]

Each file NAME.cases holds selectors, one a line, as `fieldproof run @NAME.cases` reads them; each case that they select
is an item. What is judged stands in pytest.ini, or on the command line:

    [pytest]
    fieldproof_iut = exec:python3 device.py
    fieldproof_options = --volume quick

A case that passes is a pass, a warn passes with a warning, a fail is a failure with its finding, a case that does not
apply is skipped. What is inconclusive is an error of the set-up, never a pass: nothing was decided. So is everything that
keeps fieldproof from judging. Without an implementation nothing is collected: green is never without the device.
"""
import json
import pathlib
import shlex
import subprocess
import tempfile
import warnings

import pytest

INCONCLUSIVE = 2  # exit codes: `fieldproof help exit-codes`
UNUSABLE = 5


def pytest_addoption(parser):
    group = parser.getgroup("fieldproof")
    for name, what in (("iut", "implementation under test, as --iut of fieldproof"),
                       ("program", "the program fieldproof"),
                       ("options", "more options of `fieldproof run`"),
                       ("out", "folder in which each case leaves its run; otherwise it is gone afterwards")):
        group.addoption(f"--fieldproof-{name}", dest=f"fieldproof_{name}", metavar=name.upper(), help=what)
        parser.addini(f"fieldproof_{name}", what, default="fieldproof" if name == "program" else "")


def setting(config, name):
    given = config.getoption(f"fieldproof_{name}")
    return given if given is not None else config.getini(f"fieldproof_{name}")


def pytest_collect_file(file_path, parent):
    if file_path.suffix == ".cases":
        return CasesFile.from_parent(parent, path=file_path)
    return None


def called(config, *words):
    program = setting(config, "program")
    try:
        return subprocess.run([program, *words], cwd=config.rootpath, capture_output=True, text=True, errors="replace",
                              check=False)
    except OSError as error:
        raise NotJudged(f"{program}: {error.strerror}; name the program with --fieldproof-program") from error


class NotJudged(Exception):
    """Nothing was decided, and why."""


class Failed(Exception):
    """The finding of a case that fails."""


class CasesFile(pytest.File):
    def collect(self):
        if not setting(self.config, "iut"):
            raise self.CollectError(f"{self.path.name}: name what is to be judged with fieldproof_iut")
        listed = called(self.config, "list", f"@{self.path}", "--json")
        if listed.returncode != 0:
            raise self.CollectError(listed.stderr.strip())
        for case in json.loads(listed.stdout):
            item = CaseItem.from_parent(self, name=case["id"])
            item.requirement = case["requirement"]
            for tag in case["tags"]:
                self.config.addinivalue_line("markers", f"{tag}: cases of fieldproof with the tag +{tag}")
                item.add_marker(tag)
            yield item


class CaseItem(pytest.Item):
    requirement = ""

    def setup(self):
        """Runs the case: what keeps it from a verdict is an error, which pytest has of a set-up only."""
        self.result, text = self.judged()
        verdict = self.result["verdict"]
        if verdict == "not-applicable":
            pytest.skip(self.result["reason"])
        if verdict not in ("pass", "warn", "fail"):
            raise NotJudged(f"{verdict}: {self.result['reason']}\n{text}")
        self.text = text

    def runtest(self):
        if self.result["verdict"] == "fail":
            raise Failed(self.text)
        if self.result["verdict"] == "warn":
            warnings.warn(pytest.PytestWarning(f"{self.name}: {self.result['reason']}"))

    def judged(self):
        """The result of the case and what fieldproof printed of it."""
        with tempfile.TemporaryDirectory() as folder:
            kept = setting(self.config, "out")
            out = pathlib.Path(kept or folder, "run" if not kept else self.name.replace("/", "+"))
            done = called(self.config, "run", self.name, "--iut", setting(self.config, "iut"), "--quiet",
                          "--out", str(out), *shlex.split(setting(self.config, "options")))
            if done.returncode >= UNUSABLE:
                raise NotJudged(done.stderr.strip())
            with open(out / "results.json", encoding="utf-8") as file:
                cases = json.load(file)["cases"]
            if not cases:
                raise NotJudged(done.stderr.strip())
            return cases[0], done.stdout

    def repr_failure(self, excinfo):
        if isinstance(excinfo.value, (Failed, NotJudged)):
            return str(excinfo.value)
        return super().repr_failure(excinfo)

    def reportinfo(self):
        return self.path, None, self.name
